"""Replays bags that were damaged at random: each is replayed as a whole, or refused in plain words.

bag_attack.py SIMULATE REPLAY [NUMBER [SEED]] does so NUMBER times.
"""
import collections
import json
import os
import random
import resource
import subprocess
import sys
import tempfile

import rosbag

SCENARIO = """
plant: {states: [p, v], inputs: [u], A: [[0, 1], [0, 0]], B: [[0], [1]],
  jump_map: {A_d: [[1, 0], [0, -1]]}}
sensors:
  position: {C: [[1, 0]], source: {topic: position}}
  speed: {C: [[0, 1]], source: {topic: speed}}
input: {topic: input}
jumps: {topic: jumps}
scenario:
  duration: 2
  initial_state: {p: 1, v: 0}
  input: {rate: 10, formulas: {u: "sin(t)"}}
  jumps: {schedule: {period: 0.7}}
  sensors: {position: {schedule: {period: 0.1}}, speed: {schedule: {period: 0.15}}}
"""
OBSERVER = """
observer: ConstantGainObserver
rate: 10
sampling: {T1: 0.1, T2: 0.1}
gains: {L: {position: [[0.5], [0.5]], speed: [[0], [0.1]]}}
"""
NOT_PLAIN = ("std::", "boost::", "Buffer Overrun", "terminate", "what()")
LARGEST_PROCESS = 2 << 30  # bytes
LONGEST = 30  # s


def flip_a_bit(data, rng):
    data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)


def change_a_byte(data, rng):
    data[rng.randrange(len(data))] = rng.randrange(256)


def put_a_number(data, rng):
    at = rng.randrange(len(data) - 4)
    number = rng.choice([0, 1, 0x7fffffff, 0x80000000, 0xfffffff0, 0xffffffff, rng.getrandbits(32)])
    data[at:at + 4] = number.to_bytes(4, "little")


def change_a_count(data, rng):
    """Of chunks, connections, messages, or a place."""
    names = [b"chunk_count=", b"conn_count=", b"index_pos=", b"chunk_pos=", b"count=", b"conn=",
             b"size=", b"ver=", b"time=", b"op="]
    name = rng.choice(names)
    places = [at for at in range(len(data)) if data.startswith(name, at)]
    if places:
        at = rng.choice(places) + len(name)
        data[at] = rng.choice([(data[at] + 1) % 256, (data[at] - 1) % 256, rng.randrange(256)])


def cut_the_end(data, rng):
    del data[rng.randrange(len(data)):]


def cut_a_part(data, rng):
    at = rng.randrange(len(data))
    del data[at:at + rng.choice([1, 4, 100, 4096])]


def clear_a_part(data, rng):
    at = rng.randrange(len(data))
    data[at:at + 512] = bytes(len(data[at:at + 512]))


def repeat_a_part(data, rng):
    at = rng.randrange(len(data))
    data[at:at] = data[at:at + rng.choice([1, 4, 100, 4096])]


def add_to_the_end(data, rng):
    data += bytes(rng.randrange(256) for _ in range(rng.randrange(1, 100)))


def do_two(data, rng):
    for _ in range(2):
        if len(data) > 8:
            rng.choice([flip_a_bit, change_a_byte, put_a_number, change_a_count])(data, rng)


DAMAGES = [flip_a_bit, change_a_byte, put_a_number, change_a_count, cut_the_end, cut_a_part,
           clear_a_part, repeat_a_part, add_to_the_end, do_two]


class BagAttack:
    def __init__(self, simulate, replay, folder):
        self.replay_tool = replay
        self.folder = folder
        self.configs = [self.write("scenario.yaml", SCENARIO), self.write("observer.yaml", OBSERVER)]
        whole = os.path.join(folder, "whole.bag")
        subprocess.check_call([simulate, self.configs[0], "-o", whole], stdout=subprocess.DEVNULL)
        self.bags = {}
        for compression in ("none", "lz4", "bz2"):
            path = os.path.join(folder, compression + ".bag")
            # Of several chunks.
            with rosbag.Bag(path, "w", compression=compression, chunk_threshold=8192) as out, \
                    rosbag.Bag(whole) as bag:
                for topic, message, time in bag.read_messages(raw=True):
                    out.write(topic, message, time, raw=True)
            with open(path, "rb") as file:
                self.bags[compression] = file.read()
            status, text, summary = self.replay(path)
            assert status == 0, text
            self.expected = summary

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "w") as file:
            file.write(text)
        return path

    def replay(self, path):
        """Exit status, what was printed, and what was found in the bag."""
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (LARGEST_PROCESS, LARGEST_PROCESS))
        out = os.path.join(self.folder, "out.json")
        result = subprocess.run([self.replay_tool, path, *self.configs, "--truth", "truth",
                                 "--json", out], stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE, encoding="utf-8", errors="replace",
                                check=False, timeout=LONGEST, preexec_fn=limit)
        if not os.path.exists(out):
            return result.returncode, result.stderr, None
        with open(out) as file:
            json_text = json.load(file)
        os.remove(out)
        found = {"events": json_text["events_used"] + sum(json_text["rejected"].values()),
                 "not_recorded": json_text["not_recorded"]}
        return result.returncode, result.stderr, found

    def fault_of(self, data):
        """What is wrong with the replay of a damaged bag (None: nothing), and its exit status."""
        path = os.path.join(self.folder, "damaged.bag")
        with open(path, "wb") as file:
            file.write(data)
        try:
            status, text, found = self.replay(path)
        except subprocess.TimeoutExpired:
            return "no end after %d s" % LONGEST, None
        if status == 1:
            if path not in text or any(word in text for word in NOT_PLAIN):
                return "not in plain words: " + text, status
            return None, status
        # 2 and 3: values of messages were changed, and what they say is no fault of the bag.
        if status not in (0, 2, 3):
            return "exit status %d: %s" % (status, text), status
        if found != self.expected:
            return "replayed in part: %s instead of %s" % (found, self.expected), status
        return None, status

    def attack(self, number, seed):
        """Faults found, as text, and exit statuses by their number."""
        rng = random.Random(seed)
        statuses = collections.Counter()
        faults = []
        for i in range(number):
            compression = rng.choice(sorted(self.bags))
            damage = rng.choice(DAMAGES)
            data = bytearray(self.bags[compression])
            damage(data, rng)
            fault, status = self.fault_of(bytes(data))
            statuses[status] += 1
            if fault:
                kept = "/tmp/attack_bags_%d_%d.bag" % (seed, i)
                with open(kept, "wb") as file:
                    file.write(data)
                faults.append("%s of %s, kept as %s: %s" % (damage.__name__, compression, kept,
                                                            fault))
                print(faults[-1], flush=True)
        return faults, statuses


def main():
    number = int(sys.argv[3]) if len(sys.argv) > 3 else 2000
    seed = int(sys.argv[4]) if len(sys.argv) > 4 else 1
    with tempfile.TemporaryDirectory() as folder:
        faults, statuses = BagAttack(sys.argv[1], sys.argv[2], folder).attack(number, seed)
    print("%d damaged bags, exit statuses %s, %d faults" % (number, dict(statuses), len(faults)))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
