"""A bad network between two network namespaces: delay, jitter, reordering and loss of IP packets.

What netem does in the kernel, for kernels without it: a device (tun) in each namespace, and a
process that passes their packets on.
"""
import contextlib
import ctypes
import fcntl
import heapq
import multiprocessing
import os
import random
import select
import struct
import time

TUNSETIFF = 0x400454CA
IFF_TUN = 0x0001
IFF_NO_PI = 0x1000
CLONE_NEWNET = 0x40000000


def enter(namespace):
    """Moves this thread, and what it starts from now on, into a named network namespace."""
    libc = ctypes.CDLL(None, use_errno=True)
    with open("/run/netns/" + namespace, "rb") as handle:
        if libc.setns(handle.fileno(), CLONE_NEWNET) != 0:
            raise OSError(ctypes.get_errno(), "setns")


def open_tun(name):
    """A device of this thread's namespace, which exists until the descriptor is closed."""
    descriptor = os.open("/dev/net/tun", os.O_RDWR)
    fcntl.ioctl(descriptor, TUNSETIFF, struct.pack("16sH", name.encode(), IFF_TUN | IFF_NO_PI))
    return descriptor


class Relay:
    """Passes packets from each of two devices on to the other one.

    Each packet waits for `delay` and up to `jitter` seconds more, so that later ones overtake it,
    or is lost, with the probability `loss`; while the link is down all are. The draws are seeded.
    """

    def __init__(self, namespaces, device, delay, jitter, loss, seed):
        self.conditions = (delay, jitter, loss, seed)
        self.is_down = multiprocessing.Value("b", 0)
        ready = multiprocessing.Event()
        self.process = multiprocessing.Process(
            target=self._run, args=(namespaces, device, ready), daemon=True)
        self.process.start()
        if not ready.wait(20):
            raise OSError("the relay between the namespaces did not start")

    def set_down(self, is_down):
        self.is_down.value = is_down

    def close(self):
        self.process.terminate()
        self.process.join()

    def _run(self, namespaces, device, ready):
        ends = []
        for namespace in namespaces:
            enter(namespace)
            ends.append(open_tun(device))
        ready.set()
        delay, jitter, loss, seed = self.conditions
        draws = random.Random(seed)
        other = {ends[0]: ends[1], ends[1]: ends[0]}
        waiting = []
        arrived = 0
        while True:
            timeout = max(0.0, waiting[0][0] - time.monotonic()) if waiting else None
            for end in select.select(ends, [], [], timeout)[0]:
                packet = os.read(end, 65536)
                due = time.monotonic() + delay + jitter * draws.random()
                if draws.random() >= loss and not self.is_down.value:
                    arrived += 1
                    heapq.heappush(waiting, (due, arrived, other[end], packet))
            while waiting and waiting[0][0] <= time.monotonic():
                _, _, end, packet = heapq.heappop(waiting)
                with contextlib.suppress(OSError):  # as long as that device is not up
                    os.write(end, packet)
