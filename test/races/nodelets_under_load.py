#!/usr/bin/env python3
"""An observer under the thread sanitizer and under load: no report may concern the package.

Usage: nodelets_under_load.py BUILD, in the environment of the package built there with the thread
sanitizer. What concerns the package: sanitizer_reports.Judge.
"""
import contextlib
import itertools
import os
import random
import shutil
import sys
import threading
import time
import xmlrpc.client

HERE = os.path.dirname(os.path.realpath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "support"))
from ros_tools import RosProcess, end_rospy_node, find_tool, free_port  # noqa: E402
from sanitizer_reports import Judge, reports  # noqa: E402

ROOT = os.path.realpath(os.path.join(HERE, "..", ".."))
SECONDS = 20.0


class Load:
    """Publishers and service clients, each on a thread of its own."""

    def __init__(self):
        import rospy
        self.rospy = rospy
        self.stopping = threading.Event()
        self.lock = threading.Lock()
        self.counts = {}
        self.threads = []

    def count(self, what):
        with self.lock:
            self.counts[what] = self.counts.get(what, 0) + 1

    def every(self, period, action):
        thread = threading.Thread(target=self.run, args=(period, action), daemon=True)
        self.threads.append(thread)
        thread.start()

    def run(self, period, action):
        while not self.stopping.wait(period):
            action()

    def stop(self):
        self.stopping.set()
        for thread in self.threads:
            thread.join(30)
            if thread.is_alive():
                raise SystemExit("a service was not answered in 30 s: is there a deadlock?")

    def listen(self, topic, message_type):
        self.rospy.Subscriber(topic, message_type, lambda _: self.count(topic))

    def publish(self, topic, message_type, period, fill):
        publisher = self.rospy.Publisher(topic, message_type, queue_size=100)

        def act():
            message = fill()
            message.header.stamp = self.rospy.Time.now() - self.rospy.Duration(lateness())
            publisher.publish(message)
            self.count(topic)
        self.every(period, act)

    def call(self, name, service_type, period, arguments):
        """Calls a service, by turns with each of `arguments`."""
        proxy = self.rospy.ServiceProxy(name, service_type)
        turns = itertools.cycle(arguments)

        def act():
            try:
                proxy(*next(turns))
                self.count(name)
            except self.rospy.ServiceException:  # while the master is not there
                self.count(name + " (not reached)")
        self.every(period, act)


def lateness():
    """Seconds: mostly little; now and then a lot, beyond the history, or negative."""
    return random.choice([0.0, 0.0, 0.0, 0.002, 0.02, 0.3, 3.0, -2.0])


def start_load():
    from geometry_msgs.msg import PointStamped, TransformStamped, Vector3Stamped
    from nav_msgs.msg import Odometry
    from sampled_data_observers.msg import EventStatus, Input, Measurement, StateEstimate
    from sampled_data_observers.srv import EnableSensor, GetEstimate, ReloadGains, Reset
    from diagnostic_msgs.msg import DiagnosticArray
    from std_srvs.srv import SetBool
    from tf2_msgs.msg import TFMessage
    import rospy

    load = Load()
    for topic, message_type in (("estimate", StateEstimate), ("events", EventStatus),
                                ("odometry", Odometry), ("/diagnostics", DiagnosticArray)):
        load.listen(topic, message_type)

    value = random.random
    bad = [[float("nan")], [], [1.0, 2.0]]
    for _ in range(2):
        load.publish("position", Measurement, 0.004, lambda: Measurement(
            values=[value()] if value() < 0.95 else random.choice(bad)))
    load.publish("input", Input, 0.01, lambda: Input(values=[value()]))
    load.publish("acceleration", Vector3Stamped, 0.01, acceleration)
    load.publish("camera", PointStamped, 0.02, point)

    transforms = rospy.Publisher("/tf", TFMessage, queue_size=100)

    def move():
        sent = []
        for parent, child in (("map", "lens"), ("odom", "base")):
            transform = TransformStamped()
            transform.header.stamp = rospy.Time.now()
            transform.header.frame_id = parent
            transform.child_frame_id = child
            transform.transform.rotation.w = 1.0
            sent.append(transform)
        transforms.publish(sent)
        load.count("/tf")
    load.every(0.02, move)

    for _ in range(2):
        load.call("get_estimate", GetEstimate, 0.01, [(rospy.Time(0),)])
    load.call("reset", Reset, 0.3, [([], False), ([0.5, 0.0], False), ([], True), ([1.0], False)])
    load.call("reload_gains", ReloadGains, 0.2,
              [("smaller.yaml",), ("wrong_size.yaml",), ("../observer.yaml",)])
    load.call("set_enabled", SetBool, 0.5, [(False,), (True,), (True,), (True,)])
    load.call("enable_sensor", EnableSensor, 0.1, [("camera", False), ("camera", True)])
    return load


def acceleration():
    from geometry_msgs.msg import Vector3Stamped
    message = Vector3Stamped()
    message.vector.x = random.choice([0.0, 0.0, 0.0, 20.0])
    return message


def point():
    from geometry_msgs.msg import PointStamped
    message = PointStamped()
    message.header.frame_id = random.choice(["lens", "lens", "lens", "nowhere"])
    message.point.x = random.choice([0.5, 0.5, 1000.0])
    return message


def configure(master):
    with open(os.path.join(HERE, "observer.yaml"), encoding="utf-8") as config:
        text = config.read()
    master.setParam("/load", "/observer/config/file_1", {"text": text, "path": "observer.yaml"})
    master.setParam("/load", "/observer/gains_directory", os.path.join(HERE, "gains"))


def eventually(ask, seconds=120):
    end = time.time() + seconds
    while time.time() < end:
        try:
            if ask():
                return
        except OSError:
            pass
        time.sleep(0.1)
    raise SystemExit("the observer, or its master, did not start in %d s" % seconds)


def run_under_load(port):
    """Halfway through, the ROS master is restarted: the observer registers with it again."""
    import rospy
    master = xmlrpc.client.ServerProxy("http://localhost:%d" % port)
    core = ["rosmaster", "--core", "-p", str(port)]
    with contextlib.ExitStack() as running:
        with RosProcess(core, port):
            eventually(lambda: master.getPid("/load")[0] == 1)
            configure(master)
            observer = running.enter_context(
                RosProcess([find_tool("constant_gain_observer"), "__name:=observer"], port))
            eventually(lambda: master.lookupService("/load", "/get_estimate")[0] == 1)
            rospy.init_node("load", disable_signals=True)
            load = start_load()
            running.callback(load.stop)
            time.sleep(SECONDS / 2)
        with RosProcess(core, port):
            time.sleep(SECONDS / 2)
            if observer.poll() is not None:
                raise SystemExit("the observer ended with status %s" % observer.returncode)
            load.stop()
            running.close()
            end_rospy_node()
    return load.counts


def main():
    build = os.path.realpath(sys.argv[1])
    port = free_port()
    os.environ["ROS_MASTER_URI"] = "http://localhost:%d" % port
    random.seed(1)
    folder = os.path.join(build, "races")
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    log = os.path.join(folder, "report")
    os.environ["TSAN_OPTIONS"] = "log_path=%s halt_on_error=0 exitcode=0" % log
    counts = run_under_load(port)
    found = reports(log)
    for what in sorted(counts):
        print("%6d  %s" % (counts[what], what))
    if not counts.get("estimate"):
        raise SystemExit("there were no estimates: nothing was checked")
    judge = Judge(ROOT, build)
    own = [report for report in found if judge.concerns_package(report)]
    for report in own:
        print(report)
    print("reports of the thread sanitizer: %d; with a file of the package in any stack: %d; "
          "that concern it: %d" % (len(found), sum(map(judge.names_package, found)), len(own)))
    sys.exit(1 if own else 0)


if __name__ == "__main__":
    main()
