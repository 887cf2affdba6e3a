"""Two network namespaces as two hosts, with a bad network between them."""
import contextlib
import os
import subprocess

from relay import Relay, enter

ADDRESSES = ("10.213.0.1", "10.213.0.2")
MASTER = "http://%s:11311" % ADDRESSES[0]
DEVICE = "net0"


class NotPossible(Exception):
    """This machine, or this user, has no network namespaces."""


def run(*command):
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                            universal_newlines=True, check=False)
    if result.returncode != 0:
        raise OSError("%s: %s" % (" ".join(command), result.stdout.strip()))


class NetemLink:
    """Virtual ethernet, impaired by the kernel. The draws are the kernel's."""

    def __init__(self, namespaces, delay, jitter, loss):
        self.namespaces = namespaces
        self.usual = ["delay", "%dus" % (1e6 * (delay + jitter / 2)), "%dus" % (1e6 * jitter / 2),
                      "loss", "%g%%" % (100 * loss)]
        run("ip", "link", "add", DEVICE, "netns", namespaces[0], "type", "veth", "peer", "name",
            DEVICE, "netns", namespaces[1])
        try:
            self.set_down(False)
        except OSError:
            self.close()
            raise

    def set_down(self, is_down):
        for namespace in self.namespaces:
            run("ip", "netns", "exec", namespace, "tc", "qdisc", "replace", "dev", DEVICE, "root",
                "netem", *(["loss", "100%"] if is_down else self.usual))

    def close(self):
        run("ip", "netns", "exec", self.namespaces[0], "ip", "link", "delete", DEVICE)


class TwoHosts:
    """Use it in a with statement; NotPossible where there are no network namespaces.

    delay, jitter: seconds; loss: probability, of each packet. In `namespaces[i]` the address of
    this host is ADDRESSES[i].
    """

    def __init__(self, delay, jitter, loss, seed):
        self.namespaces = ["sdo_%d_%s" % (os.getpid(), name) for name in ("a", "b")]
        self.conditions = (delay, jitter, loss)
        self.seed = seed
        self.made = []
        self.link = None

    def __enter__(self):
        with contextlib.ExitStack() as undo:
            undo.callback(self.__exit__)
            try:
                for namespace in self.namespaces:
                    run("ip", "netns", "add", namespace)
                    self.made.append(namespace)
                self.link = self._connect()
            except OSError as fault:
                raise NotPossible(str(fault)) from fault
            for namespace, address in zip(self.namespaces, ADDRESSES):
                for command in (["addr", "add", address + "/24", "dev", DEVICE],
                                ["link", "set", DEVICE, "up"], ["link", "set", "lo", "up"]):
                    run("ip", "-n", namespace, *command)
            undo.pop_all()
        return self

    def __exit__(self, *_):
        if self.link:
            self.link.close()
        for namespace in self.made:
            run("ip", "netns", "delete", namespace)

    def _connect(self):
        try:
            link = NetemLink(self.namespaces, *self.conditions)
            print("the link is impaired by netem")
        except OSError as fault:
            print("the link is impaired by a relay (%s)" % fault)
            link = Relay(self.namespaces, DEVICE, *self.conditions, self.seed)
        return link

    def command(self, host, *command):
        """What runs a command on one of the hosts; the ROS master is on the first."""
        return ["ip", "netns", "exec", self.namespaces[host], "env", "-u", "ROS_HOSTNAME",
                "ROS_IP=" + ADDRESSES[host], "ROS_MASTER_URI=" + MASTER, *command]

    def enter(self, host):
        """Makes this process, with ROS' settings, one of that host."""
        enter(self.namespaces[host])
        os.environ.pop("ROS_HOSTNAME", None)
        os.environ.update(ROS_IP=ADDRESSES[host], ROS_MASTER_URI=MASTER)
