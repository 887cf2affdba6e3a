#!/usr/bin/env python3
"""A ROS master that is restarted under a running observer, and a nodelet manager that crashes."""
import os
import signal
import subprocess
import sys
import time
import unittest
import xmlrpc.client

HERE = os.path.dirname(os.path.realpath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "support"))
from ros_tools import RosProcess, find_tool, free_port  # noqa: E402

CALLER = "/restarts_test"


class RestartsTest(unittest.TestCase):
    def setUp(self):
        self.port = free_port()
        self.master = xmlrpc.client.ServerProxy("http://localhost:%d" % self.port)

    def eventually(self, ask, seconds=60):
        """What `ask` returns as soon as that is something."""
        end = time.time() + seconds
        while time.time() < end:
            try:
                answer = ask()
            except OSError:
                answer = None
            if answer:
                return answer
            time.sleep(0.1)
        raise AssertionError("nothing came in %d s" % seconds)

    def service(self, name):
        """Where a service is, as the master knows it."""
        code, _, uri = self.master.lookupService(CALLER, name)
        return uri if code == 1 else None

    def topics(self):
        publishers, subscribers, _ = self.master.getSystemState(CALLER)[2]
        return {name for name, _ in publishers}, {name for name, _ in subscribers}

    def run_tool(self, *command):
        environment = dict(os.environ, ROS_MASTER_URI="http://localhost:%d" % self.port)
        return subprocess.check_output(command, env=environment, timeout=60).decode()

    def require_estimates(self):
        self.run_tool("rosservice", "call", "/reset", "{}")
        self.assertIn("state", self.run_tool("rostopic", "echo", "-n", "1", "/estimate"))

    def core(self):
        return ["rosmaster", "--core", "-p", str(self.port)]

    def configure(self):
        """Sets the parameters of an observer as soon as there is a master."""
        with open(os.path.join(HERE, "position.yaml"), encoding="utf-8") as config:
            text = config.read()
        self.eventually(lambda: self.master.getPid(CALLER))
        self.master.setParam(CALLER, "/observer/config/file_1",
                             {"text": text, "path": "position.yaml"})

    def test_after_a_restart_of_the_master_the_observer_is_found_again(self):
        core = self.core()
        with RosProcess(core, self.port):
            self.configure()
            observer = RosProcess([find_tool("constant_gain_observer"), "__name:=observer"],
                                  self.port)
            self.addCleanup(observer.__exit__)
            self.eventually(lambda: self.service("/get_estimate"))
            self.eventually(lambda: {"/position", "/input", "/jumps"} <= self.topics()[1])
            before = self.topics()
        with RosProcess(core, self.port):
            self.eventually(lambda: self.master.getPid(CALLER))
            self.assertIsNone(self.service("/get_estimate"))
            self.eventually(lambda: self.service("/enable_sensor"))
            self.assertEqual(before, self.topics())
            # A sensor that comes afterwards reaches it, and its estimates reach others.
            sensor = RosProcess(["rostopic", "pub", "-r", "20", "-s", "/position",
                                 "sampled_data_observers/Measurement",
                                 "{header: auto, values: [1.0]}"], self.port)
            self.addCleanup(sensor.__exit__)
            self.assertIn("outcome: 0", self.run_tool("rostopic", "echo", "-n", "1", "/events"))
            self.require_estimates()

    def test_estimates_go_on_where_no_file_can_be_written(self):
        # What writes to the log or any file fails, as on a full disk, and ROS has no home.
        script = "ulimit -f 0; trap '' XFSZ; ROS_HOME=/proc/none exec %s __name:=observer"
        script = (script + " >/dev/full 2>&1") % find_tool("constant_gain_observer")
        with RosProcess(self.core(), self.port):
            self.configure()
            with RosProcess(["sh", "-c", script], self.port) as observer:
                self.eventually(lambda: self.service("/get_estimate"))
                self.require_estimates()
                bad = ["rostopic", "pub", "-1", "/position", "sampled_data_observers/Measurement",
                       "{values: [1.0]}"]
                self.run_tool(*bad)  # has no stamp: the log would say so
                self.require_estimates()
                self.assertIsNone(observer.poll())

    def test_a_manager_that_crashes_comes_back_with_the_observer(self):
        launch = ["roslaunch", "--port", str(self.port), os.path.join(HERE, "respawning.launch")]
        with RosProcess(launch, self.port):
            first = self.eventually(lambda: self.service("/get_estimate"))
            node = xmlrpc.client.ServerProxy(self.master.lookupNode(CALLER, "/manager")[2])
            os.kill(node.getPid(CALLER)[2], signal.SIGKILL)
            self.eventually(lambda: self.service("/get_estimate") not in (None, first))
            self.require_estimates()


if __name__ == "__main__":
    import rostest
    rostest.rosrun("sampled_data_observers", "restarts_test", RestartsTest)
