"""Figures of etienne2019."""
from runs import OTHER, Run, both, chart, curve


def etienne2019(folder):
    run = Run(folder, "etienne2019_fig1")
    samples = chart(
        "samples",
        [curve("error of x1", run.t, run.error["x1"], OTHER)],
        lines=[{"x": time, "label": "samples"} for time in run.samples()],
    )
    yield {
        "short": "etienne2019, 1",
        "title": "etienne2019, Fig. 1: a DC drive, of which a noisy angle is sampled",
        "charts": [both(run, "x2", "x2"), both(run, "x3", "x3"), samples],
        "printed": "L = (−2.2, 0.16, 0.45) for α = 1, h = 0.4; the observer follows, robustly.",
        "here": "Largest error of x2 and x3 from 10 s on: %.3g and %.3g."
        % tuple(abs(run.error[state][run.t >= 10]).max() for state in ("x2", "x3")),
        "differs": "Input, initial state and shortest time between samples are not printed. Π is printed in the order (w, y), with which (12)–(15) are infeasible; the bound γ = 2.7 is valid, and loose.",
        "made": "config/examples/etienne2019_dc_drive with gains_printed.yaml",
    }
