#!/usr/bin/env python3
"""Examples whose jumps a detector finds in a simulated signal, in place of the simulator's events."""
import json
import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "support"))
from ros_tools import PACKAGE, run_tool  # noqa: E402

EXAMPLES = os.path.realpath(os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..",
                                         "config", "examples"))
PERIOD = 0.001  # s, of the signals


class DetectedJumpsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def simulate(self, example):
        self.example = os.path.join(EXAMPLES, example)
        run_tool("simulate", os.path.join(self.example, "scenario.yaml"), "-o",
                 self.path("simulated.bag"))

    def replay(self, observer, *arguments):
        """Returns the summary and the stamps of the jumps that were used."""
        import rosbag
        from sampled_data_observers.msg import EventStatus

        output = self.path(observer + ".bag")
        summary = self.path("summary.json")
        configs = [os.path.join(self.example, name)
                   for name in ("scenario.yaml", observer, "gains.yaml")]
        run_tool("replay", self.path("simulated.bag"), *configs, "-o", output, "--truth", "truth",
                 "--json", summary, *arguments)
        with rosbag.Bag(output) as bag:
            jumps = [status.header.stamp.to_sec() for _, status, _ in bag.read_messages("/events")
                     if status.kind == EventStatus.JUMP
                     and status.outcome in (EventStatus.USED, EventStatus.USED_LATE)]
        with open(summary) as file:
            return json.load(file), jumps

    def test_spikes_in_the_membrane_potential(self):
        self.simulate("bernard2022_neuron_high_gain")
        told, true_jumps = self.replay("observer.yaml", "--from", "20")
        found, jumps = self.replay("observer_detected.yaml", "--from", "20")
        self.assertEqual(2, len(true_jumps))
        self.assertEqual(len(true_jumps), len(jumps))
        for jump, true_jump in zip(jumps, true_jumps):
            self.assertLess(abs(jump - true_jump), PERIOD)
        # The parameters a and b are off by little more than where the spikes are told exactly.
        self.assertLess(found["rmse_norm"], 1.5 * told["rmse_norm"])
        self.assertLess(found["rmse_norm"], 0.05)

    def test_bounces_in_the_velocity(self):
        self.simulate("bernard2022_bouncing_ball")
        told, true_jumps = self.replay("observer.yaml", "--from", "3", "--to", "6.5")
        found, jumps = self.replay("observer_detected.yaml", "--from", "3", "--to", "6.5")
        # The last bounces, milliseconds apart, are too fast for the signal.
        self.assertEqual(33, len(true_jumps))
        self.assertGreater(len(jumps), 28)
        for jump, true_jump in zip(jumps[:15], true_jumps[:15]):
            self.assertLess(abs(jump - true_jump), PERIOD)
        self.assertLess(found["rmse_norm"], 1.01 * told["rmse_norm"])


if __name__ == "__main__":
    import rostest
    rostest.rosrun(PACKAGE, "detected_jumps_test", DetectedJumpsTest, sys.argv)
