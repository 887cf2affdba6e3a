#!/usr/bin/env python3
"""Examples whose jumps a detector finds in a simulated signal, in place of the simulator's events, and a
detector that gets too many signals."""
import json
import math
import os
import subprocess
import sys
import tempfile
import threading
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "support"))
from ros_tools import PACKAGE, RosProcess, find_tool, free_port, run_tool  # noqa: E402

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

    def simulate(self, example, scenario="scenario.yaml"):
        self.example = os.path.join(EXAMPLES, example)
        self.scenario = scenario
        run_tool("simulate", os.path.join(self.example, scenario), "-o",
                 self.path("simulated.bag"))

    def replay(self, observer, *arguments):
        """Returns the summary and the stamps of the jumps that were used."""
        import rosbag
        from sampled_data_observers.msg import EventStatus

        output = self.path(observer + ".bag")
        summary = self.path("summary.json")
        configs = [os.path.join(self.example, name)
                   for name in (self.scenario, observer, "gains.yaml")]
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

    def test_a_live_detector_tells_the_mode_and_what_is_measured(self):
        import rospy
        from sampled_data_observers.msg import JumpEvent, Measurement

        rospy.init_node("detected_jumps_test", anonymous=True)
        rospy.set_param("/stepping/jumps/detector", {
            "source": {"topic": "stairs", "type": "sampled_data_observers/Measurement",
                       "fields": {"value": "values.0", "number": "values.1"}},
            "signal": "value", "kind": "step", "window": 3, "threshold": 0.5,
            "mode": "value == 1 ? 7 : value / 2", "outputs": ["number"]})
        jumps = []
        rospy.Subscriber("jumps", JumpEvent, jumps.append)
        detector = subprocess.Popen([find_tool("jump_detector"), "__name:=stepping"],
                                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                    universal_newlines=True)
        self.addCleanup(detector.stdout.close)
        self.addCleanup(detector.wait)
        self.addCleanup(detector.kill)
        publisher = rospy.Publisher("stairs", Measurement, queue_size=None)
        while publisher.get_num_connections() == 0:
            time.sleep(0.1)
        start = rospy.Time.now() - rospy.Duration(1)
        # Up by one every 20 samples: into mode 7, then 1, 1.5, which is none, and 2.
        for i in range(100):
            message = Measurement(values=[i // 20, i])
            message.header.stamp = start + rospy.Duration(PERIOD * i)
            publisher.publish(message)
        end = time.time() + 10
        while len(jumps) < 3 and time.time() < end:
            time.sleep(0.1)
        self.assertEqual([7, 1, 2], [jump.mode for jump in jumps])
        self.assertEqual([(19,), (39,), (79,)], [jump.values for jump in jumps])
        for jump, before in zip(jumps, (19, 39, 79)):
            found = (jump.header.stamp - start).to_sec()
            self.assertAlmostEqual(PERIOD * (before + 0.5), found, delta=2e-6)
        detector.terminate()
        self.assertIn("its mode, 1.5, is no whole number", detector.stdout.read())

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

    def published_error(self, observer, begin, end):
        """The root mean square of the error of what was published, over these seconds."""
        import rosbag

        with rosbag.Bag(self.path("simulated.bag")) as bag:
            truth = {message.header.stamp.to_nsec(): message.state
                     for _, message, _ in bag.read_messages("/truth")}
        start = min(truth)
        squares = []
        with rosbag.Bag(self.path(observer + ".bag")) as bag:
            for _, message, _ in bag.read_messages("/estimate"):
                stamp = message.header.stamp.to_nsec()
                if begin <= (stamp - start) * 1e-9 <= end:
                    squares.append(sum((a - b) ** 2
                                       for a, b in zip(truth[stamp], message.state)))
        self.assertGreater(len(squares), 100)
        return math.sqrt(sum(squares) / len(squares))

    def test_bounces_in_a_noisy_velocity(self):
        self.simulate("bernard2022_bouncing_ball", "scenario_noisy.yaml")
        _, true_jumps = self.replay("observer.yaml")
        _, jumps = self.replay("observer_noisy.yaml")
        for jump in jumps:
            self.assertLess(min(abs(jump - true_jump) for true_jump in true_jumps), PERIOD)
        # Nearly all that are faster than 0.2 m/s: from one to the next the ball falls half of the time.
        fast = [true_jump for previous, true_jump in zip([0] + true_jumps, true_jumps)
                if 9.81 * (true_jump - previous) / 2 > 0.2]
        found = [true_jump for true_jump in fast
                 if min(abs(jump - true_jump) for jump in jumps) < PERIOD]
        self.assertGreaterEqual(len(fast), 17)
        self.assertGreaterEqual(len(found), 0.95 * len(fast))
        # A bounce is known some milliseconds late, which is made up for.
        self.assertLess(self.published_error("observer_noisy.yaml", 3, 7),
                        1.01 * self.published_error("observer.yaml", 3, 7))

        port = free_port()
        launch = os.path.join(self.example, "bernard2022_bouncing_ball.launch")
        command = ["roslaunch", "--port", str(port), launch, "scenario:=scenario_noisy.yaml",
                   "observer:=observer_noisy.yaml", "wait_for_subscribers:=false",
                   "sim_time:=true", "output:=" + self.path("live.bag")]
        with RosProcess(command, port) as process:
            process.wait(60)
        run_tool("compare_estimates", self.path("live.bag"), self.path("observer_noisy.yaml.bag"),
                 "--at-least", "20")


if __name__ == "__main__":
    import rostest
    rostest.rosrun(PACKAGE, "detected_jumps_test", DetectedJumpsTest, sys.argv)
