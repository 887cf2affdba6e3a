"""Runs over the papers' examples, and their charts."""
import csv
import os
import sys

import numpy

MOST_POINTS = 3000  # of a curve
TRUTH, ESTIMATE, OTHER, THIRD = "truth", "estimate", "series-1", "series-3"


def rows_of(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


class Run:
    """The tables of a replay, with times from its beginning on."""

    def __init__(self, folder, name):
        self.folder = os.path.join(folder, name)
        rows = rows_of(os.path.join(self.folder, "errors.csv"))
        if not rows:
            sys.exit("%s: truth and estimates have no stamp in common" % name)
        self.states = [key[: -len("_truth")] for key in rows[0] if key.endswith("_truth")]
        self.start = float(rows[0]["stamp"])
        self.t = numpy.array([float(row["stamp"]) for row in rows]) - self.start
        self.truth = {state: numpy.array([float(row[state + "_truth"]) for row in rows]) for state in self.states}
        self.error = {state: numpy.array([float(row[state + "_error"]) for row in rows]) for state in self.states}
        self.norm = numpy.array([float(row["norm"]) for row in rows])

    def estimate(self, state):
        return self.truth[state] + self.error[state]

    def stamps(self, table):
        return sorted(float(row["stamp"]) - self.start for row in rows_of(os.path.join(self.folder, table + ".csv")))

    def samples(self):
        """When samples were used, by the table of events."""
        return sorted(
            float(row["arrival"]) - float(row["latency"]) - self.start
            for row in rows_of(os.path.join(self.folder, "events.csv"))
            if row["interval_check"] != "" or row["source"] not in ("input", "jumps")
        )

    def at(self, time):
        return int(numpy.argmin(abs(self.t - time)))


def curve(label, x, y, colour, points=False):
    step = max(1, len(x) // MOST_POINTS)
    return {
        "label": label,
        "x": [round(float(v), 9) for v in x[::step]],
        "points": points,
        "colour": colour,
        "y": [float("%.7g" % v) if numpy.isfinite(v) else None for v in y[::step]],
    }


def chart(y_label, curves, x_label="t [s]", **properties):
    return {"y_label": y_label, "x_label": x_label, "curves": curves, "fills": True, **properties}


def both(run, state, label, x_label="t [s]"):
    """Truth and estimate of a state."""
    return chart(
        label,
        [{**curve("truth", run.t, run.truth[state], TRUTH)}, curve("estimate", run.t, run.estimate(state), ESTIMATE)],
        x_label,
    )


def flow(A, tau):
    """exp(A tau), of an A with different eigenvalues."""
    values, vectors = numpy.linalg.eig(A)
    return (vectors @ numpy.diag(numpy.exp(values * tau)) @ numpy.linalg.inv(vectors)).real
