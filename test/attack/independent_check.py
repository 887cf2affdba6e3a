#!/usr/bin/env python3
"""Checks the claims of gain files again, in 60 digits and more, sharing no line with the package.

Each condition of the claimed theorem is `holds`, `violated`, or `sampled`: not violated wherever it
was looked at, but not enclosed for all times within --seconds.

Exit status: 0 all hold (or were sampled), 2 one is violated, 1 a file can't be read.
"""

import argparse
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import mpmath  # noqa: E402
from mpmath import mp  # noqa: E402

from claim import Unreadable, read_claims  # noqa: E402
from high_precision import balancing, frobenius, symmetrized  # noqa: E402
from theorems import conditions_of  # noqa: E402


def digits_for(claim):
    """60, and as many more as the flow takes away over T2, forward or backward."""
    most = 0
    for mode in claim.modes:
        d = balancing(mode.A)
        n = len(d)
        balanced = [[mode.A[i][j] * d[j] / d[i] for j in range(n)] for i in range(n)]
        scales = mpmath.log10(max(d) / min(d))
        # |e^{Bt}| <= e^{|(B + B')/2| t}, forward and backward.
        growth = frobenius(symmetrized(balanced)) / 2
        most = max(most, scales + growth * claim.T2 / mpmath.log(10))
    return int(60 + min(2 * most, 1000))


def judge(path, plant=None, seconds=60.0):
    """The verdicts on all conditions of the claims in a gain file."""
    mp.dps = 60
    verdicts = []
    for claim in read_claims(path, plant):
        mp.dps = digits_for(claim)
        verdicts += [condition.judge(seconds) for condition in conditions_of(claim)]
    return verdicts


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", metavar="GAINS")
    parser.add_argument("--plant", help="instead of the file that the gain file names")
    parser.add_argument("--seconds", type=float, default=60.0,
                        help="of processor time, for one condition over tau")
    arguments = parser.parse_args()
    status = 0
    for path in arguments.files:
        print(path)
        try:
            verdicts = judge(path, arguments.plant, arguments.seconds)
        except (Unreadable, KeyError, OSError) as error:
            print(f"  can't be checked: {error}")
            status = status or 1
            continue
        for verdict in verdicts:
            print(f"  {verdict}")
        if any(verdict.answer == "violated" for verdict in verdicts):
            status = 2
    return status


if __name__ == "__main__":
    sys.exit(main())
