#!/usr/bin/env python3
"""The page of `replay --report`: report_test.py SIMULATE REPLAY"""
import csv
import json
import math
import os
import re
import subprocess
import sys
import unittest

import rosbag

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "support"))
from folder_test import FolderTest  # noqa: E402
from certified_plant import CERTIFIED  # noqa: E402
from report_page import data_of, read_page, stamps_of, values_of  # noqa: E402

TOOLS = {}

# A cart far from the origin, whose position comes late and with a few outliers.
CART = """
plant: {states: [p, v], inputs: [u], A: [[0, 1], [0, 0]], B: [[0], [1]], units: {p: m}}
sensors: {position: {C: [[1, 0]], gate: {innovation: [1], recovery: {after: 2, action: accept}}, source: {topic: position}}}
input: {topic: input}
scenario:
  duration: 5
  initial_state: {p: 400000.25, v: 0}
  input: {rate: 20, formulas: {u: "sin(t)"}}
  sensors: {position: {schedule: {uniform: [0.05, 0.15]}, latency: [0.0, 0.1], noise: {formulas: ["5*(sin(7*t) > 0.9)"]}}}
"""
OBSERVER = """
observer: ConstantGainObserver
rate: 50
sampling: {T1: 0.05, T2: 0.12}
initial_estimate: {p: 400000, v: 0}
gains: {L: [[0.5], [0.5]]}
"""
BOUNCING = """
plant: {states: [p, v], A: [[0, 1], [0, 0]], jump_map: {A_d: [[1, 0], [0, -1]]}}
sensors: {position: {C: [[1, 0]], angular: [true], source: {topic: position}}}
jumps: {}
scenario:
  duration: 3
  initial_state: {p: 3, v: 1}
  sensors: {position: {schedule: {period: 0.1}}}
  jumps: {schedule: {period: 0.5}}
"""


class ReportTest(FolderTest):
    def run_tool(self, tool, *arguments):
        result = subprocess.run([TOOLS[tool], *arguments], stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, universal_newlines=True, check=False,
                                timeout=60)
        return result.returncode, result.stdout

    def simulate(self, scenario, name="run.bag"):
        config = self.write("scenario.yaml", scenario)
        status, text = self.run_tool("simulate", config, "-o", self.path(name))
        self.assertEqual(status, 0, text)

    def replay(self, observer, *arguments, bag="run.bag", expected=0):
        status, text = self.run_tool(
            "replay", self.path(bag), self.path("scenario.yaml"), self.write("observer.yaml", observer),
            "--report", self.path("report.html"), *arguments)
        self.assertEqual(status, expected, text)
        return text

    def report(self):
        return data_of(read_page(self.path("report.html")))

    def near(self, found, expected, tolerance):
        self.assertEqual(len(found), len(expected))
        self.assertGreater(len(found), 0)
        for one, other in zip(found, expected):
            self.assertAlmostEqual(one, other, delta=tolerance)

    def test_the_page_holds_the_numbers_of_the_bag(self):
        self.simulate(CART)
        self.replay(OBSERVER, "--truth", "truth", "--from", "1", "-o", self.path("out.bag"))
        data = self.report()
        with rosbag.Bag(self.path("out.bag")) as bag:
            estimates = [message for _, message, _ in bag.read_messages(["/estimate"])]
            events = [message for _, message, _ in bag.read_messages(["/events"])]
        self.near(stamps_of(data, data["estimate_times"]),
                  [message.header.stamp.to_sec() for message in estimates], 2e-6)
        for place, column in enumerate(data["columns"]):
            self.assertEqual(column["name"], estimates[0].names[place])
            # Single precision of 400 km would be off by centimetres.
            self.near(values_of(column["estimate"]["low"]),
                      [message.state[place] for message in estimates], 1e-6)
        found = data["events"]
        self.near(values_of(found["outcome"]), [message.outcome for message in events], 0)
        self.near(values_of(found["latency"]), [message.latency for message in events], 1e-7)
        self.assertEqual([found["sources"][i] for i in values_of(found["source"])],
                         [message.source for message in events])
        self.assertEqual([found["reasons"][i] for i in values_of(found["reason"])],
                         [message.reason for message in events])
        self.assertIn(11, values_of(found["outcome"]))  # gated
        self.assertIn(1, values_of(found["outcome"]))   # used late

        samples, = data["samples"]
        outcomes = values_of(samples["outcomes"])
        sampled = [message for message in events if message.source == "position"]
        self.assertEqual(outcomes, [message.outcome for message in sampled])
        with rosbag.Bag(self.path("run.bag")) as bag:
            truth = {message.header.stamp.to_nsec(): message.state
                     for _, message, _ in bag.read_messages(["/truth"])}
        self.near(values_of(data["columns"][0]["truth"]["low"]),
                  [truth[stamp][0] for stamp in sorted(truth)][-len(stamps_of(data, data["compared_times"])):], 1e-6)
        self.assertGreaterEqual(data["counted"][0], 1.0)

        sensor, = data["sensors"]
        stamps = sorted(message.header.stamp.to_nsec() for message in sampled if message.outcome in (0, 1))
        intervals = [(b - a) * 1e-9 for a, b in zip(stamps, stamps[1:])]
        self.near(values_of(sensor["intervals"]["low"]), intervals, 1e-7)
        self.assertEqual(sum(sensor["histogram"]["counts"]), len(intervals))
        too_long = sum(interval > 0.12 for interval in intervals)
        self.assertGreater(too_long, 0)
        self.assertTrue(any("%d above T2 = 0.12 s" % too_long in finding["text"] and
                            finding["level"] == "warning" for finding in data["verdict"]))

    def test_the_verdict_is_about_the_bound_first(self):
        self.simulate(CERTIFIED)
        text = self.replay("rate: 50\n", expected=1)
        found = re.search("plant/hash: expected ([0-9a-f-]+)", text).group(1)
        self.write("scenario.yaml", CERTIFIED.replace("HASH", found))
        assumed = "rate: 50\nerror_assumptions: {initial_error: %s, noise: 0}\n"
        self.replay(assumed % 2, "--truth", "truth")
        data = self.report()
        self.assertEqual(data["verdict"][0]["level"], "good")
        self.assertRegex(data["verdict"][0]["text"],
                         "^The guaranteed bound held, on the norm of the error and on each state's, at every one of 300 "
                         "compared stamps; an error took at most [0-9.]+ % of its bound$")
        row = data["errors"][0]
        self.assertEqual((row["name"], row["bound"]["exceeded"]), ("x", 0))
        self.assertEqual(values_of(data["columns"][0]["exceeded"]["times"]), [])
        column, = data["columns"]
        errors = values_of(column["error"]["low"])
        bounds = values_of(column["error_bound"]["low"])
        self.assertTrue(all(abs(error) <= bound for error, bound in zip(errors, bounds)))
        self.assertAlmostEqual(row["largest"], max(map(abs, errors)), delta=1e-6)
        # Of one state, W is the square of its bound, and V that of the error.
        for size, bound in ((data["lyapunov_bound"], column["bound"]), (data["lyapunov"], column["error"])):
            for one, other in zip(values_of(size["low"]), values_of(bound["low"])):
                self.assertAlmostEqual(one, other ** 2, delta=1e-5)
        # exp(-t) is twice what it is in the middle of three seconds ln 2 before.
        self.assertAlmostEqual(row["settled_within"], 2 * math.exp(-1.5), delta=0.02)
        self.assertAlmostEqual(row["settling_time"], 1.5 - math.log(2), delta=0.02)
        self.assertIn(["decay", "0.5"], data["configuration"]["certificate"])
        self.assertIn("ferrante2016_theorem1", data["configuration"]["guarantee"])
        # The plant starts 1 off: who says that it starts nearer is refuted.
        self.replay(assumed % 0.5, "--truth", "truth", expected=2)
        data = self.report()
        self.assertEqual(data["verdict"][0]["level"], "bad")
        self.assertIn("GUARANTEE BROKEN", data["verdict"][0]["text"])
        exceeded = data["columns"][0]["exceeded"]
        self.assertEqual(len(values_of(exceeded["times"])), data["errors"][0]["bound"]["exceeded"])
        self.assertGreater(min(values_of(exceeded["values"])), -1.01)
        self.assertLess(max(values_of(exceeded["values"])), 0)
        self.replay(assumed % 2)
        data = self.report()
        self.assertEqual(data["verdict"][0]["level"], "open")
        self.assertNotIn("norm", data)

    def test_other_gains_are_shown_beside(self):
        self.simulate(CART)
        slow = self.write("slow.yaml", OBSERVER.replace("[[0.5], [0.5]]", "[[0.1], [0.1]]"))
        self.replay(OBSERVER, "--truth", "truth", "--beside", slow, "--beside", self.path("observer.yaml"))
        data = self.report()
        self.assertEqual([other["name"] for other in data["beside"]], ["slow.yaml", "observer.yaml"])
        self.assertEqual(data["beside"][1]["errors"], data["errors"])
        slower = data["beside"][0]["errors"][-1]
        self.assertEqual(slower["name"], "norm")
        self.assertGreater(slower["rmse"], 1.2 * data["errors"][-1]["rmse"])
        norms = values_of(data["beside"][0]["norm"]["low"])
        self.assertLess(min(abs(norm - slower["largest"]) for norm in norms), 1e-6)
        self.assertRegex(data["verdict"][-2]["text"], "^With slow.yaml instead: RMSE [0-9.]+, [0-9.]+ times")
        self.assertIn(", 1 times that", data["verdict"][-1]["text"])
        _, text = self.run_tool("replay", self.path("run.bag"), self.path("scenario.yaml"), self.path("observer.yaml"),
                                "--beside", slow)
        self.assertIn("--beside: needs --report or --csv, and a truth", text)

    def test_tables_hold_what_the_page_shows(self):
        self.simulate(CART)
        self.replay(OBSERVER, "--truth", "truth", "--csv", self.path("tables"))
        data = self.report()
        tables = {}
        for name in os.listdir(self.path("tables")):
            with open(os.path.join(self.path("tables"), name), encoding="utf-8", newline="") as file:
                tables[name[:-len(".csv")]] = list(csv.DictReader(file))
        self.near([float(row["stamp"]) for row in tables["estimates"]],
                  stamps_of(data, data["estimate_times"]), 2e-6)
        self.near([float(row["v"]) for row in tables["estimates"]], values_of(data["columns"][1]["estimate"]["low"]), 1e-6)
        self.near([float(row["p_error"]) for row in tables["errors"]], values_of(data["columns"][0]["error"]["low"]), 1e-6)
        self.near([float(row["norm"]) for row in tables["errors"]], values_of(data["norm"]["low"]), 1e-6)
        self.assertEqual([row["reason"] for row in tables["events"]],
                         [data["events"]["reasons"][i] for i in values_of(data["events"]["reason"])])
        self.assertEqual(len(tables["samples"]), len(values_of(data["samples"][0]["times"])))
        self.assertEqual([row["unit"] for row in tables["quantities"]], ["m", ""])
        self.assertEqual([column["unit"] for column in data["columns"]], ["m", ""])
        status, text = self.run_tool("replay", self.path("run.bag"), self.path("scenario.yaml"), self.path("observer.yaml"),
                                     "--csv", self.write("file", ""))
        self.assertEqual(status, 1)
        self.assertIn("file", text)

    def test_seeds_spread_around_the_median(self):
        self.simulate(CART)
        self.replay(OBSERVER, "--truth", "truth", "--thin", "0.1", "0.3", "--seed", "4", "--seeds", "5", "--csv", self.path("tables"))
        data = self.report()
        rows = data["seeds"]["rows"]
        self.assertEqual([row["seed"] for row in rows], [4, 5, 6, 7, 8])
        self.assertEqual(len({row["rmse"] for row in rows}), 5)
        self.assertEqual(rows[0]["rmse"], data["errors"][-1]["rmse"])
        low, middle, high = (values_of(data["seeds"][key][end]) for key, end in (("range", "low"), ("median", "low"), ("range", "high")))
        self.assertGreater(len(low), 100)
        self.assertTrue(all(a <= b <= c for a, b, c in zip(low, middle, high)))
        self.assertTrue(any(a < b < c for a, b, c in zip(low, middle, high)))
        self.assertTrue(any(finding["text"].startswith("Over 5 seeds: RMSE ") for finding in data["verdict"]))
        # Each by itself is the same.
        self.replay(OBSERVER, "--truth", "truth", "--thin", "0.1", "0.3", "--seed", "6")
        self.assertEqual(self.report()["errors"][-1]["rmse"], rows[2]["rmse"])
        with open(os.path.join(self.path("tables"), "seeds.csv"), encoding="utf-8") as file:
            self.assertEqual([row["seed"] for row in csv.DictReader(file)], ["4", "5", "6", "7", "8"])
        _, text = self.run_tool("replay", self.path("run.bag"), self.path("scenario.yaml"), self.path("observer.yaml"),
                                "--seeds", "3", "--report", self.path("report.html"))
        self.assertIn("--seeds: needs --thin", text)

    def test_jumps_and_angles(self):
        self.simulate(BOUNCING)
        self.replay(OBSERVER.replace("0.12", "0.2").replace("400000", "3"), "--truth", "truth")
        data = self.report()
        origin = data["origin"]
        self.near(stamps_of(data, data["jumps"]), [1000 + 0.5 * k for k in range(1, 7)], 2e-6)
        self.assertEqual(values_of(data["changes"]["jumps"]), list(range(6)))
        self.assertLess(origin, 1000.1)
        angle = data["columns"][0]
        self.assertTrue(angle["angular"])
        values = values_of(angle["estimate"]["low"])
        self.assertGreater(max(values), 3.1)
        self.assertTrue(all(-math.pi - 1e-6 < value < math.pi + 1e-6 for value in values))

    def test_no_text_is_markup_and_nothing_is_asked_of_a_network(self):
        evil = "a<!--<script>b&lt;' \"\u2028é.bag"
        self.simulate(CART, name=evil)
        comment = "# </script><script>alert('no')</script><!-- ]]> \u2029 é\n"
        self.replay(comment + OBSERVER, bag=evil)
        page = read_page(self.path("report.html"))
        data = data_of(page)
        self.assertEqual(data["bag"], evil)
        self.assertEqual(data["configuration"]["files"][1]["text"], comment + OBSERVER)
        self.assertEqual(len(re.findall("<script", page)), 2)
        self.assertEqual(len(re.findall("</script", page)), 2)
        self.assertNotIn("alert('no')</", page)
        self.assertIn("default-src 'none'", page)
        # A picture saved as SVG names its language, and parts of itself.
        self.assertIsNone(re.search(r"https?://(?!www\.w3\.org/2000/svg)|<link|<img|@import|url\((?!#)|innerHTML", page))

    def test_nothing_to_compare_is_told_from_no_truth(self):
        self.simulate(CART)
        self.write("scenario.yaml", CART.replace("source: {topic: position}", "source: {topic: position, stamp_offset: 100}"))
        text = self.replay(OBSERVER, "--truth", "truth")
        self.assertIn("against the truth at 0 stamps\n  no stamp of the truth was compared", text)
        self.assertIn("no stamp of the truth was compared", json.dumps(self.report()["verdict"]))

    def test_a_report_is_no_input(self):
        self.simulate(CART)
        self.write("observer.yaml", OBSERVER)
        status, text = self.run_tool("replay", self.path("run.bag"), self.path("scenario.yaml"),
                                     self.path("observer.yaml"), "--report", self.path("observer.yaml"))
        self.assertNotEqual(status, 0)
        self.assertIn("--report: ", text)
        self.assertIn("which would be lost", text)


if __name__ == "__main__":
    for name in ("simulate", "replay"):
        TOOLS[name] = sys.argv.pop(1)
    unittest.main()
