#!/usr/bin/env python3
"""An observer on one host and its sensors on another, over a network that delays and loses.

Two sensors, with a connection each, take samples by turns; the link is down for a while; at last
one of them dies. The exit status is 77 where there are no network namespaces.
"""
import contextlib
import itertools
import math
import os
import sys
import time
import unittest

HERE = os.path.dirname(os.path.realpath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "support"))
import oscillation  # noqa: E402
from ros_tools import RosProcess, end_rospy_node, find_tool  # noqa: E402
from two_hosts import NotPossible, TwoHosts  # noqa: E402

ROOT = os.path.realpath(os.path.join(HERE, "..", ".."))
CONFIG = [os.path.join(ROOT, "config", "examples", "ferrante2019_oscillator", "plant.yaml"),
          os.path.join(ROOT, "test", "certificate", "ferrante2019_oscillator_0.2.yaml"),
          os.path.join(HERE, "observer.yaml")]
OBSERVER_HOST, SENSOR_HOST = 0, 1
SKIPPED = 77

DELAY, JITTER, LOSS = 0.02, 0.03, 0.03  # s, s, probability
GOOD_TIME, DOWN_TIME = 6.0, 3.0  # s
PERIOD = 20000000  # ns, of the estimates
T1, T2 = 0.1, 0.2  # s, of the gains


class Recorder:
    """What the observer publishes, with the time of its receipt [s]."""

    def __init__(self):
        import rospy
        from diagnostic_msgs.msg import DiagnosticArray
        from sampled_data_observers.msg import EventStatus, StateEstimate
        self.estimates = []
        self.events = []
        self.diagnostics = []
        for topic, message_type, record in (("estimate", StateEstimate, self.estimates),
                                            ("events", EventStatus, self.events),
                                            ("/diagnostics", DiagnosticArray, self.diagnostics)):
            rospy.Subscriber(topic, message_type, self.keep, record, tcp_nodelay=True)

    @staticmethod
    def keep(message, record):
        record.append((time.time(), message))

    def diagnosis(self, name):
        """The statuses of that name, in their order."""
        return [status for _, array in self.diagnostics for status in array.status
                if status.name.endswith(": " + name)]


def nanoseconds(message):
    return message.header.stamp.to_nsec()


def eventually(ask, seconds=60):
    end = time.time() + seconds
    while not ask():
        if time.time() > end:
            raise AssertionError("nothing came in %d s" % seconds)
        time.sleep(0.02)


class Story:
    """All that happens, and when [s]."""

    def __init__(self, hosts):
        self.hosts = hosts

    def run(self):
        import rospy
        with contextlib.ExitStack() as running:
            def launch(host, *command):
                own_master = 0  # overruled by the command, which knows where the master is
                return running.enter_context(
                    RosProcess(self.hosts.command(host, *command), own_master))
            launch(OBSERVER_HOST, "rosmaster", "--core", "-p", "11311")
            eventually(self.configure)
            rospy.init_node("multi_host_test", disable_signals=True)
            self.recorder = Recorder()
            launch(OBSERVER_HOST, find_tool("intersample_injection_observer"), "__name:=observer")
            rospy.wait_for_service("get_estimate", 60)
            sensors = [launch(SENSOR_HOST, os.path.join(HERE, "sensor.py"), str(i)) for i in (0, 1)]
            eventually(lambda: all(rospy.has_param("/sensor_%d/is_ready" % i) for i in (0, 1)))
            self.start = int((time.time() + 3.0) * 1e9)
            times = itertools.islice(oscillation.samples(), 10000)
            self.sensor_of = {self.start + taken: k % 2 for k, (taken, _) in enumerate(times)}
            rospy.set_param("/start", str(self.start))
            eventually(lambda: self.arrived(0) and self.arrived(1))

            time.sleep(GOOD_TIME)
            self.hosts.link.set_down(True)
            self.down = time.time()
            time.sleep(DOWN_TIME)
            self.up = time.time()
            self.hosts.link.set_down(False)
            eventually(lambda: min(self.arrived(0), self.arrived(1)) > 1e9 * (self.up + 1.5))
            self.complete = min(self.arrived(0), self.arrived(1))
            eventually(lambda: "restored" in self.recorder.diagnosis("certificate")[-1].message)

            sensors[1].kill()
            self.died = time.time()
            eventually(lambda: self.arrived(0) > 1e9 * (self.died + 2.5))
            sensors[0].kill()
            time.sleep(2.5)  # for the last report of the diagnostics
            self.asked = self.ask_for_the_past()
            end_rospy_node()

    def configure(self):
        """Whether the master was there to take the parameters."""
        import rosgraph
        master = rosgraph.Master("/multi_host_test")
        try:
            for i, path in enumerate(CONFIG):
                with open(path, encoding="utf-8") as config:
                    master.setParam("/observer/config/file_%d" % i,
                                    {"text": config.read(), "path": path})
        except OSError:
            return False
        return True

    def arrived(self, sensor):
        """The stamp of the newest sample of that sensor that the observer knows."""
        stamps = [nanoseconds(event) for _, event in self.recorder.events]
        return max([stamp for stamp in stamps if self.sensor_of[stamp] == sensor], default=0)

    def ask_for_the_past(self):
        """The estimates on the grid between the first sample and the death of a sensor."""
        import genpy
        import rospy
        from sampled_data_observers.srv import GetEstimate
        ask = rospy.ServiceProxy("get_estimate", GetEstimate, persistent=True)
        first = nanoseconds(self.recorder.estimates[0][1])
        return [ask(genpy.Time(nsecs=stamp)).estimate
                for stamp in range(first, self.complete, PERIOD)]


class MultiHostTest(unittest.TestCase):
    story = None

    def setUp(self):
        self.estimates = self.story.recorder.estimates
        self.events = [event for _, event in self.story.recorder.events]

    def error(self, estimate):
        true_state = oscillation.truth(1e-9 * (nanoseconds(estimate) - self.story.start))
        return math.dist(true_state, estimate.state)

    def test_estimates_go_on_at_their_rate(self):
        stamps = [nanoseconds(estimate) for _, estimate in self.estimates]
        self.assertEqual(list(range(stamps[0], stamps[-1] + 1, PERIOD)), stamps)
        meanwhile = [received for received, _ in self.estimates
                     if self.story.down < received < self.story.up]
        self.assertGreater(len(meanwhile), 1e9 / PERIOD * DOWN_TIME / 2)

    def test_the_error_is_within_its_bound(self):
        bounded = [estimate for _, estimate in self.estimates
                   if math.isfinite(estimate.error_bound)]
        self.assertGreater(len(bounded), 100)
        for estimate in bounded:
            self.assertLessEqual(self.error(estimate), estimate.error_bound)
        # While the link was down the error could only be guaranteed to grow with the plant's flow.
        meanwhile = [estimate.error_bound for received, estimate in self.estimates
                     if self.story.down < received < self.story.up]
        before = [estimate.error_bound for received, estimate in self.estimates
                  if received < self.story.down]
        self.assertGreater(max(meanwhile), max(before[len(before) // 2:]))

    def test_the_bound_is_mended_by_what_came_late(self):
        self.assertGreater(len(self.story.asked), 1e9 / PERIOD * (GOOD_TIME + DOWN_TIME))
        for estimate in self.story.asked:
            self.assertTrue(math.isfinite(estimate.error_bound), estimate.header.stamp)
            self.assertLessEqual(self.error(estimate), estimate.error_bound)

    def test_every_sample_is_used_once(self):
        sent = set()
        for taken, _ in oscillation.samples():
            if self.story.start + taken > self.story.complete:
                break
            sent.add(self.story.start + taken)
        used = [nanoseconds(event) for event in self.events
                if event.outcome in (event.USED, event.USED_LATE)]
        self.assertEqual(len(used), len(set(used)))
        # Where the second sample was the first to come, the observer began with it.
        self.assertLessEqual(sent - set(used), {self.story.start})

    def test_intervals_and_rewinds_are_reported_as_they_are(self):
        known = []
        rewound = []
        for event in self.events:
            stamp = nanoseconds(event)
            before = [other for other in known if other < stamp]
            if event.outcome not in (event.USED, event.USED_LATE):
                continue
            interval = 1e-9 * (stamp - max(before)) if before else math.nan
            self.assertEqual(str(round(interval, 9)), str(round(event.interval, 9)))
            check = (event.INTERVAL_NONE if not before else
                     event.INTERVAL_SHORT if interval < T1 else
                     event.INTERVAL_LONG if interval > T2 else event.INTERVAL_WITHIN)
            self.assertEqual(check, event.interval_check)
            self.assertEqual(len(known) - len(before), event.rewound)
            self.assertEqual(event.USED_LATE if event.rewound else event.USED, event.outcome)
            rewound.append(event.rewound)
            known.append(stamp)
        self.assertGreater(max(rewound), 3)

    def test_the_latency_is_that_of_the_network(self):
        tolerance = 0.001
        for received, event in self.story.recorder.events:
            stamp = 1e-9 * nanoseconds(event)
            self.assertGreater(event.latency, DELAY - tolerance)
            self.assertLess(event.latency, received - stamp + tolerance)
            if self.story.down < stamp < self.story.up:
                self.assertGreater(event.latency, self.story.up - stamp)

    def test_the_diagnostics_tell_the_truth(self):
        report = self.story.recorder.diagnosis("events from position")[-1]
        values = {pair.key: pair.value for pair in report.values}
        used = [event for event in self.events if event.outcome in (event.USED, event.USED_LATE)]
        self.assertEqual(str(len(self.events)), values["received in all"])
        self.assertEqual(str(len(used)), values["used in all"])
        for code, key in ((2, "below T1 in all"), (3, "above T2 in all")):
            self.assertEqual(str(sum(event.interval_check == code for event in used)),
                             values[key])
        history = [status.message.split()[0].rstrip(":")
                   for status in self.story.recorder.diagnosis("certificate")]
        # Bounds recover with the samples: how it ends depends on when the last ones came.
        self.assertIn("suspended", history)
        self.assertIn("restored", history[history.index("suspended"):])


def main():
    try:
        with TwoHosts(DELAY, JITTER, LOSS, seed=1) as hosts:
            hosts.enter(OBSERVER_HOST)
            MultiHostTest.story = Story(hosts)
            MultiHostTest.story.run()
    except NotPossible as fault:
        print("SKIPPED: no network namespaces here (%s)" % fault)
        sys.exit(SKIPPED)
    unittest.main()


if __name__ == "__main__":
    main()
