#!/usr/bin/env python3
"""Damaged bags are refused in plain words, and never replayed in part:
damaged_bags_test.py SIMULATE REPLAY"""
import os
import shutil
import struct
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
from bag_attack import BagAttack  # noqa: E402

TOOLS = []


class DamagedBagsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.attack = BagAttack(*TOOLS, cls.folder)
        cls.bag = cls.attack.bags["none"]

    def refuse(self, data, expected):
        path = os.path.join(self.folder, "damaged.bag")
        with open(path, "wb") as file:
            file.write(data)
        self.refuse_path(path, expected)

    def refuse_path(self, path, expected):
        status, text, _ = self.attack.replay(path)
        self.assertEqual(status, 1, text)
        self.assertTrue(text.startswith("replay: " + path + ": "), text)
        self.assertIn(expected, text)
        self.assertEqual(text.count("\n"), 1, text)

    def changed(self, field, number, size=4, last=False):
        """With another number in the first header, or the last, that has the field."""
        at = (self.bag.rindex if last else self.bag.index)(field) + len(field)
        return self.bag[:at] + number.to_bytes(size, "little") + self.bag[at + size:]

    def number(self, field):
        at = self.bag.index(field) + len(field)
        return int.from_bytes(self.bag[at:at + 4], "little")

    def test_files_that_are_no_bags(self):
        self.refuse(b"", "it is empty")
        self.refuse(b"plant: {states: [x]}\n", "it does not begin with '#ROSBAG V2.0'")
        self.refuse(self.bag[:9], "it does not begin with '#ROSBAG V2.0'")
        self.refuse_path(self.folder, "Is a directory")
        self.refuse_path(os.path.join(self.folder, "none"), "No such file or directory")

    def test_bags_that_were_cut_off(self):
        self.refuse(self.bag[:20], "and there are only")
        self.refuse(self.bag[:len(self.bag) // 2], "it was cut off: its index begins at byte")
        self.refuse(self.bag[:-1], "a record needs")
        self.refuse(self.changed(b"index_pos=", 0, size=8), "it has no index")

    def test_a_bag_whose_index_promises_less_is_not_replayed_in_part(self):
        chunks = self.number(b"chunk_count=")
        self.assertGreater(chunks, 1)
        for count in (chunks - 1, 0):
            self.refuse(self.changed(b"chunk_count=", count),
                        "its header promises %d chunks, and there are %d" % (count, chunks))
        self.refuse(self.changed(b"conn_count=", self.number(b"conn_count=") - 1),
                    "its header promises")
        self.refuse(self.bag + b"more", "bytes more")
        # A chunk's own index, which lists one message less.
        at = self.bag.index(b"\x0a\x00\x00\x00count=") + 10
        count = int.from_bytes(self.bag[at:at + 4], "little")
        self.assertGreater(count, 0)
        self.refuse(self.bag[:at] + (count - 1).to_bytes(4, "little") + self.bag[at + 4:],
                    "is not one of %d messages" % (count - 1))

    def test_a_topic_that_the_index_renames_is_not_one_that_is_missing(self):
        at = self.bag.rindex(b"topic=/jumps")
        self.refuse(self.bag[:at] + b"topic=/bumps" + self.bag[at + 12:],
                    "do not agree on the topic or type of connection")

    def test_a_message_that_claims_more_than_it_has_takes_no_memory(self):
        # A StateEstimate's numbers: the length of a list of two, before the numbers 1 and 0.
        state = struct.pack("<Idd", 2, 1.0, 0.0)
        at = self.bag.index(state)
        for length in (0x10000000, 0xffffffff):
            self.refuse(self.bag[:at] + struct.pack("<I", length) + self.bag[at + 4:],
                        "the message on /truth received at 1000.000000 s: its field state claims "
                        "%d entries" % length)

    def test_random_damage(self):
        faults, statuses = self.attack.attack(60, seed=7)
        self.assertEqual(faults, [])
        self.assertGreater(statuses[1], 30)


if __name__ == "__main__":
    TOOLS = [sys.argv.pop(1), sys.argv.pop(1)]
    unittest.main()
