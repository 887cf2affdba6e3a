#!/usr/bin/env python3
"""Examples whose jumps a detector finds in a simulated signal, in place of the simulator's events, and a
detector that gets too many signals."""
import json
import os
import subprocess
import sys
import tempfile
import threading
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "support"))
from ros_tools import PACKAGE, find_tool, run_tool  # noqa: E402

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

    def test_a_live_detector_tells_of_signals_that_it_could_not_take_in(self):
        import rospy
        from sampled_data_observers.msg import Measurement

        rospy.init_node("detected_jumps_test", anonymous=True)
        rospy.set_param("/flooded/jumps/detector", {
            "source": {"topic": "signal", "type": "sampled_data_observers/Measurement",
                       "fields": {"value": "values.0"}},
            "signal": "value", "threshold": 0})
        # Nobody reads its log, of a line for each jump: it waits as soon as the pipe is full.
        detector = subprocess.Popen([find_tool("jump_detector"), "__name:=flooded"],
                                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.addCleanup(detector.stdout.close)
        self.addCleanup(detector.wait)
        self.addCleanup(detector.kill)
        publisher = rospy.Publisher("signal", Measurement, queue_size=None)
        while publisher.get_num_connections() == 0:
            time.sleep(0.1)
        start = rospy.Time.now() - rospy.Duration(60)
        for i in range(12000):
            message = Measurement(values=[1.0 if i % 2 else -1.0])
            message.header.stamp = start + rospy.Duration(PERIOD * i)
            publisher.publish(message)
        time.sleep(1.0)  # for what is under way
        end = threading.Timer(20.0, detector.kill)
        end.start()
        self.addCleanup(end.cancel)
        lines = iter(detector.stdout.readline, b"")
        self.assertTrue(any(b"messages on /signal come faster than they are used" in line
                            for line in lines))

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
