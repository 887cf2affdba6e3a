"""Figures of ferrante2019."""
import os

import numpy

from runs import ESTIMATE, OTHER, THIRD, Run, chart, curve, rows_of


def sweep_charts(folder, name, x=lambda T2: T2, x_label="T2 [s]"):
    methods = {}
    for row in rows_of(os.path.join(folder, name, "curve.csv")):
        if row["gamma"]:
            methods.setdefault(row["method"], ([], []))
            methods[row["method"]][0].append(x(float(row["T2"])))
            methods[row["method"]][1].append(float(row["gamma"]))
    curves = [
        curve(
            method.replace("ferrante2019_proposition", "Proposition "),
            numpy.array(over),
            numpy.array(gammas),
            "series-%d" % i,
        )
        for i, (method, (over, gammas)) in enumerate(sorted(methods.items()))
    ]
    return [
        chart("least L2 gain γ", curves, x_label=x_label, logarithmic=True, marks=True, fills=False, height=340)
    ], methods


def reach(methods):
    """How far each method of a sweep goes, and how good it is there."""
    return (
        "Largest T2 with a design: "
        + ", ".join(
            "%.3g s by Proposition %s (γ = %.3g)" % (over[-1], method[-1], gammas[-1])
            for method, (over, gammas) in sorted(methods.items())
        )
        + "."
    )


def best(methods):
    """Which method has the least γ at every T2 of a sweep that it reaches."""
    least = {}
    for over, gammas in methods.values():
        for T2, gamma in zip(over, gammas):
            least[T2] = min(gamma, least.get(T2, numpy.inf))
    names = [
        method[-1]
        for method, (over, gammas) in methods.items()
        if set(least) == set(over) and all(g <= least[T2] for T2, g in zip(over, gammas))
    ]
    return "Proposition %s is best at each T2. " % names[0] if names else ""


def compare(folder, names, states, labels):
    runs = [(label, Run(folder, name)) for label, name in zip(labels, names)]
    colours = (ESTIMATE, OTHER, THIRD)
    charts = [
        chart(
            "error of " + state,
            [curve(label, run.t, run.error[state], colour) for (label, run), colour in zip(runs, colours)],
        )
        for state in states
    ]
    return charts, [run for _, run in runs]


def ferrante2019(folder):
    sizes = numpy.arange(1, 31)
    sym = sizes * (sizes + 1) / 2
    counts = {
        "Proposition 2": sym + 1 + 1 + sizes + 1,
        "Propositions 3, 4": sym + 1 + 2 + sizes**2 + sizes + 1,
        "Proposition 5": sym + 1 + 4 + sizes**2 + 5 * sizes + 1,
    }
    yield {
        "short": "ferrante2019, 1",
        "title": "ferrante2019, Fig. 1 and tables I, II: numbers of scalar variables",
        "charts": [
            chart(
                "scalar variables, one output",
                [
                    curve(name, sizes, count, "series-%d" % i, points=True)
                    for i, (name, count) in enumerate(counts.items())
                ],
                x_label="number of states",
                height=260,
            )
        ],
        "printed": "Table II, four states and two outputs: 26 for Proposition 2, 46 for 3, 86 for 5.",
        "here": "The formulas of table I give the same.",
        "made": "the formulas of table I",
    }
    charts, methods = sweep_charts(folder, "ferrante2019_fig2")
    yield {
        "short": "2",
        "title": "ferrante2019, Fig. 2: what more time between samples costs an oscillator",
        "charts": charts,
        "printed": "Proposition 2 is best; at T2 = 0.41 s γ = 36 with L = (2.067, −3), H = −1.384.",
        "here": best(methods) + reach(methods) + " Theorem 2 proves γ = 32.92 of the printed gains.",
        "differs": "The infimum of Proposition 2 is not attained: |L| grows without bound, so that it is bounded here (gain_bound). (37) is printed with λ_t P1 instead of 2 λ_t P1; "
        "designs here satisfy Theorem 2.",
        "made": "design sweep config/examples/ferrante2019_oscillator/plant.yaml",
    }
    for number, text in ((3, "a disturbance of ±1 up to 15 s"), (4, "no disturbance")):
        charts, runs = compare(
            folder,
            ["ferrante2019_fig%d_%s" % (number, gains) for gains in ("printed", "predictor")],
            ["z1", "z2"],
            ["gains (51)", "gains (50)"],
        )
        largest = [run.norm[run.t <= 15].max() for run in runs]
        norms = [run.norm[run.at(10)] for run in runs]
        yield {
            "short": str(number),
            "title": "ferrante2019, Fig. %d: errors of an oscillator with %s" % (number, text),
            "charts": charts,
            "printed": "The design (51) rejects the disturbance better than (50)."
            if number == 3
            else "The design (51) converges faster than (50).",
            "here": "Largest error up to 15 s: %.3g with (51), %.3g with (50)." % tuple(largest)
            if number == 3
            else "The error at 10 s: %.3g with (51), %.3g with (50)." % tuple(norms),
            "differs": "(50) is certified for λ_t up to 0.0132 at T2 = 0.41 s.",
            "made": "config/examples/ferrante2019_oscillator with gains_printed.yaml and gains_predictor.yaml",
        }
    charts, methods = sweep_charts(
        folder, "ferrante2019_fig5", x=lambda T2: 100 * (T2 - 0.17148) / 0.17148, x_label="relative jitter [%]"
    )
    x, y = methods["ferrante2019_proposition5"]
    near = min(range(len(x)), key=lambda i: abs(x[i] - 75))
    yield {
        "short": "5",
        "title": "ferrante2019, Fig. 5: what jitter costs a unicycle",
        "charts": charts,
        "printed": "γ = 1.5140 at a jitter of 75 %.",
        "here": "γ = %.4g at %.3g %%." % (y[near], x[near]),
        "made": "design sweep config/examples/ferrante2019_unicycle/plant.yaml",
    }
    charts, runs = compare(
        folder,
        ["ferrante2019_fig6_%s" % gains for gains in ("printed", "reference")],
        ["heading", "yaw_rate", "distance"],
        ["L", "L2"],
    )
    norm = chart(
        "|error|",
        [curve(label, run.t, run.norm, colour) for label, run, colour in zip(("L", "L2"), runs, (ESTIMATE, OTHER))],
        logarithmic=True,
    )
    yield {
        "short": "6",
        "title": "ferrante2019, Fig. 6: convergence of the unicycle's estimates",
        "charts": [norm, *charts],
        "printed": "L converges faster than the earlier L2.",
        "here": "The error at 5 s: %.3g with L, %.3g with L2." % tuple(run.norm[run.at(5)] for run in runs),
        "differs": "The text calls the states by other names than its gains have: they are (heading, yaw rate, distance).",
        "made": "config/examples/ferrante2019_unicycle",
    }
    charts, runs = compare(
        folder,
        ["ferrante2019_fig7_%s" % gains for gains in ("printed", "reference")],
        ["heading", "yaw_rate", "distance"],
        ["L", "L2"],
    )
    yield {
        "short": "7",
        "title": "ferrante2019, Fig. 7: the unicycle's errors under an unknown torque",
        "charts": charts,
        "printed": "L rejects the torque better.",
        "here": "RMS of the yaw rate's error: %.3g with L, %.3g with L2."
        % tuple(numpy.sqrt(numpy.mean(run.error["yaw_rate"] ** 2)) for run in runs),
        "made": "config/examples/ferrante2019_unicycle",
    }
    charts, methods = sweep_charts(folder, "ferrante2019_fig8")
    yield {
        "short": "8",
        "title": "ferrante2019, Fig. 8: what more time between samples costs a flexible link",
        "charts": charts,
        "printed": "T2 up to 0.3 s; at 0.1 s all γ are below 1. 716.6 s to 1199.2 s for each curve of 100 δ and 20 T2.",
        "here": best(methods) + reach(methods),
        "differs": "δ is searched for, not on a grid. Whether C_p is the link's angle alone can't be read in print: here it is.",
        "made": "design sweep config/examples/ferrante2019_flexible_link/plant.yaml",
    }
    charts, runs = compare(
        folder,
        ["ferrante2019_fig9_%d" % number for number in (2, 3, 5)],
        ["z3", "z4"],
        ["Proposition 2", "Proposition 3", "Proposition 5"],
    )
    yield {
        "short": "9",
        "title": "ferrante2019, Fig. 9: the link's errors under an unknown torque of the motor",
        "charts": charts,
        "printed": "Proposition 2 rejects it best.",
        "here": "Largest error of z3: %.3g, %.3g and %.3g." % tuple(abs(run.error["z3"]).max() for run in runs),
        "made": "config/examples/ferrante2019_flexible_link",
    }
