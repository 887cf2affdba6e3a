#!/usr/bin/env python3
"""Every example of the papers, launched live: its estimates are those of simulate and replay, also
where jumps are told wrongly and the observer is guarded against that."""
import concurrent.futures
import os
import re
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

# Examples whose jumps are missed, invented and told twice: simulated seconds, those per second, the
# observer's files, how often neurons send their potential [s], and what goes wrong.
GUARDED = "observer_guarded.yaml"
MISTAKEN = {
    "bernard2022_bouncing_ball": (8, 8, (GUARDED, "gains_kalman_jitter.yaml"), None, """
scenario: {seed: 5, jumps: {missed: 0.1, duplicate: 0.2, false_rate: 0.3, stamp_error: 0.002}}
"""),
    "bernard2022_neuron_high_gain": (50, 10, (GUARDED, "gains.yaml"), 0.005, """
scenario: {seed: 2, jumps: {missed: 0.3, duplicate: 1, false_rate: 0.1, stamp_error: 0.002}}
"""),
    "bernard2022_neuron_jump_based": (120, 24, (GUARDED, "gains.yaml"), 0.02, """
scenario: {seed: 4, jumps: {missed: 0.3, duplicate: 0.5, false_rate: 0.03, stamp_error: 0.01}}
"""),
    "bernard2022_impulsive": (30, 15, ("observer.yaml", "gains.yaml"), None, """
scenario: {seed: 6, jumps: {missed: 0.2, duplicate: 0.5, false_rate: 0.1, stamp_error: 0.02}}
"""),
    "bernard2022_switched": (16, 8, ("observer.yaml", "gains.yaml"), None, """
scenario: {jumps: {missed: 0.2, duplicate: 0.5, false_rate: 0.1, stamp_error: 0.02}}
"""),
}

# A robot of config/, whose file and scenario are all it takes.
ROBOT = "planar_robot"

# How many of the estimates must rest on the same events live and replayed, in percent. The others had
# an event still on its way when they were published, which is more often so where the machine is
# busy, or come after the last message of the bag.
AT_LEAST = 5


# The one that ends with a table, all nodes with it.
SUMMED_UP = "in_real_time"


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
        launches = {run: (launch_file(name), *arguments)
                    for run, (name, *arguments) in launches.items()}
        for name, (duration, speed, *_) in MISTAKEN.items():
            scenario, observer = cls.mistaken_files(name)
            launches[name + "_mistaken"] = (
                os.path.join(ROOT, "launch", "example.launch"), "scenario:=" + " ".join(scenario),
                "observer:=" + " ".join(observer), "duration:=%d" % duration, "speed:=%d" % speed)
        launches[ROBOT] = (os.path.join(ROOT, "launch", "robot.launch"), "robot:=" + ROBOT,
                           "simulated:=true", "speed:=10")
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
    def mistaken_files(cls, name):
        """Files of the scenario, and of the observer beside them."""
        _, _, observer, period, mistakes = MISTAKEN[name]
        with open(os.path.join(EXAMPLES, name, "scenario.yaml"), encoding="utf-8") as original:
            scenario = original.read()
        if period is not None:
            scenario = re.sub("{period: [0-9.]+}", "{period: %g}" % period, scenario)
        for file, text in ("scenario.yaml", scenario), ("mistakes.yaml", mistakes):
            with open(cls.path(name + "_mistaken", file), "w", encoding="utf-8") as copy:
                copy.write(text)
        plant = os.path.join(EXAMPLES, name, "plant.yaml")
        return ([plant] * os.path.exists(plant) +
                [cls.path(name + "_mistaken", file) for file in ("scenario.yaml", "mistakes.yaml")],
                [os.path.join(EXAMPLES, name, file) for file in observer])

    @classmethod
    def launch(cls, run, file, *arguments):
        port = free_port()
        command = ["roslaunch", "--port", str(port), file,
                   "output:=" + cls.path(run, "live.bag"), "summary:=" + str(run == SUMMED_UP).lower(), *arguments]
        if run == SUMMED_UP:
            command = ["bash", "-c", 'exec "$@" >"$0" 2>&1', cls.path(run, "roslaunch.log"), *command]
        with RosProcess(command, port) as process:
            return process.wait(120)

    def check(self, name):
        self.launched[name].result()
        duration, _ = SPECIAL.get(name, USUAL)
        scenario = [path for path in (os.path.join(EXAMPLES, name, "plant.yaml"),
                                      os.path.join(EXAMPLES, name, "scenario.yaml"))
                    if os.path.exists(path)]
        self.compare(name, duration, scenario, [os.path.join(EXAMPLES, name, "observer.yaml"),
                                                os.path.join(EXAMPLES, name, "gains.yaml")])

    def compare(self, run, duration, scenario, observer):
        run_tool("simulate", *scenario, "-o", self.path(run, "simulated.bag"), "--duration",
                 str(duration))
        run_tool("replay", self.path(run, "simulated.bag"), *scenario, *observer, "-o",
                 self.path(run, "replayed.bag"))
        run_tool("compare_estimates", self.path(run, "live.bag"), self.path(run, "replayed.bag"),
                 "--at-least", str(AT_LEAST))

    def check_mistaken(self, name):
        import rosbag
        run = name + "_mistaken"
        self.launched[run].result()
        self.compare(run, MISTAKEN[name][0], *self.mistaken_files(name))
        missing = 0
        outcomes = set()
        with rosbag.Bag(self.path(run, "live.bag")) as bag:
            for topic, message, _ in bag.read_messages(["/estimate", "/events"]):
                if topic == "/estimate":
                    missing = message.missing_jumps
                else:
                    outcomes.add(message.outcome)
                    not_possible = message.NOT_POSSIBLE
        if GUARDED in MISTAKEN[name][2]:
            self.assertGreater(missing, 0)
            self.assertIn(not_possible, outcomes)
        with rosbag.Bag(self.path(run, "simulated.bag")) as bag:
            stamps = sorted(message.header.stamp.to_sec()
                            for _, message, _ in bag.read_messages(["jumps", "/jumps"]))
        self.assertLess(min(b - a for a, b in zip(stamps, stamps[1:])), 0.02)  # told twice

    def test_an_example_ends_by_itself_with_a_table(self):
        self.assertEqual(self.launched[SUMMED_UP].result(), 0)
        with open(self.path(SUMMED_UP, "roslaunch.log"), encoding="utf-8") as file:
            text = file.read()
        self.assertRegex(text, r"state +RMSE +largest +at the end")
        self.assertRegex(text, r"\nz1 +[0-9.]+ ")
        self.assertNotIn("died", text.replace("all processes on machine have died, roslaunch will exit", ""))

    def test_a_faulty_configuration_ends_the_launch(self):
        faulty = self.path("faulty", "observer.yaml")
        with open(faulty, "w", encoding="utf-8") as file:
            file.write("no_such_key: 1\n")
        port = free_port()
        command = ["roslaunch", "--port", str(port), os.path.join(ROOT, "launch", "robot.launch"), "robot:=" + ROBOT,
                   "simulated:=true", "speed:=10", "config:=" + faulty]
        with RosProcess(command, port) as process:
            process.wait(30)

    def test_a_robot_of_config_live_as_replayed(self):
        self.launched[ROBOT].result()
        self.compare(ROBOT, 60, [os.path.join(ROOT, "config", ROBOT + end)
                                 for end in (".yaml", "_scenario.yaml")], [])

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


def launch_file(name):
    return os.path.join(EXAMPLES, name, name + ".launch")


def example_names():
    names = sorted(os.listdir(EXAMPLES))
    assert len(names) >= 13, names
    return names


def add_tests():
    for name in example_names():
        setattr(LiveExamplesTest, "test_%s_live_as_replayed" % name,
                lambda self, name=name: self.check(name))
    for name in MISTAKEN:
        setattr(LiveExamplesTest, "test_%s_with_mistaken_jumps_live_as_replayed" % name,
                lambda self, name=name: self.check_mistaken(name))


add_tests()

if __name__ == "__main__":
    import rostest
    rostest.rosrun(PACKAGE, "live_examples_test", "live_examples_test", sys.argv)
