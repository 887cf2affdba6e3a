"""What a claim demands: matrices that must be positive definite, at once or for all times τ."""

import time
from dataclasses import dataclass, field

import mpmath
from mpmath import mp, mpf

from high_precision import (balancing, exponential, frobenius, minus, norm_1, pivots_and_factor, plus,
                            product, products, solved, symmetrized, times, transposed)

TERMS = 10


@dataclass
class Fixed:
    """A symmetric matrix that must be positive definite."""
    name: str
    matrix: list

    def judge(self, _seconds):
        pivot = min(pivots_and_factor(self.matrix)[0], default=mpf(1))
        return Verdict(self.name, "holds" if pivot > 0 else "violated", pivot)


@dataclass
class Number:
    """A number that must be positive, or not negative."""
    name: str
    value: object
    may_be_zero: bool = False

    def judge(self, _seconds):
        good = self.value > 0 or (self.may_be_zero and self.value == 0)
        return Verdict(self.name, "holds" if good else "violated", self.value)


@dataclass
class Statement:
    """Something that is true or not."""
    name: str
    holds: bool

    def judge(self, _seconds):
        return Verdict(self.name, "holds" if self.holds else "violated", mpf(int(self.holds)))


@dataclass
class Verdict:
    """`margin` is the least pivot of the matrix scaled to unit diagonal.

    answer: `holds`, `violated`, or `sampled`: no violation found where it was looked for, which
    was not everywhere.
    """
    name: str
    answer: str
    margin: object
    tau: object = None
    points: int = 1

    def __str__(self):
        text = f"{self.answer:9} {self.name}: least pivot {mpmath.nstr(self.margin, 4)}"
        if self.tau is not None:
            text += f" at tau = {mpmath.nstr(self.tau, 12)} s"
        return text + (f", {self.points} points" if self.points > 1 else "")


@dataclass
class OverTimes:
    """sign (Y' e^{B'τ} Z' Z e^{Bτ} Y − X) > 0 for all τ in [low, high]."""
    name: str
    sign: int
    Z: list
    B: list
    Y: list
    X: list
    low: object
    high: object
    _flown: dict = field(default_factory=dict)
    _last: tuple = None

    def __post_init__(self):
        """Other units for what flows, in which B is not larger than it need be."""
        d = balancing(self.B)
        n = len(d)
        self.Z = [[self.Z[i][j] * d[j] for j in range(n)] for i in range(len(self.Z))]
        self.B = [[self.B[i][j] * d[j] / d[i] for j in range(n)] for i in range(n)]
        self.Y = [[value / d[i] for value in self.Y[i]] for i in range(n)]

    def matrix_of(self, flown):
        image = products(self.Z, flown, self.Y)
        return times(mpf(self.sign), minus(product(transposed(image), image), self.X))

    def at(self, tau):
        return min(pivots_and_factor(self.matrix_of(self.flown(tau)))[0], default=mpf(1))

    def flown(self, tau):
        if tau not in self._flown:
            self._flown[tau] = exponential(times(tau, self.B))
        return self._flown[tau]

    def judge(self, seconds):
        """Samples first, since that finds what is violated; then encloses interval by interval."""
        end = time.process_time() + seconds
        if not self.Y or not self.Y[0]:
            return Verdict(self.name, "holds", mpf(1))
        worst = self.search(end)
        if worst.margin <= 0:
            worst.answer = "violated"
            return worst
        found, covered = self.enclose(end)
        worst.points += found.points
        if found.margin < worst.margin:
            worst.margin, worst.tau = found.margin, found.tau
        worst.answer = "violated" if worst.margin <= 0 else "holds" if covered else "sampled"
        return worst

    def search(self, end, points=33):
        """The least pivot on points of equal distance and of equal ratio, then around the least."""
        low, high = self.low, self.high
        if low == high:
            return Verdict(self.name, "sampled", self.at(low), low)
        taus = {low, high}
        taus.update(low + (high - low) * k / (points - 1) for k in range(points))
        if low > 0 and high > 8 * low:
            taus.update(low * (high / low) ** (mpf(k) / (points - 1)) for k in range(1, points - 1))
        values = {}
        for tau in sorted(taus):
            values[tau] = self.at(tau)
            if values[tau] <= 0 or time.process_time() > end:
                break
        ordered = sorted(values)
        best = min(ordered, key=values.get)
        index = ordered.index(best)
        a, b = ordered[max(index - 1, 0)], ordered[min(index + 1, len(ordered) - 1)]
        ratio = (mpmath.sqrt(5) - 1) / 2
        for _ in range(12):
            if values[best] <= 0 or time.process_time() > end:
                break
            c, d = b - ratio * (b - a), a + ratio * (b - a)
            for tau in (c, d):
                if tau not in values:
                    values[tau] = self.at(tau)
            if values[c] < values[d]:
                b = d
            else:
                a = c
            best = min(values, key=values.get)
        return Verdict(self.name, "sampled", values[best], best, len(values))

    def enclose(self, end):
        """Goes from low to high by intervals in which the matrix can't cease to be definite.

        With F F' the matrix at c, and W_k = Z B^k e^{Bc} Y F'⁻¹ / k!, the matrix at c + s is
        F (I + D(s)) F' with D(s) the sum of s^(i+j) W_i' W_j over i + j > 0.
        """
        at = self.low
        length = (self.high - self.low) / 8
        worst = Verdict(self.name, "sampled", mpf(1), at, 0)
        norm_B = norm_1(self.B) if self.B else mpf(0)
        if norm_B > 0:
            length = min(length, 1 / norm_B)
        while True:
            if time.process_time() > end:
                return worst, False
            center = min(at + length, self.high)
            flown = self.flown_on(center)
            pivots, factor = pivots_and_factor(self.matrix_of(flown))
            worst.points += 1
            if min(pivots) < worst.margin:
                worst.margin, worst.tau = min(pivots), center
            if factor is None:
                return worst, False
            radius = self.radius(flown, factor, max(center - at, length))
            if center - at > radius:
                length = radius * mpf("0.7")
                if center - at < (self.high - self.low) * mpf(10) ** -12 or length == 0:
                    return worst, False
                continue
            if center + radius >= self.high:
                return worst, True
            at = center + radius
            length = radius * mpf("0.9")

    def flown_on(self, tau):
        """e^{Bτ}, from the last one by the time between."""
        last = self._last
        if last is None or tau < last[0]:
            result = exponential(times(tau, self.B))
        elif tau == last[0]:
            return last[1]
        else:
            result = product(exponential(times(tau - last[0], self.B)), last[1])
        self._last = (tau, result)
        return result

    def radius(self, flown, factor, wanted):
        W = [transposed(solved(factor, transposed(product(flown, self.Y))))]
        for k in range(1, TERMS + 2):
            W.append(times(mpf(1) / k, product(self.B, W[-1])))
        rest = frobenius(self.Z) * frobenius(W.pop())
        W = [product(self.Z, term) for term in W]
        w = [frobenius(term) for term in W]
        # Of the first two powers the matrices themselves, of the others what they are at most.
        first = frobenius(symmetrized(product(transposed(W[0]), W[1])))
        second = frobenius(plus(symmetrized(product(transposed(W[0]), W[2])),
                                product(transposed(W[1]), W[1])))
        norm_B = frobenius(self.B)

        def reach(s):
            g = mp.fsum(w[k] * s ** k for k in range(TERMS + 1))
            g += rest * s ** (TERMS + 1) * mpmath.exp(norm_B * s)
            at_most = w[0] ** 2 + 2 * w[0] * w[1] * s + (2 * w[0] * w[2] + w[1] ** 2) * s ** 2
            return g * g - at_most + first * s + second * s * s

        s = wanted * 4
        while reach(s) >= 1:
            s /= 2
            if s < mpf(10) ** -30 * (1 + self.high):
                return mpf(0)
        return s


@dataclass
class Contracts:
    """reset e^{flow τ}, again and again, shrinks at least as keep(τ) does, for each of some τ.

    That is about the error itself, whatever a theorem says. The powers of reset e^{flow τ} / keep(τ)
    are compared with what a defective eigenvalue on the unit circle could do at most.
    """
    name: str
    flow: list
    reset: list
    keep: object
    taus: list
    squarings: int = 24

    def judge(self, _seconds):
        with mp.workdps(40):
            rates = [(self.growth(tau), tau) for tau in self.taus]
        worst, tau = max(rates)
        answer = "violated" if worst > 0 else "holds"
        return Verdict(self.name, answer, -worst, tau, len(rates))

    def growth(self, tau):
        """Of the logarithm of the norm with each step, less what counts as none."""
        n = len(self.flow)
        step = product(self.reset, exponential(times(tau, self.flow)))
        step = times(1 / self.keep(tau), step)
        log = mpf(0)
        for _ in range(self.squarings):
            norm = frobenius(step)
            if norm == 0:
                return mpf("-inf")
            step = times(1 / norm, step)
            log = 2 * (log + mpmath.log(norm))
            step = product(step, step)
        size = frobenius(step)
        if size == 0:
            return mpf("-inf")
        power = mpf(2) ** self.squarings
        # A defective matrix grows like power^(n−1), one in bad units by what they are at first.
        return (log + mpmath.log(size) - n * mpmath.log(power) - 80) / power
