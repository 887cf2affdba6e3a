#!/usr/bin/env python3
"""Every example of the papers, launched live: its estimates are those of simulate and replay."""
import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "support"))
from ros_tools import PACKAGE, RosProcess, free_port, run_tool  # noqa: E402

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", ".."))
EXAMPLES = os.path.join(ROOT, "config", "examples")

# How much of each is run, and how fast: simulated seconds, and those per second. Neurons send their
# potential 500 and 1000 times a second.
USUAL = (20, 8)
SPECIAL = {"bernard2022_neuron_high_gain": (10, 2), "bernard2022_neuron_jump_based": (10, 2),
           "bernard2022_impulsive": (40, 16), "sferlazza2019_aircraft_1_3": (40, 8),
           "sferlazza2019_aircraft_4_8": (40, 8)}

# How many of the estimates must rest on the same events live and replayed. The others had an event
# still on its way when they were published, or come after the last message of the bag.
AT_LEAST = 75


class LiveExamplesTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def launch(self, name, *arguments):
        port = free_port()
        command = ["roslaunch", "--port", str(port),
                   os.path.join(EXAMPLES, name, name + ".launch"),
                   "output:=" + self.path("live.bag"), *arguments]
        with RosProcess(command, port) as process:
            process.wait(120)

    def check(self, name):
        duration, speed = SPECIAL.get(name, USUAL)
        self.launch(name, "duration:=%d" % duration, "speed:=%d" % speed)
        scenario = [path for path in (os.path.join(EXAMPLES, name, "plant.yaml"),
                                      os.path.join(EXAMPLES, name, "scenario.yaml"))
                    if os.path.exists(path)]
        run_tool("simulate", *scenario, "-o", self.path("simulated.bag"), "--duration",
                 str(duration))
        run_tool("replay", self.path("simulated.bag"), *scenario,
                 os.path.join(EXAMPLES, name, "observer.yaml"),
                 os.path.join(EXAMPLES, name, "gains.yaml"), "-o", self.path("replayed.bag"))
        run_tool("compare_estimates", self.path("live.bag"), self.path("replayed.bag"),
                 "--at-least", str(AT_LEAST))

    def test_in_real_time_the_estimates_approach_the_truth(self):
        import rosbag
        self.launch("ferrante2016_mass_spring", "duration:=12")
        truth = {}
        errors = []
        with rosbag.Bag(self.path("live.bag")) as bag:
            for topic, message, _ in bag.read_messages(["/truth", "/estimate"]):
                stamp = message.header.stamp.to_nsec()
                if topic == "/truth":
                    truth[stamp] = message.state
                elif stamp in truth:
                    errors.append(max(abs(a - b) for a, b in zip(truth[stamp], message.state)))
        self.assertGreater(len(errors), 400)
        self.assertLess(errors[-1], 0.5 * max(errors))


def add_tests():
    names = sorted(os.listdir(EXAMPLES))
    assert len(names) >= 13, names
    for name in names:
        setattr(LiveExamplesTest, "test_%s_live_as_replayed" % name,
                lambda self, name=name: self.check(name))


add_tests()

if __name__ == "__main__":
    import rostest
    rostest.rosrun(PACKAGE, "live_examples_test", "live_examples_test", sys.argv)
