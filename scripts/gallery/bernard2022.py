"""Figures of bernard2022."""
import numpy

from runs import ESTIMATE, OTHER, THIRD, Run, both, chart, curve


def bernard2022(folder):
    ball = Run(folder, "bernard2022_fig2")
    yield {
        "short": "bernard2022, 2",
        "title": "bernard2022, Fig. 2: a Zeno bouncing ball, of which impacts are felt",
        "charts": [both(ball, "theta", "height [m]"), both(ball, "omega", "velocity [m/s]")],
        "printed": "The estimate from (10, 2) meets the ball from (5, 0) before the Zeno time.",
        "here": "|error| %.3g at t = 0, %.3g at the end, t = %.2f s." % (ball.norm[0], ball.norm[-1], ball.t[-1]),
        "made": "config/examples/bernard2022_bouncing_ball with gains_printed.yaml",
    }
    neuron = Run(folder, "bernard2022_fig3")
    at = neuron.at(20)
    yield {
        "short": "3",
        "title": "bernard2022, Fig. 3: a neuron's state and parameters by high gain",
        "charts": [both(neuron, state, state, "t [ms]") for state in ("x1", "x2", "a", "b")],
        "printed": "a and b are found within some 20 ms.",
        "here": "a = %.4f, b = %.4f at 20 ms (0.02, 0.2)." % (neuron.estimate("a")[at], neuron.estimate("b")[at]),
        "differs": "The saturations are not printed: a in [0.001, 0.3], b in [0, 0.6], x2 in [−30, 30] here.",
        "made": "config/examples/bernard2022_neuron_high_gain with gains_printed.yaml",
    }
    runs = [
        ("no delay", Run(folder, "bernard2022_fig4")),
        ("1 ms", Run(folder, "bernard2022_fig4_delay_1")),
        ("5 ms", Run(folder, "bernard2022_fig4_delay_5")),
    ]
    spikes = runs[0][1]
    residual = [
        curve(label, run.t[run.t >= 1200], numpy.maximum(run.norm[run.t >= 1200], 1e-4), colour)
        for (label, run), colour in zip(reversed(runs), (THIRD, ESTIMATE, OTHER))
    ]
    yield {
        "short": "4",
        "title": "bernard2022, Fig. 4: a neuron by its spikes, and what delays do",
        "charts": [
            *(both(spikes, state, state, "t [ms]") for state in ("x1", "x2", "d")),
            chart("|error| from 1200 ms on", residual, x_label="t from 1200 ms on", logarithmic=True),
        ],
        "printed": "L_d = (0, 0.0028, −0.0063) for 30 to 50 ms between spikes; errors remain that grow with the delay.",
        "here": "Medians of the error from 1200 ms on: "
        + ", ".join("%.2g with %s" % (numpy.median(run.norm[run.t >= 1200]), label) for label, run in runs)
        + ".",
        "differs": "A_c is called nilpotent, but its square has an entry a; the printed L_d is valid all the same.",
        "made": "config/examples/bernard2022_neuron_jump_based with gains_printed.yaml",
    }
