"""Figures of sferlazza2019."""
import os

import numpy
import yaml

from runs import ESTIMATE, OTHER, TRUTH, Run, both, chart, curve, flow

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", ".."))
A_AIRCRAFT = numpy.array([[-0.02, -1.4, 9.8], [-0.01, -0.4, 0.0], [0.0, 1.0, 0.0]])
C_AIRCRAFT = numpy.array([[1.0, 0.0, 1.0]])
PRINTED_P = {
    (1, 3): [[0.8334, -0.0041, 0.8333], [-0.0041, 2.0116, -0.0359], [0.8333, -0.0359, 0.8341]],
    (4, 8): [[0.9573, -0.0031, 0.9571], [-0.0031, 2.2754, -0.0122], [0.9571, -0.0122, 0.9573]],
}


def least_eigenvalue(P, tau):
    """Of Ξ_P(τ), sferlazza2019 (21)."""
    P = numpy.array(P)
    across = numpy.array([[0.0, 2**-0.5], [1.0, 0.0], [0.0, -(2**-0.5)]])
    back = flow(A_AIRCRAFT, -tau) @ across
    return numpy.linalg.eigvalsh(numpy.block([[back.T @ P @ back, (P @ across).T], [P @ across, P]]))[0]


def shipped_P(example):
    """P of the certificate of a gain file, which has one list for each row."""
    with open(os.path.join(ROOT, "config", "examples", example, "gains.yaml"), encoding="utf-8") as file:
        return yaml.safe_load(file)["gains"]["P"]


def lyapunov_charts(run, P):
    """V = eᵀ exp(−Aᵀτ) P exp(−Aτ) e and τ, the time since the last sample."""
    samples = numpy.array([0.0] + run.samples())
    tau = run.t - samples[numpy.maximum(0, numpy.searchsorted(samples, run.t + 1e-9) - 1)]
    errors = numpy.array([run.error[state] for state in run.states]).T
    V = [
        float(numpy.linalg.multi_dot([back, numpy.array(P), back]))
        for back in (flow(A_AIRCRAFT, -t) @ e for t, e in zip(tau, errors))
    ]
    return [
        chart("V", [curve("V", run.t, numpy.array(V), ESTIMATE)], logarithmic=True),
        chart("τ [s]", [curve("time since the last sample", run.t, tau, OTHER)]),
    ]


def sferlazza2019(folder):
    of_file = {(1, 3): shipped_P("sferlazza2019_aircraft_1_3"), (4, 8): shipped_P("sferlazza2019_aircraft_4_8")}
    charts, least = [], {}
    for (low, high), printed in PRINTED_P.items():
        tau = numpy.linspace(low, high, 300)
        found = {
            name: numpy.array([least_eigenvalue(P, each) for each in tau])
            for name, P in (("printed P", printed), ("P of this package", of_file[low, high]))
        }
        least[low, high] = {name: values.min() for name, values in found.items()}
        charts.append(
            chart(
                "least eigenvalue of Ξ(τ), [%d, %d]" % (low, high),
                [curve(name, tau, values, colour) for (name, values), colour in zip(found.items(), (TRUTH, ESTIMATE))],
                x_label="τ in [%d, %d] s" % (low, high),
            )
        )
    yield {
        "short": "sferlazza2019, 1",
        "title": "sferlazza2019, Fig. 1: least eigenvalues of (21)",
        "charts": charts,
        "printed": "[1, 3]: a solution after one iteration, P (67). [3, 4]: none. [4, 8]: one after two, P (68).",
        "here": "Printed P: at least %.3g on [1, 3], %.3g on [4, 8]; those that the package ships: %.3g and %.3g."
        % (
            least[1, 3]["printed P"],
            least[4, 8]["printed P"],
            least[1, 3]["P of this package"],
            least[4, 8]["P of this package"],
        ),
        "differs": "[3, 4] is feasible for the plant (66) as printed: its samples lose observability at τ = 8.541 s only. P (68) does not satisfy (21) with "
        "the four decimals printed.",
        "made": "gains.yaml of config/examples/sferlazza2019_aircraft_1_3 and _4_8",
    }
    tau = numpy.linspace(0.05, 10, 400)
    singular = [
        numpy.linalg.svd(numpy.vstack([C_AIRCRAFT @ flow(A_AIRCRAFT, k * each) for k in range(3)]), compute_uv=False)[
            -1
        ]
        for each in tau
    ]
    yield {
        "short": "2",
        "title": "sferlazza2019, Fig. 2: least singular value of the observability matrix",
        "charts": [
            chart(
                "least singular value of O(τ)",
                [curve("of C, C exp(Aτ), C exp(2Aτ)", tau, numpy.array(singular), ESTIMATE)],
                x_label="τ [s]",
                height=300,
            )
        ],
        "printed": "Zero at τ = 3.425 s.",
        "here": "Zero at τ = π / 0.36782 = 8.541 s; %.3g at 3.425 s." % singular[int(numpy.argmin(abs(tau - 3.425)))],
        "differs": "3.425 s does not follow from (66).",
        "made": "the plant (66)",
    }
    for number, name, times, P in (
        (3, "sferlazza2019_fig3", "[1, 3]", PRINTED_P[1, 3]),
        (5, "sferlazza2019_fig5", "[4, 8]", of_file[4, 8]),
    ):
        run = Run(folder, name)
        yield {
            "short": "%d, %d" % (number, number + 1),
            "title": "sferlazza2019, Fig. %d and %d: states, estimates, V and τ for samples %s s apart"
            % (number, number + 1, times),
            "charts": [both(run, state, state) for state in run.states]
            + [
                chart(
                    "errors",
                    [
                        curve("e%d" % (i + 1), run.t, run.error[state], "series-%d" % i)
                        for i, state in enumerate(run.states)
                    ],
                ),
                *lyapunov_charts(run, P),
            ],
            "printed": "Estimates track the states, errors go to zero; V is constant between samples and falls at them.",
            "here": "The norm of the error is %.3g at t = 0 and %.3g at the end, t = %g s."
            % (run.norm[0], run.norm[-1], run.t[-1]),
            "differs": "The initial state is not printed: (1, 1, 1). The feedback gain with its two printed digits is unstable: it has all of its digits here."
            + ("" if number == 3 else " P is the package's, since (68) as printed fails."),
            "made": "config/examples/sferlazza2019_aircraft_%s with %s"
            % (times.strip("[]").replace(", ", "_"), "gains_printed.yaml" if number == 3 else "gains.yaml"),
        }
