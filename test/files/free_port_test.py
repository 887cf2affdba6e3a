#!/usr/bin/env python3
"""scripts/free_port gives none of the ports that connections take by themselves."""
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "support"))
from ros_tools import free_port  # noqa: E402


class FreePortTest(unittest.TestCase):
    def test_no_connection_is_given_it(self):
        with open("/proc/sys/net/ipv4/ip_local_port_range", encoding="ascii") as given:
            first, last = map(int, given.read().split())
        for _ in range(20):
            port = free_port()
            self.assertFalse(first <= port <= last, port)


if __name__ == "__main__":
    unittest.main()
