#!/usr/bin/env python3
"""The robots of config/ that have a scenario, simulated and replayed, and what doc/migration.md says to those who come from
robot_localization: robots_test.py SIMULATE REPLAY"""
import json
import os
import re
import subprocess
import sys
import unittest

HERE = os.path.dirname(os.path.realpath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "support"))
from folder_test import FolderTest  # noqa: E402

ROOT = os.path.join(HERE, "..", "..")
CONFIG = os.path.join(ROOT, "config")
TOOLS = {}

# The parameters of robot_localization's ekf_template.yaml, but for those of its sensors.
PARAMETERS = """frequency silent_tf_failure sensor_timeout two_d_mode transform_time_offset transform_timeout
print_diagnostics debug debug_out_file publish_tf publish_acceleration permit_corrected_publication map_frame odom_frame
base_link_frame world_frame use_control stamped_control control_timeout control_config acceleration_limits
deceleration_limits acceleration_gains deceleration_gains process_noise_covariance initial_estimate_covariance
odom0 odom1 pose0 twist0 imu0 imu0_remove_gravitational_acceleration""".split()
OF_SENSORS = {
    "config": "odom0 odom1 pose0 twist0 imu0", "queue_size": "odom0 odom1 pose0 twist0 imu0",
    "nodelay": "odom0 odom1 pose0 twist0 imu0", "differential": "odom0 odom1 pose0 imu0",
    "relative": "odom0 odom1 pose0 imu0",
    "rejection_threshold": "odom0_pose odom0_twist odom1_pose odom1_twist pose0 twist0 imu0_pose imu0_twist "
                           "imu0_linear_acceleration"}

# What an example of the document leaves to its reader, and the topic that replay then misses.
BESIDE = [("""
plant: {states: [x, y], A: [[0, 0], [0, 0]]}
observer: HybridKalmanFilter
frame_id: map
gains: {P0: {diagonal: [1, 1]}, R: {gps: {diagonal: [1, 1]}}}
""", "/fix"), ("""
plant: {states: [x, y, w], flow: {x: "0", y: "0", w: "0*x"}}
observer: HybridKalmanFilter
frame_id: map
sampling: {T1: 0.1, T2: 1}
gains: {P0: {diagonal: [1, 1, 1]}, R: {odom0_pose: {diagonal: [1, 1]}, odom0_twist: {diagonal: [1]}}}
""", "/example/odom"), ("""
observer: HybridKalmanFilter
sensors: {pose: {h: [x, y], source: {topic: example/odom}}}
sampling: {T1: 0.1, T2: 1}
gains: {P0: {diagonal: [1, 1, 1, 1, 1]}, R: {pose: {diagonal: [1, 1]}}}
""", "/example/odom")]


class RobotsTest(FolderTest):
    def errors(self, robot, seed, observer=None):
        """Root mean squares of the states' errors, once the start is forgotten."""
        scenario = os.path.join(CONFIG, robot + "_scenario.yaml")
        observer = observer or os.path.join(CONFIG, robot + ".yaml")
        bag, summary = self.path("robot.bag"), self.path("summary.json")
        for command in (
                [TOOLS["simulate"], observer, scenario, "-o", bag,
                 "--seed", str(seed)],
                [TOOLS["replay"], bag, observer, "--truth", "truth", "--from", "5", "--json", summary]):
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        with open(summary) as written:
            found = json.load(written)
        self.assertEqual({}, found["rejected"])
        for sensor in found["sensors"].values():
            self.assertEqual(0, sensor["intervals"]["above_T2"])
        for sensor, innovation in found["innovations"].items():
            share = innovation["nis"] / len(innovation["rms"])
            self.assertTrue(0.7 < share < 1.3, f"NIS of {sensor}: {share} times the number of its outputs")
        print(robot, found["rmse"])
        return found["rmse"]

    def assert_within(self, bounds, errors):
        for states, bound in bounds.items():
            for state in states.split():
                self.assertLess(errors[state], bound, state)

    PLANAR = {"x y": 0.06, "yaw": 0.03, "vx": 0.03, "w": 0.02, "vy": 0.012, "gyro_bias": 0.003}

    def test_on_the_plane(self):
        self.assert_within(self.PLANAR, self.errors("planar_robot", 1))

    def test_on_the_plane_with_the_covariances_of_messages(self):
        with open(os.path.join(CONFIG, "planar_robot.yaml"), encoding="utf-8") as robot:
            text = robot.read()
        for old, new in (("      frame: map\n", ""),
                         ("pose: {diagonal: [2.5e-3, 2.5e-3, 1e-3]}", "pose: message")):
            self.assertIn(old, text)
            text = text.replace(old, new)
        self.assert_within(self.PLANAR, self.errors("planar_robot", 2, self.write("robot.yaml", text)))

    def test_in_space(self):
        self.assert_within({"x y z": 0.06, "roll pitch": 0.004, "yaw": 0.02, "vx vy vz": 0.015,
                            "wx wy wz": 0.025, "ax ay az": 0.04}, self.errors("spatial_robot", 1))


class MigrationTest(FolderTest):
    def setUp(self):
        super().setUp()
        with open(os.path.join(ROOT, "doc", "migration.md"), encoding="utf-8") as document:
            self.text = document.read()

    def test_every_parameter_of_the_template_has_a_row(self):
        named = set()
        for row in re.findall(r"^\| (`[^|]*) \|", self.text, re.MULTILINE):
            whole = re.findall(r"`([^`]*)`", row)
            named.update(whole)
            # `odom0_queue_size`, `odom1_…`: the same parameter of another sensor.
            for name in whole:
                if name.endswith("…"):
                    end = next(end for end in OF_SENSORS if whole[0].endswith(end))
                    named.add(name[:-1] + end)
        for end, sensors in OF_SENSORS.items():
            for sensor in sensors.split():
                self.assertIn(sensor + "_" + end, named)
        for parameter in PARAMETERS:
            self.assertIn(parameter, named)

    def test_its_examples_are_valid_as_they_stand(self):
        robot = [os.path.join(CONFIG, "planar_robot" + end) for end in (".yaml", "_scenario.yaml")]
        subprocess.run([TOOLS["simulate"], *robot, "-o", self.path("robot.bag"), "--duration", "1"],
                       check=True, stdout=subprocess.DEVNULL)
        examples = re.findall(r"```yaml\n(.*?)```", self.text, re.DOTALL)
        self.assertEqual(len(BESIDE), len(examples))
        for example, (beside, topic) in zip(examples, BESIDE):
            # All that replay has against them is what it finds in the bag.
            found = subprocess.run(
                [TOOLS["replay"], self.path("robot.bag"), self.write("example.yaml", example),
                 self.write("beside.yaml", beside)], check=False, stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT, universal_newlines=True)
            self.assertIn("the bag has no topic " + topic, found.stdout)


if __name__ == "__main__":
    for name in ("simulate", "replay"):
        TOOLS[name] = sys.argv.pop(1)
    unittest.main()
