#!/usr/bin/env python3
"""Draws the figures of bernard2022 from the bags that scripts/paper_figures made in a folder, and says
what they show in numbers."""
import os
import sys

import matplotlib
import rosbag

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402


class Run:
    """Truth and estimates of a run at the stamps that have both, in seconds since its start."""

    def __init__(self, folder, name):
        truth, _ = self.states(os.path.join(folder, name + ".bag"), "truth")
        estimates, names = self.states(os.path.join(folder, name + "_estimates.bag"), "estimate")
        stamps = [stamp for stamp in sorted(truth) if stamp in estimates]
        if not stamps:
            sys.exit("%s: truth and estimates have no stamp in common" % name)
        self.names = names
        self.times = [(stamp - stamps[0]) / 1e9 for stamp in stamps]
        self.truth = [truth[stamp] for stamp in stamps]
        self.estimate = [estimates[stamp] for stamp in stamps]

    @staticmethod
    def states(path, topic):
        found, names = {}, []
        with rosbag.Bag(path) as bag:
            for name, message, _ in bag.read_messages():
                if name.strip("/") == topic:
                    found[message.header.stamp.to_nsec()] = message.state
                    names = message.names
        return found, names

    def error(self, k):
        return [e - x for x, e in zip(self.truth[k], self.estimate[k])]

    def norm(self, k):
        return sum(e * e for e in self.error(k)) ** 0.5

    def at(self, time):
        return min(range(len(self.times)), key=lambda k: abs(self.times[k] - time))

    def draw(self, axis, state, label):
        i = self.names.index(state)
        axis.plot(self.times, [x[i] for x in self.truth], color="#888888", linewidth=2.2)
        axis.plot(self.times, [x[i] for x in self.estimate], color="#0055aa", linewidth=1.0)
        axis.set_ylabel(label)
        axis.grid(alpha=0.3)


def save(figure, folder, name, title):
    figure.suptitle(title, fontsize=10)
    figure.tight_layout(rect=(0, 0, 1, 0.96))
    path = os.path.join(folder, name + ".png")
    figure.savefig(path, dpi=110)
    pyplot.close(figure)
    print("written", path)


def states_below_each_other(run, states, labels, unit):
    figure, axes = pyplot.subplots(len(states), 1, sharex=True, figsize=(8, 1.0 + 1.7 * len(states)))
    for axis, state, label in zip(axes, states, labels):
        run.draw(axis, state, label)
    axes[-1].set_xlabel(unit)
    return figure


def main():
    folder = sys.argv[1]
    ball = Run(folder, "fig2")
    figure = states_below_each_other(ball, ["theta", "omega"], ["height [m]", "velocity [m/s]"], "t [s]")
    save(figure, folder, "fig2", "Fig. 2: jump-based estimation of a Zeno bouncing ball (grey: truth)")
    print("Fig. 2: |error| %.3g at t = 0, %.3g at the end, t = %.2f s"
          % (ball.norm(0), ball.norm(-1), ball.times[-1]))

    neuron = Run(folder, "fig3")
    figure = states_below_each_other(neuron, ["x1", "x2", "a", "b"], ["x1 [mV]", "x2", "a", "b"], "t [ms]")
    save(figure, folder, "fig3", "Fig. 3: flow-based estimation of a neuron and its parameters (grey: truth)")
    print("Fig. 3: a = %.4f, b = %.4f at t = 20 ms" % tuple(neuron.estimate[neuron.at(20)][2:4]))

    spikes = Run(folder, "fig4")
    delayed = [(delay, Run(folder, "fig4_delay_%d" % delay)) for delay in (1, 5)]
    figure, axes = pyplot.subplots(2, 2, figsize=(11, 6.5))
    for axis, state in zip((axes[0, 0], axes[0, 1], axes[1, 0]), ("x1", "x2", "d")):
        spikes.draw(axis, state, state)
        axis.set_xlabel("t [ms]")
    last = axes[1, 1]
    for label, run, color in [("5 ms", delayed[1][1], "#ee99cc"), ("1 ms", delayed[0][1], "#0055aa"),
                              ("no delay", spikes, "#cc3311")]:
        late = [k for k, time in enumerate(run.times) if time >= 1200]
        last.semilogy([run.times[k] for k in late], [max(run.norm(k), 1e-4) for k in late], color=color,
                      linewidth=1.0, label=label)
        print("Fig. 4: with %s the error is %.2g (median from 1200 ms on), at most %.3g"
              % (label, sorted(run.norm(k) for k in late)[len(late) // 2], max(run.norm(k) for k in late)))
    last.set_ylabel("|error|")
    last.set_xlabel("t [ms]")
    last.legend(loc="upper right")
    last.grid(alpha=0.3)
    save(figure, folder, "fig4", "Fig. 4: jump-based estimation of a neuron, and what delays do (grey: truth)")


if __name__ == "__main__":
    main()
