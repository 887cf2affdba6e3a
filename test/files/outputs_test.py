#!/usr/bin/env python3
"""What the tools write is whole or not there, and overwrites nothing that is read:
outputs_test.py SIMULATE REPLAY DESIGN"""
import json
import os
import resource
import signal
import stat
import subprocess
import sys
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "support"))
from folder_test import FolderTest  # noqa: E402

LONG_TESTS = "SDO_LONG_TESTS" in os.environ  # as scripts/test --all runs them
TOOLS = {}
WRONG_USAGE = 105

PLANT = """
plant: {states: [p, v], A: [[0, 1], [-4, 0]]}
sensors: {position: {C: [[1, 0]], source: {topic: position}}}
design: {sampling: {T1: 0.1, T2: 0.3}, parameters: {lambda_t: 0.05, delta: 3}}
scenario:
  duration: 30
  initial_state: {p: 1, v: 0}
  sensors: {position: {schedule: {period: 0.1}}}
"""
OBSERVER = """
observer: ConstantGainObserver
rate: 50
sampling: {T1: 0.1, T2: 0.1}
gains: {L: [[0.5], [0.5]]}
"""


class OutputsTest(FolderTest):
    def setUp(self):
        super().setUp()
        self.plant = self.write("plant.yaml", PLANT)
        self.observer = self.write("observer.yaml", OBSERVER)

    def run_tool(self, command, status=0, largest=None, stdout=subprocess.PIPE):
        """Where files may have `largest` bytes, as if the disk were full then."""
        def limit():
            if largest is not None:
                resource.setrlimit(resource.RLIMIT_FSIZE, (largest, largest))
        result = subprocess.run([TOOLS[command[0]], *command[1:]], stdout=stdout,
                                stderr=subprocess.STDOUT if stdout is subprocess.PIPE
                                else subprocess.PIPE, encoding="utf-8", errors="replace",
                                check=False, timeout=120, preexec_fn=limit)
        text = (result.stdout or "") + (result.stderr or "")
        self.assertEqual(result.returncode, status, text)
        self.assertNotIn("Traceback", text)
        return text

    def simulate(self):
        self.run_tool(["simulate", self.plant, "-o", self.path("run.bag")])

    def replay(self, *options):
        return ["replay", self.path("run.bag"), self.plant, self.observer, "--truth", "truth",
                *options]

    def synthesize(self, *options):
        """A method of which the proof is the one for the run time, too: no second one has to be found."""
        return ["design", "synthesize", self.plant, "--method", "timer_dependent_constant_gain",
                "--objective", "feasible", *options]

    def read(self, name):
        with open(self.path(name)) as file:
            return file.read()

    def outputs(self):
        """Each option that names an output: its name, what it is called, and a size too small."""
        gains = self.path("gains.yaml")
        self.run_tool(self.synthesize("-o", gains))
        pictures = ["out.png", "out.svg", "out.pdf"] if LONG_TESTS else ["out.png"]
        return [
            (["simulate", self.plant, "-o"], "out.bag", 8192),
            (self.replay("-o"), "out.bag", 8192),
            (self.replay("--json"), "out.json", 512),
            (self.replay("--report"), "out.html", 4096),
            *((self.replay("--plot"), picture, 4096) for picture in pictures),
            (self.synthesize("-o"), "out.yaml", 512),
            (["design", "analyze", gains, "--objective", "feasible", "-o"], "out.yaml", 512),
            (["design", "explain", self.plant, "--plot"], "out.png", 4096),
        ]

    def test_a_full_disk_leaves_nothing_and_what_was_there_stays(self):
        self.simulate()
        for command, name, largest in self.outputs():
            before = sorted(os.listdir(self.folder))
            text = self.run_tool([*command, self.path(name)], status=1, largest=largest)
            self.assertIn(self.path(name) + ": can't be written: File too large", text)
            self.assertEqual(sorted(os.listdir(self.folder)), before)
            self.write(name, "of yesterday")
            self.run_tool([*command, self.path(name)], status=1, largest=largest)
            self.assertEqual(self.read(name), "of yesterday")
            os.remove(self.path(name))
            # And a real one.
            os.symlink("/dev/full", self.path(name))
            text = self.run_tool([*command, self.path(name)], status=1)
            self.assertIn(self.path(name) + ": can't be written: No space left on device", text)
            os.remove(self.path(name))

    def test_what_is_complete_replaces_what_was_there_also_behind_a_link(self):
        self.simulate()
        for command, name, _ in self.outputs():
            self.write("real_" + name, "of yesterday")
            os.chmod(self.path("real_" + name), 0o640)
            os.symlink("real_" + name, self.path(name))
            self.run_tool([*command, self.path(name)])
            self.assertTrue(os.path.islink(self.path(name)))
            with open(self.path("real_" + name), "rb") as file:
                self.assertNotEqual(file.read(), b"of yesterday")
            self.assertEqual(stat.S_IMODE(os.stat(self.path("real_" + name)).st_mode), 0o640)
            os.remove(self.path(name))
            self.assertFalse([found for found in os.listdir(self.folder) if "unfinished" in found])

    def test_devices_and_pipes_are_written_as_they_are(self):
        self.simulate()
        self.run_tool(["simulate", self.plant, "-o", "/dev/null"])
        self.run_tool(self.replay("-o", "/dev/null", "--json", "/dev/null"))
        self.run_tool(self.synthesize("-o", "/dev/null"))
        self.assertIn('"samples_used"', self.run_tool(self.replay("--json", "/dev/stdout")))
        self.assertTrue(stat.S_ISCHR(os.stat("/dev/null").st_mode))

    def test_what_can_not_be_printed_is_a_fault(self):
        self.simulate()
        with open("/dev/full", "w") as full:
            for command in (self.replay(), ["design", "explain", self.plant]):
                self.assertIn("standard output: can't be written: No space left on device",
                              self.run_tool(command, status=1, stdout=full))

    def test_what_can_not_be_written_at_all_is_told_of_in_one_line(self):
        os.mkdir(self.path("folder.bag"))
        for name, cause in (("missing/out.bag", "No such file or directory"),
                            ("folder.bag", "Is a directory")):
            text = self.run_tool(["simulate", self.plant, "-o", self.path(name)], status=1)
            self.assertEqual(text, "simulate: %s: can't be written: %s\n" % (self.path(name), cause))

    def test_ctrl_c_leaves_nothing(self):
        self.write("long.yaml", PLANT.replace("duration: 30", "duration: 1000000"))
        before = sorted(os.listdir(self.folder))
        process = subprocess.Popen(
            [TOOLS["simulate"], self.path("long.yaml"), "-o", self.path("out.bag")],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        deadline = time.time() + 30
        while sorted(os.listdir(self.folder)) == before and time.time() < deadline:
            time.sleep(0.01)
        self.assertNotIn("out.bag", os.listdir(self.folder))
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(30), -signal.SIGINT)
        self.assertEqual(sorted(os.listdir(self.folder)), before)

    def refuse(self, command, *names):
        before = {name: os.lstat(self.path(name)).st_mtime_ns for name in os.listdir(self.folder)}
        text = self.run_tool(command, status=WRONG_USAGE)
        for name in names:
            self.assertIn(name, text)
        self.assertIn("is the same file as", text)
        self.assertEqual(
            before, {name: os.lstat(self.path(name)).st_mtime_ns
                     for name in os.listdir(self.folder)})

    def test_no_output_overwrites_an_input(self):
        self.simulate()
        self.run_tool(self.synthesize("-o", self.path("gains.yaml")))
        os.symlink("run.bag", self.path("link.png"))
        os.link(self.observer, self.path("hard.json"))
        os.symlink(self.folder, self.path("here"))
        self.refuse(["simulate", self.plant, "-o", self.plant], "--output", "SCENARIO")
        self.refuse(self.replay("-o", self.path("here/run.bag")), "--output", "here", "BAG")
        self.refuse(self.replay("--json", self.observer), "--json", "CONFIG")
        self.refuse(self.replay("--json", self.path("hard.json")), "hard.json", "observer.yaml")
        self.refuse(self.replay("--plot", self.path("link.png")), "link.png", "run.bag")
        self.refuse(self.synthesize("-o", self.plant), "--output", "PLANT")
        gains = self.path("gains.yaml")
        self.refuse(["design", "analyze", gains, "-o", gains], "GAINS")
        # The plant's file is one that the gain file names.
        self.refuse(["design", "analyze", gains, "-o", self.plant], "PLANT")
        os.symlink("plant.yaml", self.path("plant.svg"))
        self.refuse(["design", "explain", self.plant, "--plot", self.path("plant.svg")], "--plot")
        os.mkdir(self.path("out"))
        os.rename(self.plant, self.path("out/points.csv"))
        self.refuse(["design", "sweep", self.path("out/points.csv"), "-o", self.path("out"),
                     "--method", "ferrante2019_proposition2", "--objective", "max-decay"],
                    "--output", "PLANT")

    def test_no_output_overwrites_another(self):
        self.simulate()
        os.symlink("later.png", self.path("link.bag"))  # leads to nothing yet
        os.symlink(self.folder, self.path("here"))
        self.refuse(self.replay("-o", self.path("link.bag"), "--plot", self.path("later.png")),
                    "--plot", "--output")
        self.refuse(self.replay("-o", self.path("x"), "--json", self.path("here/x")),
                    "--json", "--output")

    def test_design_replaces_the_gain_file_that_it_wrote(self):
        for _ in range(2):
            self.run_tool(self.synthesize("-o", self.path("gains.yaml")))

    def test_names_that_yaml_has_to_escape_are_read_as_they_were(self):
        for name in ('say "hello".yaml', "back\\slash.yaml", "two\nlines: x.yaml", "tab\t.yaml",
                     "it's.yaml", "größe.yaml", "#{[.yaml", "\u2028\x7f.yaml"):
            self.plant = self.write(name, PLANT)
            self.run_tool(self.synthesize("-o", self.path("gains.yaml")))
            self.assertIn("holds", self.run_tool(["design", "verify", self.path("gains.yaml")]))
        self.plant = os.path.join(os.fsencode(self.folder), b"latin\xe9.yaml")
        with open(self.plant, "w") as file:
            file.write(PLANT)
        text = self.run_tool(self.synthesize("-o", self.path("latin.yaml")), status=WRONG_USAGE)
        self.assertIn("PLANT: expected a text in UTF-8, found other bytes", text)
        self.simulate()
        self.run_tool(self.replay("--json", self.path("out.json")))
        bag = os.path.join(os.fsencode(self.folder), b"latin\xe9.bag")
        os.rename(self.path("run.bag"), bag)
        self.run_tool(["replay", bag, self.plant, self.observer, "--json", self.path("out.json"),
                       "--plot", self.path("$x.png")])
        self.assertIn("latin\ufffd.bag", json.loads(self.read("out.json"))["bag"])


if __name__ == "__main__":
    for name in ("simulate", "replay", "design"):
        TOOLS[name] = sys.argv.pop(1)
    unittest.main()
