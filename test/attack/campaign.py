#!/usr/bin/env python3
"""Designs for random plants by all methods and objectives, and checks each claim again by itself.

A claim is a gain file that `design synthesize` has written. It is false where independent_check.py
finds a condition of its theorem violated, or where the file says other times than were asked for or
gains above their bound. Exit status: 0 no false claim, 2 some.
"""

import argparse
import collections
import csv
import itertools
import multiprocessing
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import yaml  # noqa: E402
from mpmath import mp  # noqa: E402

from claim import number, numbers  # noqa: E402
from high_precision import frobenius, product, transposed  # noqa: E402
from independent_check import judge  # noqa: E402
from random_plants import RandomPlant  # noqa: E402

DESIGNED, REFUSED, VIOLATED, NONE, UNDECIDED = 0, 1, 2, 3, 4
OUTCOMES = {DESIGNED: "designed", REFUSED: "refused", VIOLATED: "does not hold", NONE: "none found",
            UNDECIDED: "undecided"}
Task = collections.namedtuple("Task", "seed tool methods objectives draw folder limit check_seconds "
                                      "end")
Result = collections.namedtuple("Result", "seed kind states method objective outcome seconds "
                                          "verdict file")


def choices_of(tool):
    """The methods and objectives that the tool offers; None is to leave the option out."""

    def choices(option):
        command = [tool, "synthesize", "plant.yaml", "-o", "gains.yaml", option, "?"]
        refused = subprocess.run(command, check=False, stderr=subprocess.PIPE,
                                 universal_newlines=True)
        return re.search("expected one of (.*), found", refused.stderr).group(1).split(", ")

    return choices("--method") + [None], [None] + choices("--objective")


def faults_of(path, document, objective):
    """What is wrong with a gain file besides its conditions."""
    with open(path, encoding="utf-8") as stream:
        gain_file = yaml.safe_load(stream)
    certificate, asked = gain_file["certificate"], document["design"]["sampling"]
    if number(certificate["T1"]) != number(asked["T1"]):
        yield f"T1 = {certificate['T1']}, asked for {asked['T1']}"
    T2 = number(certificate["T2"])
    if T2 < number(asked["T2"]) or (objective != "max-T2" and T2 != number(asked["T2"])):
        yield f"T2 = {certificate['T2']}, asked for {asked['T2']}"
    if gain_file["sampling"] != {key: certificate[key] for key in ("T1", "T2")}:
        yield "sampling is not that of the certificate"
    bound = certificate.get("parameters", {}).get("gain_bound")
    for name, value in gain_file["gains"].items() if bound is not None else ():
        # It is about the gain of the flow where there is one: L_d, at jumps, has another unit.
        if name not in ("L", "L_c") or isinstance(value, dict):
            continue
        gain = numbers(value)
        # (|L' L L' L|_F)^(1/4) is at most its norm times the fourth root of the number of outputs.
        square = product(transposed(gain), gain)
        if frobenius(product(square, square)) > len(square) ** 0.5 * (number(bound) * 1.000001) ** 4:
            yield f"the norm of {name} is above gain_bound = {bound}"


def verdict_on(path, document, objective, seconds):
    mp.dps = 60
    faults = list(faults_of(path, document, objective))
    verdicts = judge(path, seconds=seconds)
    faults += [str(verdict) for verdict in verdicts if verdict.answer == "violated"]
    if faults:
        return "false: " + "; ".join(faults)
    return "sampled" if any(verdict.answer == "sampled" for verdict in verdicts) else "holds"


def designs_of(task, plant):
    """Pairs of method and objective for a plant: all, or as many as are drawn for its seed."""
    methods = plant.methods([method for method in task.methods if method])
    pairs = list(itertools.product(methods + [None] * (None in task.methods), task.objectives))
    if task.draw is None or task.draw >= len(pairs):
        return pairs
    return random.Random(task.seed).sample(pairs, task.draw)


def attack(task):
    """The designs for one plant."""
    plant = RandomPlant(task.seed)
    document = plant.document()
    folder = os.path.join(task.folder, str(task.seed))
    os.makedirs(folder, exist_ok=True)
    plant_file = os.path.join(folder, "plant.yaml")
    with open(plant_file, "w", encoding="utf-8") as stream:
        yaml.safe_dump(document, stream, default_flow_style=None, width=10000)
    results = []
    for method, objective in designs_of(task, plant):
        if time.time() > task.end:
            break
        name = f"{method or 'any'}-{objective or 'default'}.yaml"
        path = os.path.join(folder, name)
        command = [task.tool, "synthesize", plant_file, "-o", path, "--jobs", "1",
                   "--time-limit", "5"]
        if method:
            command += ["--method", method] + plant.settings(method)
        if objective:
            command += ["--objective", objective]
        begin = time.time()
        outcome = design(command, task.limit)
        seconds = time.time() - begin
        verdict = ""
        if os.path.exists(path):
            try:
                verdict = verdict_on(path, document, objective, task.check_seconds)
            except Exception as error:  # pylint: disable=broad-except
                verdict = f"not checked: {type(error).__name__}: {error}"
            if outcome != OUTCOMES[DESIGNED]:
                verdict += f" (written, exit status: {outcome})"
            if verdict in ("holds", "sampled"):
                os.remove(path)
        results.append(Result(task.seed, plant.kind, plant.n, method, objective, outcome, seconds,
                              verdict, path))
    if all(result.verdict in ("", "holds", "sampled") for result in results):
        shutil.rmtree(folder)
    return results


def design(command, limit):
    """What came of it. The tool has workers of its own: all of them end with it."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               start_new_session=True)
    try:
        status = process.wait(timeout=limit)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        return "too long"
    return OUTCOMES.get(status, f"exit status {status}")


def table(results):
    """Counts by method."""
    rows = collections.defaultdict(collections.Counter)
    columns = collections.Counter()
    for result in results:
        for method in (result.method or "any", "all"):
            rows[method][result.outcome] += 1
        columns[result.outcome] += 1
        if result.verdict:
            kind = result.verdict.split(":")[0].split(" (")[0]
            for method in (result.method or "any", "all"):
                rows[method]["claim " + kind] += 1
            columns["claim " + kind] += 1
    names = sorted(columns)
    width = max([len(name) for name in rows] + [6])
    yield " ".join([" " * width] + [f"{name:>14}" for name in names])
    for method in sorted(rows, key=lambda name: (name == "all", name)):
        yield " ".join([f"{method:{width}}"] + [f"{rows[method][name]:14}" for name in names])


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tool", required=True, help="the program `design`")
    parser.add_argument("-o", "--output", required=True, metavar="FOLDER",
                        help="for false claims with their plants, and claims.csv")
    parser.add_argument("--plants", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1, help="of the first plant")
    parser.add_argument("--draw", type=int, metavar="N",
                        help="designs for a plant, drawn from all its methods and objectives")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--seconds", type=float, default=float("inf"),
                        help="after which no further design begins")
    parser.add_argument("--design-seconds", type=float, default=60.0, help="for one design")
    parser.add_argument("--check-seconds", type=float, default=20.0,
                        help="of processor time, for one condition over tau; then it is sampled only")
    arguments = parser.parse_args()

    methods, objectives = choices_of(arguments.tool)
    os.makedirs(arguments.output, exist_ok=True)
    end = time.time() + arguments.seconds
    tasks = (Task(seed, arguments.tool, methods, objectives, arguments.draw, arguments.output,
                  arguments.design_seconds, arguments.check_seconds, end)
             for seed in range(arguments.seed, arguments.seed + arguments.plants))
    results = []
    plants = 0
    with multiprocessing.Pool(arguments.jobs) as pool, \
            open(os.path.join(arguments.output, "claims.csv"), "w", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(Result._fields)
        for of_plant in pool.imap_unordered(attack, tasks):
            plants += bool(of_plant)
            writer.writerows(of_plant)
            stream.flush()
            results += of_plant
            for result in of_plant:
                if result.verdict not in ("", "holds", "sampled"):
                    print(f"{result.file}: {result.verdict}", flush=True)
    print("\n".join(table(results)))
    claims = [result for result in results if result.verdict]
    false = [result for result in claims if "false" in result.verdict]
    print(f"{plants} plants, {len(results)} designs, {len(claims)} claims: "
          f"{sum(result.verdict == 'holds' for result in claims)} hold, "
          f"{sum(result.verdict == 'sampled' for result in claims)} sampled, {len(false)} false")
    return 2 if false else 0


if __name__ == "__main__":
    sys.exit(main())
