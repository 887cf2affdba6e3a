#!/usr/bin/env python3
"""The independent check of claims, and a short campaign: attack_test.py DESIGN"""

import copy
import glob
import os
import subprocess
import sys
import tempfile
import unittest

FOLDER = os.path.dirname(os.path.realpath(__file__))
ROOT = os.path.dirname(os.path.dirname(FOLDER))
sys.path.insert(0, FOLDER)

import yaml  # noqa: E402
from mpmath import mp, mpf  # noqa: E402

from conditions import OverTimes  # noqa: E402
from formulas import lipschitz_constant_is_refuted, vertices_are_refuted  # noqa: E402
from high_precision import exponential, matrix, minus, norm_1  # noqa: E402
from independent_check import judge  # noqa: E402

DESIGN = ""  # the tool
LONG_TESTS = "SDO_LONG_TESTS" in os.environ  # as scripts/test --all runs them
SECONDS = 10.0


def certified_gains():
    for path in sorted(glob.glob(os.path.join(ROOT, "config/examples/*/gains*.yaml"))):
        with open(path, encoding="utf-8") as stream:
            if "certificate" in yaml.safe_load(stream):
                yield path


def answers(path, plant=None):
    return [verdict.answer for verdict in judge(path, plant, SECONDS)]


def times(factor):
    def scale(value):
        return [scale(entry) for entry in value] if isinstance(value, list) else factor * value
    return scale


# Of a file for ferrante2019_theorem2: section, key, and what is done to its value.
BREAKS = [
    ("gains", "L", times(-1)), ("gains", "L", times(3)), ("gains", "H", times(-1)),
    ("certificate", "P1", times(-1)), ("certificate", "P1", times(100)),
    ("certificate", "P2", times(-1)), ("certificate", "P2", times(1e-9)),
    ("certificate", "delta", times(-1)), ("certificate", "delta", times(30)),
    ("certificate", "lambda_t", times(-1)), ("certificate", "lambda_t", times(100)),
    ("certificate", "gamma", times(-1)), ("certificate", "gamma", times(0.1)),
    ("certificate", "T1", times(-1)), ("certificate", "T1", times(10)),
    ("certificate", "T2", times(3)), ("certificate", "T2", times(-1)),
    ("certificate", "N", times(10)), ("certificate", "C_p", times(10)),
]


DENSE_PLANT = """plant: {states: [x1, x2], A: [[0, 1], [-1, 0]]}
sensors:
"""
DENSE = ["  first: {C: [[1, 0]], source: {topic: first}, sampling: {T1: 0, T2: 0.5}}\n",
         "  second: {C: [[0, 1]], source: {topic: second}, sampling: {T1: 0, T2: 0.3}}\n"]

SPARSE = "".join(DENSE).replace("T1: 0,", "T1: 0.1,") + "design: {N: [[0], [1]], C_p: [[1, 0]]}\n"

UNCERTAIN_PLANT = """
plant:
  states: [x1, x2]
  flow: {x1: x2, x2: "0.1*sin(x2) - x1 - 0.2*x2 + 0.3*sin(x1)"}
  jacobian_vertices: {1: [[0, 1], [-0.7, -0.2]], 2: [[0, 1], [-1.3, -0.2]]}
  G: [[0], [1]]
  S: [[0, 1]]
  lipschitz_constant: 0.1
  integration: {step: 0.01}
sensors: {angle: {C: [[1, 0]], source: {topic: angle}, sampling: {T1: 0.1, T2: 0.3}}}
design: {N: [[0], [1]], C_p: [[1, 0]]}
"""

# Of a claim for two sensors by timers.
TIMER_BREAKS = [
    (("certificate", "lambda_t"), times(100)), (("certificate", "P", 2), times(3)),
    (("certificate", "nu", "gps"), times(1e-6)), (("certificate", "nu", "wheel"), times(-1)),
    (("gains", "L", "gps"), times(-1)), (("gains", "L", "wheel"), times(3)),
    (("certificate", "sensors", "wheel", "T1"), times(0.5)),
    (("certificate", "sensors", "gps", "T2"), times(2)),
]
# Of one for jumps of a plant, whose V falls at them.
FALL_BREAKS = [("mu", times(0.5)), ("mu", times(-1)), ("mu", lambda _: 1)]


class MatrixTest(unittest.TestCase):
    def test_exponential_of_a_rotation_and_of_bad_units(self):
        mp.dps = 60
        turned = exponential(matrix([[0, 3], [-3, 0]]))
        self.assertLess(abs(turned[0][0] - mp.cos(3)) + abs(turned[1][0] + mp.sin(3)), mpf(10) ** -58)
        stiff = matrix([[-2, 10 ** 9], [0, -3]])
        exact = [[mp.exp(-2), 10 ** 9 * (mp.exp(-2) - mp.exp(-3))], [mpf(0), mp.exp(-3)]]
        self.assertLess(norm_1(minus(exponential(stiff), exact)), mpf(10) ** -48)

    def test_what_is_violated_for_microseconds_is_found(self):
        """Definite but for 9 us around one time, which no point of a grid hits."""
        mp.dps = 60
        w = mpf(50)
        # The first entry of a vector that turns is 1 at 0.07123 s, and less at all other times.
        flow = matrix([[0, -w], [w, 0]])
        state = [[mp.cos(w * mpf("0.07123"))], [-mp.sin(w * mpf("0.07123"))]]
        row = [[mpf(1), mpf(0)]]
        for limit, answer in (("1.0000001", "holds"), ("0.9999999", "violated")):
            condition = OverTimes("turning", -1, row, flow, state, [[mpf(limit)]], mpf("0.03"),
                                  mpf("0.12"))
            self.assertEqual(answer, condition.judge(SECONDS).answer, limit)


class FormulaTest(unittest.TestCase):
    def test_constants_that_formulas_refute(self):
        for formula, constant, is_refuted in (
                ("sin(v1)", 1, False), ("sin(v1)", 0.99, True), ("20 * sin(4 * v1)", 0.1, True),
                ("20 * sin(4 * v1)", 80, False), ("v1^2", 100, True),
                ("max(-1, min(1, 3 * v1))", 3, False), ("max(-1, min(1, 3 * v1))", 2.9, True)):
            self.assertEqual(is_refuted, lipschitz_constant_is_refuted([formula], 1, constant),
                             (formula, constant))

    def test_vertices_that_formulas_refute(self):
        G, S = [[0], [2]], [[1, 0]]
        for most, is_refuted in ((2, False), (1.9, True)):
            vertices = [[[0, 0], [sign * most, 0]] for sign in (1, -1)]
            self.assertEqual(is_refuted, vertices_are_refuted(["sin(v1)"], G, S, vertices), most)
        self.assertTrue(vertices_are_refuted(["sin(v1)"], [[0.1], [2]], S,
                                             [[[0, 0], [2, 0]], [[0, 0], [-2, 0]]]))


class ClaimTest(unittest.TestCase):
    def test_shipped_claims_hold(self):
        paths = list(certified_gains())
        self.assertGreaterEqual(len(paths), 10)
        for path in paths:
            found = answers(path)
            self.assertGreaterEqual(len(found), 4, path)
            self.assertEqual({"holds"}, set(found), f"{path}: {found}")

    def test_claims_of_timers_hold_and_broken_ones_do_not(self):
        paths = glob.glob(os.path.join(ROOT, "test/certificate/**/*timer_dependent*.yaml"), recursive=True)
        two_sensors = os.path.join(ROOT, "test/certificate/two_sensors.yaml")
        self.assertGreaterEqual(len(paths), 4)
        for path in paths + [two_sensors]:
            self.assertEqual({"holds"}, set(answers(path)), path)
        with tempfile.TemporaryDirectory() as folder:
            plant = os.path.join(folder, "plant.yaml")
            gains = os.path.join(folder, "gains.yaml")
            for method, text in (("timer_dependent_constant_gain", DENSE_PLANT + DENSE[0]),
                                 ("timer_dependent_scheduled_gain", DENSE_PLANT + "".join(DENSE)),
                                 ("timer_dependent_sum_gain", DENSE_PLANT + SPARSE),
                                 ("timer_dependent_constant_gain", UNCERTAIN_PLANT)):
                with open(plant, "w", encoding="utf-8") as stream:
                    stream.write(text)
                subprocess.run([DESIGN, "synthesize", plant, "-o", gains, "--method", method, "--cells", "2",
                                "--objective", "feasible"], stdout=subprocess.DEVNULL, check=True)
                self.assertEqual({"holds"}, set(answers(gains)), method)
        with open(two_sensors, encoding="utf-8") as stream:
            whole = yaml.safe_load(stream)
        plant = os.path.join(os.path.dirname(two_sensors), whole["certificate"]["plant"]["file"])
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "gains.yaml")
            for keys, change in TIMER_BREAKS:
                document = copy.deepcopy(whole)
                section = document
                for key in keys[:-1]:
                    section = section[key]
                section[keys[-1]] = change(section[keys[-1]])
                with open(path, "w", encoding="utf-8") as stream:
                    yaml.safe_dump(document, stream)
                self.assertIn("violated", answers(path, plant), keys)

    def test_a_function_that_falls_less_at_events_than_it_says_is_refused(self):
        folder = os.path.join(ROOT, "config/examples/bernard2022_bouncing_ball")
        with open(os.path.join(folder, "gains_timer_dependent.yaml"), encoding="utf-8") as stream:
            whole = yaml.safe_load(stream)
        with tempfile.TemporaryDirectory() as temporary:
            path = os.path.join(temporary, "gains.yaml")
            for key, change in FALL_BREAKS:
                document = copy.deepcopy(whole)
                document["certificate"][key] = change(document["certificate"][key])
                with open(path, "w", encoding="utf-8") as stream:
                    yaml.safe_dump(document, stream)
                self.assertIn("violated", answers(path, os.path.join(folder, "scenario.yaml")), key)

    def test_each_broken_value_is_refused(self):
        folder = os.path.join(ROOT, "config/examples/ferrante2019_oscillator")
        with open(os.path.join(folder, "gains.yaml"), encoding="utf-8") as stream:
            whole = yaml.safe_load(stream)
        self.assertEqual("ferrante2019_theorem2", whole["certificate"]["theorem"])
        with tempfile.TemporaryDirectory() as broken:
            path = os.path.join(broken, "gains.yaml")
            in_run_time = [("run_time_certificate", key, change) for section, key, change in BREAKS
                           if section == "certificate" and key in whole["run_time_certificate"]]
            self.assertGreater(len(in_run_time), 8)
            breaks = BREAKS + in_run_time
            if not LONG_TESTS:  # one for each key
                breaks = list({(section, key): (section, key, change)
                               for section, key, change in breaks}.values())
            for section, key, change in breaks:
                document = copy.deepcopy(whole)
                document[section][key] = change(document[section][key])
                with open(path, "w", encoding="utf-8") as stream:
                    yaml.safe_dump(document, stream)
                plant = os.path.join(folder, "plant.yaml")
                self.assertIn("violated", answers(path, plant), f"{section}/{key} changed")
                done = subprocess.run([DESIGN, "verify", path, "--plant", plant, "--rigorous"],
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
                self.assertNotEqual(0, done.returncode, f"{key} changed: {done.stdout}")

    def test_false_claims_are_found(self):
        claims = sorted(glob.glob(os.path.join(FOLDER, "false_claims", "*_*.yaml")))
        self.assertGreaterEqual(len(claims), 2)
        for path in claims:
            self.assertIn("violated", answers(path), path)


class CampaignTest(unittest.TestCase):
    def test_no_claim_is_false(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(
                [sys.executable, os.path.join(FOLDER, "campaign.py"), "--tool", DESIGN, "-o", folder,
                 "--plants", "20", "--seconds", "12", "--jobs", "2", "--design-seconds", "4",
                 "--check-seconds", "2"],
                stdout=subprocess.PIPE, universal_newlines=True, check=False)
            print(done.stdout)
            self.assertEqual(0, done.returncode, done.stdout)
            with open(os.path.join(folder, "claims.csv"), encoding="utf-8") as stream:
                held = sum(",holds," in line for line in stream)
            self.assertGreater(held, 0, done.stdout)


if __name__ == "__main__":
    DESIGN = sys.argv.pop(1)
    unittest.main()
