#!/usr/bin/env python3
"""The tools for bags as a person runs them: tools_test.py SIMULATE REPLAY COMPARE_ESTIMATES"""
import json
import os
import re
import shutil
import subprocess
import sys
import unittest

import genpy.dynamic
import rosbag
from geometry_msgs.msg import TransformStamped, Vector3
from tf2_msgs.msg import TFMessage

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "support"))
from folder_test import FolderTest  # noqa: E402
from certified_plant import CERTIFIED  # noqa: E402
import recordings  # noqa: E402

TOOLS = {}
WRONG_USAGE = range(100, 128)

# A cart, pushed; its position comes up to 50 ms late.
SCENARIO = """
plant: {states: [p, v], inputs: [u], A: [[0, 1], [0, 0]], B: [[0], [1]]}
sensors: {position: {C: [[1, 0]], source: {topic: position}}}
input: {topic: input}
scenario:
  duration: 3
  initial_state: {p: 1, v: 0}
  input: {rate: 20, formulas: {u: "sin(t)"}}
  sensors: {position: {schedule: {period: 0.1}, latency: [0.03, 0.05]}}
"""
OBSERVER = """
observer: ConstantGainObserver
rate: 50
publish_delay: DELAY
sampling: {T1: 0.1, T2: 0.1}
gains: {L: [[0.5], [0.5]]}
"""
TWO_INPUTS = SCENARIO.replace("inputs: [u]", "inputs: [u, w]").replace(
    "B: [[0], [1]]", "B: [[0, 0.1], [1, 0]]").replace('{u: "sin(t)"}', '{u: "sin(t)", w: "cos(t)"}')
JUMPING = SCENARIO.replace("B: [[0], [1]]}",
                           "B: [[0], [1]], jump_map: {A_d: [[1, 0], [0, 1]]}}\njumps: {}")

# A mass that turns round every half second.
BOUNCING = """
plant: {states: [p, v], A: [[0, 1], [0, 0]], jump_map: {A_d: [[1, 0], [0, -1]]}}
sensors: {position: {C: [[1, 0]], source: {topic: position}}}
jumps: {}
scenario:
  duration: 3
  initial_state: {p: 1, v: 1}
  sensors: {position: {schedule: {period: 0.1}}}
  jumps: {schedule: {period: 0.5}}
"""

# Its model escapes to infinity within 1 s of the start; the true plant starts elsewhere, and stays.
ESCAPING = """
plant: {states: [x], flow: {x: "x^2 - 1"}, integration: {step: 0.001}}
sensors: {position: {C: [[1]], source: {topic: position}}}
scenario:
  duration: 3
  initial_state: {x: -1}
  sensors: {position: {schedule: {period: 0.1}}}
"""
BLIND = """
observer: ConstantGainObserver
rate: 50
sampling: {T1: 0.1, T2: 0.1}
gains: {L: [[0]]}
initial_estimate: {x: 3}
"""
# Two sensors, each at its own pace: every other time between samples of wheel is too long.
TWO_SENSORS = """
plant: {states: [p, v], A: [[0, 1], [0, 0]]}
sensors:
  gps: {C: [[1, 0]], sampling: {T1: 0.2, T2: 1}, source: {topic: gps}}
  wheel: {C: [[0, 1]], sampling: {T1: 0.05, T2: 0.15}, source: {topic: wheel}}
scenario:
  duration: 3
  initial_state: {p: 1, v: 1}
  sensors: {gps: {schedule: {period: 0.5}}, wheel: {schedule: {file: times.txt}}}
"""
DENSE = TWO_SENSORS.replace("0.5}}, wheel: {schedule: {file: times.txt}}}",
                            "0.01}}, wheel: {schedule: {period: 0.01}}}").replace(
                                "duration: 3", "duration: 20")
FUSION = """
observer: ConstantGainObserver
rate: 50
gains: {L: {gps: [[0.5], [0.1]], wheel: [[0], [0.5]]}}
"""

WHEELS = """
observer: ConstantGainObserver
plant: {states: [x], A: [[0]]}
sensors: {s: {C: [[1]], source: {topic: TOPIC, type: my_msgs/Wheel, fields: [places.1]}}}
sampling: {T1: 0.5, T2: 2}
gains: {L: [[1]]}
"""
CRAZYFLIE = """
observer: ConstantGainObserver
plant: {states: [x, y, front], A: [[0, 0, 0], [0, 0, 0], [0, 0, 0]]}
sensors:
  ranges: {C: [[0, 0, 1]], source: {topic: array_recording, type: crazyflie_demo/crazyflie_sensors, fields: [front], stamp: receipt}}
  stabilizer: {C: [[1, 0, 0], [0, 1, 0]], source: {topic: cf1/log_pos, type: crazyflie_driver/GenericLogData, fields: [values.0, values.1]}}
sampling: {T1: 0, T2: .inf}
gains: {L: {ranges: [[0], [0], [1]], stabilizer: [[1, 0], [0, 1], [0, 0]]}}
"""

# Two sensors, each sampled at times of its own; what they measure comes late, in another order.
FUSED = """
plant: {states: [p, v], inputs: [u], A: [[0, 1], [0, 0]], B: [[0], [1]]}
sensors:
  gps: {C: [[1, 0]], source: {topic: gps}}
  wheel: {C: [[0, 1]], source: {topic: wheel}}
input: {topic: input}
scenario:
  duration: 10
  initial_state: {p: 1, v: 0}
  input: {rate: 20, formulas: {u: "sin(t)"}}
  sensors:
    gps: {schedule: {uniform: [0.2, 1]}, noise: {gaussian: 0.01}LATE}
    wheel: {schedule: {uniform: [0.05, 0.2]}, noise: {gaussian: 0.01}LATE}
"""
SCHEDULED = """
observer: TimeVaryingGainObserver
rate: 50
publish_delay: 1.5
sampling: {T1: 0.05, T2: 1}
gains:
  timers: {gps: [0, 0.6, 1], wheel: [0, 0.2]}
  P:
    0: [[2, 0], [0, 3]]
    1: [[2, 0.5], [0.5, 1]]
    2: [[1, 0.1], [0.1, 3]]
    3: [[1, 0.2], [0.2, 1]]
    4: [[0.5, 0], [0, 3]]
    5: [[0.5, 0.2], [0.2, 1]]
  K:
    gps: {0: [[0.1], [0]], 1: [[0.2], [0.1]], 2: [[0.4], [0.1]], 3: [[0.5], [0.2]],
          4: [[0.6], [0.3]], 5: [[0.7], [0.4]]}
    wheel: {0: [[0], [0.1]], 1: [[0], [0.4]], 2: [[0.1], [0.2]], 3: [[0.1], [0.5]],
            4: [[0.2], [0.3]], 5: [[0.2], [0.6]]}
"""


class ToolsTest(FolderTest):
    def setUp(self):
        super().setUp()
        self.scenario = self.write("scenario.yaml", SCENARIO)
        self.observer = self.write("observer.yaml", OBSERVER.replace("DELAY", "0"))

    def run_tool(self, tool, *arguments):
        result = subprocess.run([TOOLS[tool], *arguments], stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, universal_newlines=True, check=False,
                                timeout=60)
        return result.returncode, result.stdout

    def succeed(self, tool, *arguments):
        status, text = self.run_tool(tool, *arguments)
        self.assertEqual(status, 0, text)
        return text

    def fault(self, tool, *arguments, status=1):
        found, text = self.run_tool(tool, *arguments)
        self.assertEqual(found, status, text)
        return text

    def refuse(self, tool, *arguments):
        status, text = self.run_tool(tool, *arguments)
        self.assertIn(status, WRONG_USAGE, text)
        self.assertLess(len(text), 200)
        return text

    def simulate(self):
        self.succeed("simulate", self.scenario, "-o", self.path("run.bag"))

    def replay(self, *arguments):
        return [self.path("run.bag"), self.scenario, self.observer, *arguments]

    def test_numbers_that_are_none_are_wrong_usage(self):
        simulate = [self.scenario, "-o", self.path("run.bag")]
        for duration in ("nan", "inf", "0", "2e6"):
            self.assertIn("--duration: expected a number from 1e-09 to 1000000, found " + duration,
                          self.refuse("simulate", *simulate, "--duration", duration))
        for seed in ("-3", "nan", "1.5"):
            self.assertIn("--seed: expected a whole number >= 0, found " + seed,
                          self.refuse("simulate", *simulate, "--seed", seed))
        self.assertFalse(os.path.exists(self.path("run.bag")))
        self.write("run.bag", "")  # else BAG itself would be the fault
        for option in ("--from", "--to"):
            self.assertIn(option + ": expected a number >= 0, found nan",
                          self.refuse("replay", *self.replay("--truth", "truth", option, "nan")))
        self.assertIn("--thin: expected a number from",
                      self.refuse("replay", *self.replay("--thin", "nan", "1")))
        for percentage in ("nan", "-1", "101"):
            self.assertIn("--at-least: expected a number from 0 to 100, found " + percentage,
                          self.refuse("compare_estimates", "a", "b", "--at-least", percentage))

    def test_a_bag_without_the_input_is_refused_unless_told_otherwise(self):
        self.simulate()
        text = self.fault("replay", *self.replay("input:=/none"))
        self.assertIn("input: the bag has no topic /none", text)
        self.assertIn("--no-input", text)
        self.assertIn("/position (sampled_data_observers/Measurement)", text)
        text = self.succeed("replay", *self.replay("input:=/none", "--no-input", "--json",
                                                   self.path("summary.json")))
        self.assertIn("input       none: the bag has no topic /none\n", text)
        with open(self.path("summary.json")) as summary:
            self.assertEqual(json.load(summary)["not_recorded"], {"input": "/none"})
        self.assertNotIn("none:", self.succeed("replay", *self.replay("--no-input")))

    def test_inputs_from_several_topics_give_the_estimates_of_one_topic(self):
        self.scenario = self.write("scenario.yaml", TWO_INPUTS)
        self.simulate()
        together = self.summary()
        self.scenario = self.write("scenario.yaml", TWO_INPUTS.replace(
            "input: {topic: input}", "inputs: {w: {topic: wind}, u: {topic: push}}", 1))
        self.simulate()
        apart = self.summary()
        self.assertEqual(apart["final_state"], together["final_state"])
        self.assertEqual(apart["events_used"] - together["events_used"], 61)
        text = self.fault("replay", *self.replay("wind:=/none"))
        self.assertIn("inputs/w: the bag has no topic /none", text)

    def test_a_silent_input_is_told(self):
        self.scenario = self.write("scenario.yaml", SCENARIO)
        self.simulate()
        self.write("timeout.yaml", SCENARIO.replace(
            "{topic: input}", "{topic: input, min_interval: 1, timeout: 0.5, after_timeout: {u: 0}}"))
        self.scenario = self.path("timeout.yaml")
        text = self.succeed("replay", *self.replay("--json", self.path("summary.json")))
        self.assertIn("inputs      4 used, none for at most 1 s (from 100", text)
        self.assertRegex(text, r"            [67]\d estimates rest on one older than its timeout, "
                               r"from 1000\.500 s on\n")
        with open(self.path("summary.json")) as summary:
            self.assertEqual(json.load(summary)["inputs"]["input"]["longest_silence"], 1)

    def test_a_clock_that_is_ahead_is_told_by_how_much(self):
        self.simulate()
        self.write("ahead.yaml", SCENARIO.replace("source: {topic: position}",
                                                  "source: {topic: position, stamp_offset: 3.1}"))
        self.scenario = self.path("ahead.yaml")
        text = self.succeed("replay", *self.replay())
        self.assertRegex(text, r"clock       stamps of position are 3\.0\d+ s ahead of the clock in "
                               r"the median: stamp_offset: -3\.0\d+ in the source")

    def summary(self):
        self.succeed("replay", *self.replay("--json", self.path("summary.json")))
        with open(self.path("summary.json")) as summary:
            return json.load(summary)

    def replayed(self, bags, *configuration, status=0):
        json_file = self.path("summary.json")
        self.fault("replay", *bags, *configuration, "--json", json_file, status=status)
        with open(json_file) as file:
            return json.load(file)

    def test_one_file_serves_simulation_and_robot(self):
        # The same cart by messages of other packages' types, and of the package's own.
        self.simulate()
        own = self.replayed([self.path("run.bag")], self.scenario, self.observer)
        for number, (source, topic) in enumerate([
                ("{topic: pose, type: geometry_msgs/PoseStamped, fields: [pose.position.x]}",
                 "{topic: push, type: geometry_msgs/WrenchStamped, fields: [wrench.force.z]}"),
                ("{topic: odometry, type: nav_msgs/Odometry, fields: [pose.pose.position.y], frame: map}",
                 "{topic: joints, type: sensor_msgs/JointState, fields: [effort.motor]}"),
                ("{type: tf, frame: map, child_frame: cart, fields: [translation.x]}",
                 "{topic: push, type: geometry_msgs/WrenchStamped, fields: [wrench.force.z]}")]):
            scenario = self.write("standard.yaml", SCENARIO.replace("{topic: position}", source).replace(
                "{topic: input}", topic))
            bag = self.path("standard%d.bag" % number)
            self.succeed("simulate", scenario, "-o", bag)
            self.assertEqual(own["final_state"],
                             self.replayed([bag], scenario, self.observer)["final_state"])

    def test_simulated_fixes_are_read_back(self):
        self.simulate()
        own = self.replayed([self.path("run.bag")], self.scenario, self.observer)
        scenario = self.write("fixes.yaml", SCENARIO.replace(
            "{topic: position}", "{topic: fix, type: sensor_msgs/NavSatFix, fields: [east]}") +
            "\nnavsat: {datum: [48.3, 16.4, 180]}\n")
        self.succeed("simulate", scenario, "-o", self.path("fixes.bag"))
        read = self.replayed([self.path("fixes.bag")], scenario, self.observer)
        self.assertEqual("[48.300000000, 16.400000000, 180.0000]", read["datum"])
        self.assertEqual(own["samples_used"], read["samples_used"])
        for state, value in own["final_state"].items():
            self.assertAlmostEqual(value, read["final_state"][state], 6)

    def test_places_of_frames_in_formulas_are_those_of_the_bag(self):
        self.simulate()
        plant = SCENARIO.replace("A: [[0, 1], [0, 0]], B: [[0], [1]]", "parameters: %s, flow: {p: v, v: u}").replace(
            "C: [[1, 0]]", 'h: ["p + arm_x - 2*arm_y"]')
        numbers = self.write("numbers.yaml", plant.replace("%s", "{arm_x: -0.25, arm_y: 0.5}"))
        places = self.write("places.yaml", plant.replace("%s", "{arm: {frame: base, child_frame: tip}}"))
        text = self.fault("replay", self.path("run.bag"), places, self.observer)
        self.assertIn("plant/parameters/arm: expected the place of tip in base, from static_transforms or /tf_static", text)
        shutil.copy(self.path("run.bag"), self.path("tf.bag"))
        with rosbag.Bag(self.path("tf.bag"), "a") as bag:
            for parent, child, place in [("base", "mast", (-0.75, 0.25, 1)), ("mast", "tip", (0.5, 0.25, 0))]:
                transform = TransformStamped()
                transform.header.frame_id, transform.child_frame_id = parent, child
                transform.transform.translation = Vector3(*place)
                transform.transform.rotation.w = 1
                bag.write("/tf_static", TFMessage([transform]), genpy.Time(1))
        expected = self.replayed([self.path("run.bag")], numbers, self.observer)["final_state"]
        self.assertEqual(expected, self.replayed([self.path("tf.bag")], places, self.observer)["final_state"])

    def test_simulated_messages_tell_a_kalman_filter_of_their_noise(self):
        source = "{topic: odometry, type: nav_msgs/Odometry, fields: [pose.pose.position.x]}"
        scenario = self.write("noisy.yaml", SCENARIO.replace("{topic: position}", source).replace(
            "schedule: {period: 0.1}", "noise: {gaussian: 0.2}, schedule: {period: 0.01}"))
        self.succeed("simulate", scenario, "-o", self.path("noisy.bag"))
        gains = ("observer: HybridKalmanFilter\nsampling: {T1: 0.01, T2: 0.01}\n"
                 "gains: {P0: [[2, 0], [0, 2]], R: %s}\n")
        nis = [self.replayed([self.path("noisy.bag")], scenario, self.write("filter.yaml", gains % R))[
            "innovations"]["position"]["nis"] for R in ("message", "[[0.04]]", "{position: {message: {scale: 4}}}")]
        self.assertGreater(nis[0], 0.8)
        self.assertLess(nis[0], 1.2)
        self.assertAlmostEqual(nis[0], nis[1], 9)
        self.assertAlmostEqual(nis[0] / 4, nis[2], 1)

    def test_of_another_type_what_the_bag_has_is_listed(self):
        self.simulate()
        scenario = self.write("other.yaml", SCENARIO.replace(
            "{topic: position}", "{topic: position, type: nav_msgs/Odom, fields: [pose.pose.position.x]}"))
        text = self.fault("replay", self.path("run.bag"), scenario, self.observer)
        self.assertIn("expected nav_msgs/Odom on /position, found sampled_data_observers/Measurement in the bag", text)
        self.assertIn("/truth (sampled_data_observers/StateEstimate)", text)

    def wheel_type(self, definition):
        types = genpy.dynamic.generate_dynamic("my_msgs/Wheel", definition)
        return types["my_msgs/Wheel"]

    def write_wheels(self, name, stamps, wheel, topic):
        with rosbag.Bag(self.path(name), "w") as bag:
            for stamp in stamps:
                message = wheel()
                message.stamped.stamp = genpy.Time.from_sec(stamp)
                message.rims = ["steel"]
                message.places = [0.0, 10.0 * stamp]
                bag.write(topic, message, message.stamped.stamp)
        return self.path(name)

    def test_types_that_nobody_installed_are_read_from_bags(self):
        wheel = self.wheel_type("string[] rims\nfloat32[] places\nHeader stamped\n" + "=" * 80 +
                                "\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n")
        configuration = WHEELS.replace("TOPIC", "S-PTAM/wheel")
        self.write_wheels("all.bag", [1, 2, 3, 4, 5, 6], wheel, "S-PTAM/wheel")
        observer = self.write("wheel.yaml", configuration)
        whole = self.replayed([self.path("all.bag")], observer)
        self.assertEqual(whole["samples_used"], 6)
        self.assertEqual(whole["final_state"], {"x": 50.0})
        # The same in two bags, in whatever order they are given.
        first = self.write_wheels("first.bag", [1, 2, 3], wheel, "S-PTAM/wheel")
        second = self.write_wheels("second.bag", [4, 5, 6], wheel, "S-PTAM/wheel")
        for bags in ([first, second], [second, first]):
            halves = self.replayed([bags[0]], observer, bags[1])
            self.assertEqual(halves["samples_used"], 6)
            self.assertEqual(halves["final_state"], {"x": 50.0})
        # A name that ROS knows, with a slash or without.
        for given, recorded in (("/groundtruth", "groundtruth"), ("groundtruth", "groundtruth"),
                                ("groundtruth", "/groundtruth")):
            self.write_wheels("all.bag", [1, 2], wheel, recorded)
            observer = self.write("wheel.yaml", WHEELS.replace("TOPIC", given))
            self.assertEqual(self.replayed([self.path("all.bag")], observer)["samples_used"], 2)
        text = self.fault("replay", self.path("all.bag"),
                          self.write("wheel.yaml", WHEELS.replace("TOPIC", "groundtruth").replace(
                              "places.1", "place")))
        self.assertIn("places.INDEX, stamped.seq, found 'place'", text)

    def test_of_several_definitions_the_first_is_read(self):
        header = "=" * 80 + "\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"
        wheel = self.wheel_type("string[] rims\nfloat32[] places\nHeader stamped\n" + header)
        other = self.wheel_type("string[] rims\nfloat64[] places\nHeader stamped\n" + header)
        first = self.write_wheels("first.bag", [1, 2, 3], wheel, "/wheel")
        second = self.write_wheels("second.bag", [4, 5], other, "/wheel")
        observer = self.write("wheel.yaml", WHEELS.replace("TOPIC", "wheel"))
        summary = self.replayed([first], observer, second)
        self.assertEqual((summary["samples_used"], summary["samples_rejected"]), (3, 2))

    def test_a_robots_own_types_are_read_from_its_recording(self):
        bag = recordings.find("crazyflie_crash.bag")
        if bag is None:
            self.skipTest("crazyflie_crash.bag is not there")
        observer = self.write("crazyflie.yaml", CRAZYFLIE)
        summary = self.replayed([bag], observer)
        self.assertGreater(summary["samples_used"], 300)
        self.assertEqual(summary["samples_rejected"], 0)

    def test_a_bag_without_jumps_will_do_and_the_summary_says_so(self):
        self.scenario = self.write("jumping.yaml", JUMPING)
        self.simulate()
        self.assertIn("jumps       none: the bag has no topic /jumps\n",
                      self.succeed("replay", *self.replay()))

    def test_each_sensor_is_compared_with_its_own_times(self):
        self.scenario = self.write("scenario.yaml", TWO_SENSORS)
        self.observer = self.write("observer.yaml", FUSION)
        self.write("times.txt", "0.1\n0.2\n0.4\n0.5\n0.7\n")
        text = self.succeed("simulate", self.scenario, "-o", self.path("run.bag"))
        self.assertIn("simulate: scenario/sensors/wheel/schedule has times in [0.1, 0.2] s, not "
                      "all inside [0.05, 0.15] s", text)
        self.assertNotIn("gps/schedule", text)
        text = self.succeed("replay", *self.replay("--json", self.path("summary.json")))
        self.assertIn("intervals   of gps: 0.5 to 0.5 s, mean 0.5 s; 0 below T1 = 0.2 s, "
                      "0 above T2 = 1 s\n", text)
        self.assertIn("intervals   of wheel: 0.1 to 0.2 s, mean 0.15 s; 0 below T1 = 0.05 s, "
                      "2 above T2 = 0.15 s\n", text)
        with open(self.path("summary.json")) as summary:
            sensors = json.load(summary)["sensors"]
        self.assertEqual(sensors["gps"]["intervals"]["above_T2"], 0)
        self.assertEqual(sensors["wheel"]["intervals"]["above_T2"], 2)
        self.assertEqual(sensors["wheel"]["intervals"]["count"], 4)
        self.assertEqual(sensors["wheel"]["samples_used"], 5)
        self.assertEqual((sensors["gps"]["T1"], sensors["gps"]["T2"]), (0.2, 1))

    def test_each_sensor_is_thinned_to_its_own_times(self):
        self.scenario = self.write("scenario.yaml", DENSE)
        self.observer = self.write("observer.yaml", FUSION)
        self.simulate()
        text = self.succeed("replay", *self.replay("--thin-to-sampling", "--seed", "3", "--truth",
                                                   "truth", "--json", self.path("summary.json")))
        self.assertNotIn("intervals   of gps: 0.01", text)
        with open(self.path("summary.json")) as summary:
            found = json.load(summary)
        for name, T1, T2 in (("gps", 0.2, 1), ("wheel", 0.05, 0.15)):
            intervals = found["sensors"][name]["intervals"]
            self.assertEqual((intervals["below_T1"], intervals["above_T2"]), (0, 0), name)
            self.assertGreater(intervals["max"] - intervals["min"], 0.3 * (T2 - T1), name)
        self.assertGreater(found["sensors"]["wheel"]["samples_used"],
                           3 * found["sensors"]["gps"]["samples_used"])
        self.assertIn("--seed: needs --thin",
                      self.refuse("replay", *self.replay("--seed", "1")))
        self.assertIn("--thin: not beside",
                      self.refuse("replay", *self.replay("--thin-to-sampling", "--thin", "1", "2")))
        self.write("scenario.yaml", DENSE.replace("T1: 0.2", "T1: 0"))
        self.assertIn("expected T1 > 0 and a T2 in the sampling of gps, found T1 = 0",
                      self.fault("replay", *self.replay("--thin-to-sampling", "--truth", "truth")))

    def test_several_runs_are_those_of_single_ones(self):
        self.simulate()
        self.observer = self.write("observer.yaml",
                                   OBSERVER.replace("DELAY", "0").replace(
                                       "gains: {L: [[0.5], [0.5]]}\n", ""))
        gains = [self.write(name, "gains: {L: [[%g], [%g]]}\n" % (L, L))
                 for name, L in (("soft.yaml", 0.3), ("hard.yaml", 0.8))]
        thinned = ["--truth", "truth", "--thin", "0.1", "0.4"]
        single = []
        for file in gains:
            for seed in (2, 3, 4):
                self.succeed("replay", *self.replay(file, *thinned, "--seed", str(seed), "--json",
                                                    self.path("one.json")))
                with open(self.path("one.json")) as summary:
                    single.append(dict(json.load(summary), gains=file, seed=seed))
        text = self.succeed("replay", *self.replay(
            gains[0], *thinned, "--seed", "2", "--seeds", "3", "--gains", gains[0], "--gains",
            gains[1], "--json", self.path("runs.json")))
        self.assertEqual(len(re.findall("median", text)), 2)
        with open(self.path("runs.json")) as runs:
            found = json.load(runs)
        for run in single + found["runs"]:
            del run["wall_seconds"]
        self.assertEqual(found["runs"], single)
        for i, group in enumerate(found["gains"]):
            norms = sorted(run["rmse_norm"] for run in single[3 * i:3 * i + 3])
            self.assertLess(norms[0], norms[2])
            self.assertEqual(group["over_runs"]["RMSE norm"],
                             dict(zip(("min", "median", "max"), norms)))
        self.assertIn("--seeds: needs --thin",
                      self.refuse("replay", *self.replay("--seeds", "2")))
        self.assertIn("--gains: a table of runs, not beside",
                      self.refuse("replay", *self.replay("--gains", gains[0], "-o",
                                                         self.path("out.bag"))))

    def test_errors_around_jumps_are_told_apart(self):
        self.scenario = self.write("scenario.yaml", BOUNCING)
        self.observer = self.write("observer.yaml", OBSERVER.replace("DELAY", "0"))
        self.simulate()
        truth = ["--truth", "truth", "--json", self.path("summary.json")]
        self.assertNotIn("around", self.succeed("replay", *self.replay(*truth)))
        text = self.succeed("replay", *self.replay(*truth, "--around-jumps", "0.02"))
        self.assertIn("but for 0.02 s around each of 6 jumps, at ", text)
        with open(self.path("summary.json")) as summary:
            apart = json.load(summary)["apart_from_jumps"]
        self.assertEqual(apart["jumps"], 6)
        self.assertLess(apart["compared_stamps"], 300)
        self.assertLessEqual(apart["peak_free"], apart["peak"])
        self.assertGreater(apart["rmse_norm"], 0.0)
        self.observer = self.write("observer.yaml", OBSERVER.replace("DELAY", "0") +
                                   "jumps: {stamp_error: 0.01}\n")
        self.scenario = self.write("plant.yaml", BOUNCING.replace("jumps: {}\n", ""))
        self.assertIn("but for 0.01 s around each of 6 jumps, at ",
                      self.succeed("replay", *self.replay(*truth)))
        self.assertIn("--around-jumps: needs a truth",
                      self.refuse("replay", *self.replay("--around-jumps", "1")))

    def test_estimates_begin_where_they_are_to_begin(self):
        self.write("observer.yaml", OBSERVER.replace("DELAY", "0") + "start: {at: 999.9}\n")
        # The first event comes at 1000 s, the last at 1003.04 s.
        self.simulate()
        text = self.succeed("replay", *self.replay())
        self.assertIn("estimates   158,", text)
        self.write("observer.yaml", OBSERVER.replace("DELAY", "0") + "start: {at: 1001.5}\n")
        text = self.succeed("replay", *self.replay())
        self.assertIn("estimates   78,", text)
        self.assertIn(" older than the history window, the start or the last reset\n", text)

    def test_a_comparison_that_begins_after_the_bag_is_refused(self):
        self.simulate()
        text = self.fault("replay", *self.replay("--truth", "truth", "--from", "100"))
        self.assertIn("--from 100: expected at most 3 s", text)
        self.assertIn("against the truth at ",
                      self.succeed("replay", *self.replay("--truth", "truth", "--from", "2.5")))
        self.assertIn("need a truth", self.refuse("replay", *self.replay("--from", "1")))
        self.assertIn("later than --to", self.refuse(
            "replay", *self.replay("--truth", "truth", "--from", "2", "--to", "1")))

    def test_a_picture_of_another_format_is_refused_before_the_run(self):
        self.simulate()
        text = self.refuse("replay", *self.replay("--plot", self.path("x.gif")))
        self.assertIn("--plot: expected a file name that ends in .png, .pdf or .svg", text)

    def test_a_picture_shows_the_jumps(self):
        for scenario, has_jumps in ((SCENARIO, False), (BOUNCING, True)):
            self.scenario = self.write("scenario.yaml", scenario)
            self.simulate()
            self.succeed("replay", *self.replay("--plot", self.path("run.svg")))
            with open(self.path("run.svg"), encoding="utf-8") as picture:
                # Matplotlib draws letters, and keeps texts as comments.
                self.assertEqual("<!-- jumps used -->" in picture.read(), has_jumps)

    def test_an_estimate_that_diverges_has_an_exit_status_of_its_own(self):
        self.simulate()
        self.assertNotIn("DIVERGED", self.succeed("replay", *self.replay()))
        self.observer = self.write("observer.yaml", OBSERVER.replace("DELAY", "0").replace(
            "[[0.5], [0.5]]", "[[-0.5], [-0.5]]"))
        self.succeed("simulate", self.scenario, "-o", self.path("run.bag"), "--duration", "20")
        text = self.fault("replay", *self.replay("--json", self.path("summary.json")), status=3)
        self.assertIn("with samples every 0.1 s, inside of [T1, T2], the error grows by the factor",
                      text)
        self.assertIn("DIVERGED: the innovations of position grew a thousandfold", text)
        with open(self.path("summary.json")) as summary:
            self.assertTrue(json.load(summary)["diverged"])

    def test_a_flow_without_value_at_the_end_is_a_divergence(self):
        self.scenario = self.write("scenario.yaml", ESCAPING)
        self.observer = self.write("observer.yaml", BLIND)
        self.simulate()
        text = self.fault("replay", *self.replay(), status=3)
        self.assertIn("DIVERGED: the flow of the model is not finite at the end", text)

    def test_a_truth_that_refutes_the_bound_has_an_exit_status_of_its_own(self):
        self.scenario = self.write("scenario.yaml", CERTIFIED)
        self.simulate()
        self.observer = self.write("observer.yaml", "rate: 50\n")
        text = self.fault("replay", *self.replay())
        found = re.search("plant/hash: expected ([0-9a-f-]+)", text).group(1)
        self.scenario = self.write("scenario.yaml", CERTIFIED.replace("HASH", found))
        assumed = "error_assumptions: {initial_error: %s, noise: 0}\n"
        self.observer = self.write("observer.yaml", "rate: 50\n" + assumed % 2)
        self.assertNotIn("BROKEN", self.succeed("replay", *self.replay("--truth", "truth")))
        # The plant starts 1 off: who says that it starts nearer is refuted.
        self.observer = self.write("observer.yaml", "rate: 50\n" + assumed % 0.5)
        text = self.fault("replay", *self.replay("--truth", "truth"), status=2)
        self.assertIn("GUARANTEE BROKEN: the error was larger than its guaranteed bound at ", text)
        self.succeed("replay", *self.replay())

    def test_gains_that_depend_on_several_timers_give_the_same_bits_whatever_comes_late(self):
        self.observer = self.write("observer.yaml", SCHEDULED)
        bags = []
        for late in ("", ", latency: [0, 0.14], reordering: 0.3"):
            self.scenario = self.write("scenario.yaml", FUSED.replace("LATE", late))
            self.simulate()
            bags.append(self.path("late_%d.bag" % bool(late)))
            summary = ["--truth", "truth", "--from", "5", "--json", self.path("summary.json")]
            self.succeed("replay", *self.replay("-o", bags[-1], *summary))
            with open(self.path("summary.json")) as written:
                self.assertLess(json.load(written)["rmse_norm"], 0.05)
        text = self.succeed("compare_estimates", *bags, "--at-least", "100")
        self.assertIn("identical bit for bit on 501 of 501", text)

    def test_estimates_that_rest_on_other_events_are_no_agreement(self):
        self.simulate()
        bags = []
        for delay in ("0", "0.06"):
            self.observer = self.write("observer.yaml", OBSERVER.replace("DELAY", delay))
            bags.append(self.path("delay_%s.bag" % delay))
            self.succeed("replay", *self.replay("-o", bags[-1]))
        self.assertIn("100.0 % of all", self.succeed("compare_estimates", bags[0], bags[0]))
        text = self.fault("compare_estimates", *bags)
        self.assertIn("they agree, but on too few: expected 50 % of all", text)
        self.assertIn("publish_delay above the latency", text)
        self.succeed("compare_estimates", *bags, "--at-least", "1")

    def test_estimates_of_other_times_are_nothing_to_compare(self):
        bags = []
        for start in ("1000", "5000"):
            self.scenario = self.write("scenario.yaml", SCENARIO.replace("  duration:", "  start: %s\n  duration:" % start))
            self.observer = self.write("observer.yaml", OBSERVER.replace("DELAY", "0"))
            self.simulate()
            bags.append(self.path("from_%s.bag" % start))
            self.succeed("replay", *self.replay("-o", bags[-1]))
        text = self.fault("compare_estimates", *bags)
        self.assertIn(" 0 stamps in both", text)
        self.assertIn("nothing to compare. Live,", text)

    def test_as_many_events_that_are_others_are_not_the_same(self):
        self.observer = self.write("observer.yaml", OBSERVER.replace("DELAY", "0.06"))
        bags = []
        for position in ("1", "2"):
            self.scenario = self.write("scenario.yaml", SCENARIO.replace("p: 1", "p: " + position).replace("[0.03, 0.05]", "[0.03, 0.03]"))
            self.simulate()
            bags.append(self.path("from_%s.bag" % position))
            self.succeed("replay", *self.replay("-o", bags[-1]))
        text = self.fault("compare_estimates", *bags)
        self.assertIn("they agree, but on too few: expected 50 % of all", text)


if __name__ == "__main__":
    for name in ("simulate", "replay", "compare_estimates"):
        TOOLS[name] = sys.argv.pop(1)
    unittest.main()
