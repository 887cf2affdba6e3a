#!/usr/bin/env python3
"""`design sweep` and `replay --seeds` split by MPI: mpi_test.py DESIGN SIMULATE REPLAY. Skipped where
mpirun of Open MPI is missing, or the package was built without MPI."""
import json
import os
import shutil
import signal
import subprocess
import sys
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "support"))
from folder_test import FolderTest  # noqa: E402

TOOLS = {}
SKIPPED = 77

# ferrante2019, example 1, and how it moves and is measured
OSCILLATOR = """
plant:
  states: [z1, z2]
  A: [[0, 1], [-4, 0]]
sensors:
  position:
    C: [[1, 0]]
    source: {topic: position}
"""
DESIGN = """
design:
  sampling: {T1: 0.1, T2: 0.41}
  N: [[1], [0]]
  C_p: [[1, 0], [0, 1]]
  parameters: {lambda_t: 0.05}
"""
SCENARIO = """
scenario:
  duration: 3
  initial_state: {z1: 1, z2: 0}
  sensors:
    position: {schedule: {uniform: [0.05, 0.1]}}
"""
OBSERVER = """
observer: ConstantGainObserver
rate: 10
sampling: {T1: 0.05, T2: 0.4}
gains: {L: [[0.5], [0.5]]}
"""

MPIRUN = ["mpirun", "--allow-run-as-root", "--oversubscribe"]


def why_skipped():
    library = os.path.join(os.path.dirname(TOOLS["design"]), "..", "libsampled_data_observers_mpi.so")
    if not os.path.exists(library):
        return "built without MPI"
    if not shutil.which("mpirun"):
        return "mpirun is missing"
    version = subprocess.run(["mpirun", "--version"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                             universal_newlines=True, check=False).stdout
    return "" if "Open MPI" in version else "mpirun is not of Open MPI"


class MpiTest(FolderTest):
    def setUp(self):
        super().setUp()
        self.write("plant.yaml", OSCILLATOR + DESIGN)

    def run_in(self, folder, command):
        """What it prints, and its exit status."""
        os.makedirs(self.path(folder), exist_ok=True)
        result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                universal_newlines=True, check=False, timeout=200,
                                cwd=self.path(folder))
        return result.stdout, result.returncode

    def succeed(self, folder, command):
        text, status = self.run_in(folder, command)
        self.assertEqual(status, 0, text)
        return text

    @staticmethod
    def on_ranks(number, command):
        return [*MPIRUN, "-n", str(number), *command]

    @staticmethod
    def sweep(plant="plant.yaml"):
        return [TOOLS["design"], "sweep", "../" + plant, "-o", "out", "--T2", "0.2", "0.4", "--points",
                "6", "--method", "ferrante2019_proposition2"]

    def read(self, name):
        with open(self.path(name)) as file:
            return file.read()

    def points(self, folder):
        """Finished points of points.csv; they come in any order, with the time that each took."""
        try:
            lines = self.read(folder + "/out/points.csv").splitlines()[2:]
        except FileNotFoundError:
            return []
        return [line.split(",")[:-2] for line in lines]

    def stop_in_between(self, folder, command):
        os.makedirs(self.path(folder))
        with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                              cwd=self.path(folder)) as process:
            deadline = time.time() + 100
            while len(self.points(folder)) < 2 and time.time() < deadline:
                time.sleep(0.002)
            process.send_signal(signal.SIGKILL)

    def test_a_sweep_on_four_ranks_is_that_of_one_process_also_after_it_was_killed(self):
        whole = self.succeed("one", self.sweep())
        self.stop_in_between("four", self.on_ranks(4, self.sweep()))
        kept = self.points("four")
        self.assertGreaterEqual(len(kept), 2)
        self.assertEqual(self.succeed("four", self.on_ranks(4, self.sweep())), whole)
        self.assertEqual(self.points("four")[:len(kept)], kept)
        self.assertEqual(sorted(self.points("four")), sorted(self.points("one")))
        self.assertEqual(self.read("four/out/curve.csv"), self.read("one/out/curve.csv"))
        names = sorted(os.listdir(self.path("one/out/gains")))
        self.assertEqual(len(names), 6)
        self.assertEqual(sorted(os.listdir(self.path("four/out/gains"))), names)
        for name in names:
            self.assertEqual(self.read("four/out/gains/" + name), self.read("one/out/gains/" + name))

    def test_a_rank_that_fails_ends_all_with_its_error(self):
        text, status = self.run_in("two", [*self.on_ranks(1, self.sweep()), ":", "-n", "1",
                                            *self.sweep("missing.yaml")])
        self.assertIn("design: rank 1 on ", text)
        self.assertIn("missing.yaml", text)
        self.assertEqual(status, 1, text)

    def test_a_rank_with_another_request_is_refused(self):
        self.write("other.yaml", OSCILLATOR.replace("-4", "-4.1") + DESIGN)
        text, status = self.run_in("two", [*self.on_ranks(1, self.sweep()), ":", "-n", "1",
                                           *self.sweep("other.yaml")])
        self.assertIn("design: rank 1 was asked for something else, or has other files", text)
        self.assertEqual(status, 1, text)

    def test_says_that_mpirun_is_of_another_mpi(self):
        os.environ["PMI_SIZE"] = "4"  # as of MPICH
        self.addCleanup(os.environ.pop, "PMI_SIZE")
        text, status = self.run_in("one", self.sweep())
        self.assertIn("design: mpirun started 4 of this command, but it is not of the MPI", text)
        self.assertEqual(status, 1, text)

    def test_replays_on_four_ranks_are_those_of_one_process(self):
        observer = self.write("observer.yaml", OBSERVER)
        plant = self.write("plant.yaml", OSCILLATOR)
        bag = self.path("run.bag")
        self.succeed(".", [TOOLS["simulate"], plant, self.write("scenario.yaml", SCENARIO), "-o", bag])
        command = [TOOLS["replay"], bag, plant, observer, "--truth", "truth", "--thin", "0.1", "0.4",
                   "--seeds", "6"]
        texts = [self.succeed("one", [*command, "--json", "runs.json"]),
                 self.succeed("four", self.on_ranks(4, [*command, "--json", "runs.json"]))]
        self.assertEqual(*[text.split("\n", 1)[1] for text in texts])  # the first line has the time
        runs = [json.loads(self.read(folder + "/runs.json")) for folder in ("one", "four")]
        for found in runs:
            self.assertEqual([run["seed"] for run in found["runs"]], list(range(6)))
            for run in found["runs"]:
                del run["wall_seconds"]
        self.assertEqual(*runs)
        self.succeed("one", [*command, "--csv", "tables"])
        self.succeed("four", self.on_ranks(4, [*command, "--csv", "tables"]))
        self.assertEqual(self.read("four/tables/seeds.csv"), self.read("one/tables/seeds.csv"))


if __name__ == "__main__":
    TOOLS = {name: sys.argv.pop(1) for name in ("design", "simulate", "replay")}
    reason = why_skipped()
    if reason:
        print("skipped: " + reason)
        sys.exit(SKIPPED)
    unittest.main()
