"""Figures of ferrante2016."""
import numpy

from runs import ESTIMATE, OTHER, Run, chart, curve


def ferrante2016(folder):
    scalar, spring = Run(folder, "ferrante2016_fig1"), Run(folder, "ferrante2016_fig2")
    samples = scalar.samples()
    count = numpy.searchsorted(samples, scalar.t + 1e-9)
    bound = numpy.e * numpy.exp(-0.0328 * (scalar.t + count)) * scalar.norm[0]
    within = bool((scalar.norm <= bound).all())
    square = spring.norm**2
    at_samples = [square[spring.at(time)] for time in spring.samples()]
    yield {
        "short": "ferrante2016, 1",
        "title": "ferrante2016, Fig. 1: the error of a scalar plant, and its exponential bound",
        "charts": [
            chart(
                "|ε|",
                [curve("error", scalar.t, scalar.norm, ESTIMATE), curve("bound of Theorem 1", scalar.t, bound, OTHER)],
                lines=[{"x": time, "label": "samples"} for time in samples],
                height=300,
            )
        ],
        "printed": "L = 0.7321, β = 0.4698, θ = −0.0657, R = γ = 0.0328; the error below a bound that jumps with it. Its initial state and "
        "first sample are not printed.",
        "here": "The same numbers; the error is %s the bound e · exp(−0.0328 (t + j)) |ε(0)|."
        % ("below" if within else "NOT below"),
        "made": "config/examples/ferrante2016_scalar with gains_printed.yaml",
    }
    yield {
        "short": "2",
        "title": "ferrante2016, Fig. 2: the squared error of two masses over t and over j",
        "charts": [
            chart("|error|²", [curve("squared error", spring.t, square, ESTIMATE)]),
            chart(
                "|error|² at samples",
                [
                    curve(
                        "squared error",
                        numpy.arange(1, len(at_samples) + 1),
                        numpy.array(at_samples),
                        ESTIMATE,
                        points=True,
                    )
                ],
                x_label="j",
            ),
        ],
        "printed": "L = (0.77524, 0.18123, −0.12123, −0.17406, 0.22469); the squared error goes to zero over t and over j.",
        "here": "With this L, %.3g at t = 0, %.3g at the end." % (square[0], square[-1]),
        "differs": "L is not the only one that (41) admits. The times of samples are drawn anew.",
        "made": "config/examples/ferrante2016_mass_spring with gains_printed.yaml",
    }
