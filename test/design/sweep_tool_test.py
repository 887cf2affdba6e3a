#!/usr/bin/env python3
"""`design sweep` and `design explain` as a person runs them: sweep_tool_test.py DESIGN"""
import csv
import os
import signal
import subprocess
import sys
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "support"))
from folder_test import FolderTest  # noqa: E402
from report_page import data_of, read_page  # noqa: E402

DESIGN = ""  # the tool
INTERRUPTED = 130
NO_DESIGN = 3

# ferrante2019, example 1
OSCILLATOR = """
plant:
  states: [z1, z2]
  A: [[0, 1], [-4, 0]]
sensors:
  position:
    C: [[1, 0]]
    source: {topic: position}
design:
  sampling: {T1: 0.1, T2: 0.41}
  N: [[1], [0]]
  C_p: [[1, 0], [0, 1]]
  parameters: {lambda_t: 0.05}
"""

# sferlazza2019 (66)
AIRCRAFT = """
plant:
  states: [x1, x2, x3]
  A: [[-0.02, -1.4, 9.8], [-0.01, -0.4, 0], [0, 1, 0]]
sensors:
  output:
    C: [[1, 0, 1]]
    source: {topic: output}
"""


class ToolTest(FolderTest):
    def setUp(self):
        super().setUp()
        self.plant = self.write("plant.yaml", OSCILLATOR)

    def read(self, name):
        with open(self.path(name)) as file:
            return file.read()

    def sweep_command(self, output, *options):
        return [DESIGN, "sweep", self.plant, "-o", self.path(output), "--method",
                "ferrante2019_proposition2", "--jobs", "2", *options]

    def run_tool(self, command, status=0):
        result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                universal_newlines=True, check=False, timeout=120)
        self.assertEqual(result.returncode, status, result.stdout)
        return result.stdout


class SweepTest(ToolTest):
    RANGE = ["--T2", "0.2", "0.41", "--points", "4"]

    def sweep(self, output, *options, status=0):
        return self.run_tool(self.sweep_command(output, *options), status)

    def rows_finished(self, output):
        """Lines of points.csv after the request and the names of the columns."""
        try:
            return max(0, self.read(output + "/points.csv").count("\n") - 2)
        except FileNotFoundError:
            return 0

    def stop_in_between(self, output, number, options):
        with subprocess.Popen(self.sweep_command(output, *options), stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as process:
            deadline = time.time() + 60
            while self.rows_finished(output) < 2 and time.time() < deadline:
                time.sleep(0.002)
            process.send_signal(number)
            return process.wait(30)

    def test_curve_has_the_known_values_and_is_monotone(self):
        self.sweep("out", *self.RANGE)
        curve = list(csv.DictReader(self.read("out/curve.csv").splitlines()))
        self.assertEqual([row["T2"] for row in curve], ["0.2", "0.27", "0.34", "0.41"])
        self.assertEqual({row["method"] for row in curve}, {"ferrante2019_proposition2"})
        self.assertEqual({row["lambda_t"] for row in curve}, {"0.05"})
        gammas = [float(row["gamma"]) for row in curve]
        self.assertEqual(gammas, sorted(gammas))
        self.assertAlmostEqual(gammas[-1], 32.22, delta=0.3222)
        for row in curve:
            self.run_tool([DESIGN, "verify", self.path("out/" + row["gains"])])
        for picture, begin in (("curve.png", b"\x89PNG"), ("curve.svg", b"<?xml")):
            with open(self.path("out/" + picture), "rb") as file:
                self.assertTrue(file.read().startswith(begin))
        data = data_of(read_page(self.path("out/report.html")))
        drawn, = data["charts"][0]["curves"]
        self.assertEqual(drawn["x"], [float(row["T2"]) for row in curve])
        self.assertEqual(drawn["y"], gammas)
        self.assertEqual(len(data["tables"][0]["rows"]), 4)

    def test_resumes_after_ctrl_c_and_after_being_killed(self):
        options = ["--T2", "0.1", "0.38", "--points", "15"]
        self.sweep("whole", *options)
        self.assertEqual(self.stop_in_between("resumed", signal.SIGINT, options), INTERRUPTED)
        after_interruption = self.rows_finished("resumed")
        self.assertLess(after_interruption, 15)
        for line in self.read("resumed/points.csv").splitlines()[2:]:
            self.assertTrue(os.path.exists(self.path(
                "resumed/gains/%s_T2_%s.yaml" % tuple(line.split(",")[:2]))))
        self.stop_in_between("resumed", signal.SIGKILL, options)
        with open(self.path("resumed/points.csv"), "a") as file:
            file.write("ferrante2019_proposition2,0.1")  # what a crash leaves of a line
        kept = self.read("resumed/points.csv").splitlines()[:2 + after_interruption]
        self.sweep("resumed", *options)
        self.assertEqual(self.read("resumed/points.csv").splitlines()[:len(kept)], kept)
        self.assertEqual(self.rows_finished("resumed"), 15)
        self.assertEqual(self.read("resumed/curve.csv"), self.read("whole/curve.csv"))

    def test_computes_anew_what_was_lost_of_finished_points(self):
        options = ["--T2", "0.2", "0.4", "--points", "5"]
        self.sweep("out", *options)
        curve = self.read("out/curve.csv")
        files = [self.path("out/" + row["gains"]) for row in csv.DictReader(curve.splitlines())]
        texts = [self.read(file) for file in files]
        os.remove(files[0])
        os.truncate(files[1], 0)
        os.truncate(files[2], len(texts[2]) // 2)
        with open(files[3], "w") as file:
            file.write(texts[4])  # that of another T2
        text = self.sweep("out", *options)
        self.assertEqual(text.count("it was finished, and is computed anew"), 4)
        for file in files[:4]:
            self.assertIn("design: " + file, text)
        self.assertEqual(self.read("out/curve.csv"), curve)
        for file in files:
            self.run_tool([DESIGN, "verify", file])
        # The last line of a point counts.
        self.assertEqual(self.rows_finished("out"), 9)
        self.assertNotIn("anew", self.sweep("out", *options))
        self.assertEqual(self.rows_finished("out"), 9)

    def test_what_is_added_by_others_to_a_gain_file_stays(self):
        options = ["--T2", "0.2", "0.2", "--points", "1"]
        self.sweep("out", *options)
        name = "out/gains/ferrante2019_proposition2_T2_0.2.yaml"
        with open(self.path(name), "a") as file:
            file.write("rate: 50\n")
        self.assertNotIn("anew", self.sweep("out", *options))
        self.assertTrue(self.read(name).endswith("rate: 50\n"))

    def test_refuses_another_request_in_the_same_folder(self):
        options = ["--T2", "0.2", "0.2", "--points", "1"]
        self.sweep("out", *options)
        before = self.read("out/points.csv")
        for changed in (["--set", "lambda_t=0.06"], ["--set", "gain_bound=10"]):
            self.assertIn("another request", self.sweep("out", *options, *changed, status=1))
        self.plant = self.write("plant.yaml", OSCILLATOR.replace("-4", "-4.1"))
        self.assertIn("another request", self.sweep("out", *options, status=1))
        self.assertEqual(self.read("out/points.csv"), before)

    def test_says_when_there_is_no_design_at_all(self):
        # pi / 2 is a pathological interval.
        text = self.sweep("out", "--T2", "1.6", "1.6", "--points", "1", status=NO_DESIGN)
        self.assertIn("0/1", text)
        point = list(csv.DictReader(self.read("out/points.csv").splitlines()[1:]))[0]
        self.assertEqual(point["gamma"], "")
        self.assertIn("found no design", point["message"])

    def test_draws_the_rate_of_convergence(self):
        text = self.sweep("out", "--T2", "0.2", "0.3", "--points", "2", "--objective", "max-decay")
        self.assertIn("2/2", text)
        curve = list(csv.DictReader(self.read("out/curve.csv").splitlines()))
        rates = [float(row["decay_rate"]) for row in curve]
        self.assertGreaterEqual(rates[0], rates[1])
        self.assertGreater(rates[1], 0.05)

    def test_refuses_to_draw_different_quantities_together(self):
        text = self.sweep("out", *self.RANGE, "--method", "etienne2019_proposition2",
                          "--objective", "min-gamma", status=1)
        self.assertIn("one sweep draws one quantity", text)
        self.assertIn("L2 gain", text)
        self.assertFalse(os.path.exists(self.path("out")))

    def test_bad_requests_are_refused(self):
        self.assertIn("T1", self.sweep("out", *self.RANGE, "--T1", "0.3", status=1))
        self.assertIn("expected LOW < HIGH, found 0.4 and 0.2",
                      self.sweep("out", "--T2", "0.4", "0.2", status=1))
        self.assertIn("parameter 'x'", self.sweep("out", *self.RANGE, "--set", "x=1", status=1))
        self.assertFalse(os.path.exists(self.path("out")))


class ExplainTest(ToolTest):
    def explain(self, *options):
        text = self.run_tool([DESIGN, "explain", self.plant, *options])
        self.assertLessEqual(max(len(line) for line in text.splitlines()), 96)
        return " ".join(text.split())

    def test_names_the_pathological_interval_of_the_aircraft(self):
        self.plant = self.write("aircraft.yaml", AIRCRAFT)
        text = self.explain("--T1", "3", "--T2", "4")
        self.assertIn("the first is tau = 8.541 s; none in [T1, T2] = [3, 4] s", text)
        self.assertNotIn("NO OBSERVER", text)
        text = self.explain("--T1", "8.5", "--T2", "8.6", "--plot", self.path("curve.png"),
                            "--report", self.path("report.html"))
        self.assertIn("NO OBSERVER CAN CONVERGE - samples that come exactly every 8.541 s", text)
        self.assertTrue(os.path.exists(self.path("curve.png")))
        data = data_of(read_page(self.path("report.html")))
        self.assertEqual(" ".join(data["text"].split()), text)
        self.assertEqual(data["charts"][0]["band"], {"low": 8.5, "high": 8.6, "label": "[T1, T2]"})

    def test_names_what_is_unseen(self):
        self.plant = self.write("unseen.yaml", OSCILLATOR.replace("[z1, z2]", "[z1, z2, drift]")
                                .replace("[[0, 1], [-4, 0]]",
                                         "[[0, 1, 0], [-4, 0, 0], [0, 0, -0.5]]")
                                .replace("[[1, 0]]", "[[1, 0, 0]]")
                                .split("design:")[0])
        text = self.explain("--T2", "0.2")
        self.assertIn("not observable, but detectable", text)
        self.assertIn("unseen: the mode -0.5, which moves drift; it decays, time constant 2 s",
                      text)

    def test_says_which_methods_apply(self):
        text = self.explain()
        self.assertIn("ferrante2019_proposition2 applies: feasible, max-T2, max-decay, "
                      "min-final-error, min-gamma",
                      text)


if __name__ == "__main__":
    DESIGN = sys.argv.pop(1)
    unittest.main()
