#!/usr/bin/env python3
"""Every example of the papers, launched live: its estimates are those of simulate and replay."""
import concurrent.futures
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
           "bernard2022_clutch": (10, 4), "bernard2022_impulsive": (40, 16), "sferlazza2019_aircraft_1_3": (40, 8),
           "sferlazza2019_aircraft_4_8": (40, 8)}

# How many of the estimates must rest on the same events live and replayed, in percent. The others had
# an event still on its way when they were published, which is more often so where the machine is
# busy, or come after the last message of the bag.
AT_LEAST = 20


# Most of a launch is waiting.
AT_ONCE = 3


class LiveExamplesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        launches = {"in_real_time": ("ferrante2016_mass_spring", "duration:=12")}
        for name in example_names():
            launches[name] = (name, *("%s:=%d" % argument for argument in zip(
                ("duration", "speed"), SPECIAL.get(name, USUAL))))
        pool = concurrent.futures.ThreadPoolExecutor(AT_ONCE)
        cls.launched = {run: pool.submit(cls.launch, run, *arguments)
                        for run, arguments in launches.items()}

    @classmethod
    def tearDownClass(cls):
        concurrent.futures.wait(cls.launched.values())
        cls.folder.cleanup()

    @classmethod
    def path(cls, run, name):
        os.makedirs(os.path.join(cls.folder.name, run), exist_ok=True)
        return os.path.join(cls.folder.name, run, name)

    @classmethod
    def launch(cls, run, name, *arguments):
        port = free_port()
        command = ["roslaunch", "--port", str(port),
                   os.path.join(EXAMPLES, name, name + ".launch"),
                   "output:=" + cls.path(run, "live.bag"), *arguments]
        with RosProcess(command, port) as process:
            process.wait(120)

    def check(self, name):
        self.launched[name].result()
        duration, _ = SPECIAL.get(name, USUAL)
        scenario = [path for path in (os.path.join(EXAMPLES, name, "plant.yaml"),
                                      os.path.join(EXAMPLES, name, "scenario.yaml"))
                    if os.path.exists(path)]
        run_tool("simulate", *scenario, "-o", self.path(name, "simulated.bag"), "--duration",
                 str(duration))
        run_tool("replay", self.path(name, "simulated.bag"), *scenario,
                 os.path.join(EXAMPLES, name, "observer.yaml"),
                 os.path.join(EXAMPLES, name, "gains.yaml"), "-o",
                 self.path(name, "replayed.bag"))
        run_tool("compare_estimates", self.path(name, "live.bag"),
                 self.path(name, "replayed.bag"), "--at-least", str(AT_LEAST))

    def test_in_real_time_the_estimates_approach_the_truth(self):
        import rosbag
        self.launched["in_real_time"].result()
        truth = {}
        errors = []
        with rosbag.Bag(self.path("in_real_time", "live.bag")) as bag:
            for topic, message, _ in bag.read_messages(["/truth", "/estimate"]):
                stamp = message.header.stamp.to_nsec()
                if topic == "/truth":
                    truth[stamp] = message.state
                elif stamp in truth:
                    errors.append(max(abs(a - b) for a, b in zip(truth[stamp], message.state)))
        self.assertGreater(len(errors), 400)
        self.assertLess(errors[-1], 0.5 * max(errors))


def example_names():
    names = sorted(os.listdir(EXAMPLES))
    assert len(names) >= 13, names
    return names


def add_tests():
    for name in example_names():
        setattr(LiveExamplesTest, "test_%s_live_as_replayed" % name,
                lambda self, name=name: self.check(name))


add_tests()

if __name__ == "__main__":
    import rostest
    rostest.rosrun(PACKAGE, "live_examples_test", "live_examples_test", sys.argv)
