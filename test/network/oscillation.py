"""The oscillator of config/examples/ferrante2019_oscillator, disturbed, and samples of it."""
import itertools
import math
import random

DISTURBANCE = 0.3
NOISE = 0.1
SHORTEST, LONGEST = 0.11, 0.19  # between samples [s]; the gains are for up to 0.2


def truth(time):
    """The state at a time in seconds: a solution of x1' = x2 + DISTURBANCE, x2' = -4 x1."""
    return [math.cos(2 * time), -2 * math.sin(2 * time) - DISTURBANCE]


def samples():
    """Times in nanoseconds, and values, without end; the same in every process."""
    draws = random.Random(1)
    time = 0
    for _ in itertools.count():
        yield time, truth(1e-9 * time)[0] + draws.uniform(-NOISE, NOISE)
        time += int(1e9 * draws.uniform(SHORTEST, LONGEST))
