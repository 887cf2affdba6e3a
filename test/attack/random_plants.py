"""Plants of many kinds at random: fast and slow, unstable, in any units, some of them not observable."""

import math
import random

MOST_STATES = 8


def matrix_product(a, b):
    return [[sum(x * y for x, y in zip(row, column)) for column in zip(*b)] for row in a]


def inverse(a):
    n = len(a)
    rows = [list(a[i]) + [float(i == j) for j in range(n)] for i in range(n)]
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        rows[k] = [value / rows[k][k] for value in rows[k]]
        for i in range(n):
            if i != k:
                rows[i] = [x - rows[i][k] * y for x, y in zip(rows[i], rows[k])]
    return [row[n:] for row in rows]


def diagonal(values):
    return [[value if i == j else 0.0 for j in range(len(values))] for i, value in enumerate(values)]


class RandomPlant:
    """A plant file, for one seed.

    kind: `sampled`, `lipschitz`, `jumping` or `switched`.
    """

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.kind = self.random.choices(["sampled", "lipschitz", "jumping", "switched"],
                                        [60, 10, 22, 8])[0]
        most = MOST_STATES if self.kind == "sampled" else 5
        self.n = min(most, 1 + int(self.random.expovariate(0.45)))
        if self.kind == "switched":
            self.n = max(self.n, 2)
        self.T2 = 10 ** self.random.uniform(-3, 2)
        self.T1 = self.T2 * self.random.choice([1.0, 0.9, 0.5, 0.2, 0.05, 0.001])
        self.make_coordinates()

    def make_coordinates(self):
        """States z = D Q x of modal coordinates x: mixed, and in units up to 1e±6."""
        r = self.random
        mixing = [[r.gauss(0, 1) + 1.5 * (i == j) for j in range(self.n)] for i in range(self.n)]
        if r.random() < 0.25:
            mixing = diagonal([1.0] * self.n)
        decades = r.choices([0, 1, 3, 6], [30, 30, 20, 20])[0]
        units = [10 ** r.uniform(-decades, decades) for _ in range(self.n)]
        self.forward = matrix_product(diagonal(units), mixing)
        self.backward = inverse(self.forward)

    def in_states(self, a):
        return matrix_product(matrix_product(self.forward, a), self.backward)

    def rate(self):
        """Of a mode, with T2 as the unit of time: most decay."""
        r = self.random
        size = 10 ** r.uniform(*r.choice([(-3, -1), (-1, 0.5), (-1, 0.5), (0.5, 2)]))
        if r.random() < 0.12:
            return 0.0
        return size if size < 2 and r.random() < 0.25 else -size

    def modes(self):
        """A of x with x' = A x: blocks of one or two, some of them chains."""
        r = self.random
        a = [[0.0] * self.n for _ in range(self.n)]
        i = 0
        while i < self.n:
            if i + 1 < self.n and r.random() < 0.5:
                damping = r.choice([0.0, min(self.rate(), 0.3), min(self.rate(), 0.3)])
                frequency = 10 ** r.uniform(-1.5, 1.2)
                a[i][i] = a[i + 1][i + 1] = damping
                a[i][i + 1], a[i + 1][i] = frequency, -frequency
                i += 2
                continue
            a[i][i] = self.rate()
            if i > 0 and r.random() < 0.3:
                a[i - 1][i] = r.gauss(0, 1)
                a[i][i] = r.choice([a[i][i], a[i - 1][i - 1]])
            i += 1
        return [[value / self.T2 for value in row] for row in a]

    def outputs(self, most=3):
        r = self.random
        m = min(r.choices([1, 2, 3], [70, 22, 8])[0], self.n, most)
        c = [[r.gauss(0, 1) for _ in range(self.n)] for _ in range(m)]
        if r.random() < 0.15 and self.n > 1:  # a mode that nothing shows
            for row in c:
                row[r.randrange(self.n)] = 0.0
        decades = r.choice([0, 0, 2, 6])
        scale = [10 ** r.uniform(-decades, decades) for _ in range(m)]
        if r.random() < 0.3:  # sensors of single states
            chosen = r.sample(range(self.n), m)
            return [[float(j == k) for j in range(self.n)] for k in chosen]
        return matrix_product(matrix_product(diagonal(scale), c), self.backward)

    def document(self):
        states = [f"x{i + 1}" for i in range(self.n)]
        self.plant = {"states": states}
        self.sensors = {}
        self.design = {"sampling": {"T1": self.T1, "T2": self.T2}}
        getattr(self, f"make_{self.kind}")()
        return {"plant": self.plant, "sensors": self.sensors, "design": self.design}

    def make_sampled(self):
        r = self.random
        self.plant["A"] = self.in_states(self.modes())
        self.sensors["s"] = {"C": self.outputs(), "source": {"topic": "s"}}
        if r.random() < 0.6:
            columns = r.choice([1, 1, 2])
            self.design["N"] = matrix_product(
                self.forward, [[r.gauss(0, 1) for _ in range(columns)] for _ in range(self.n)])
            rows = r.choice([1, self.n])
            self.design["C_p"] = matrix_product(
                [[r.gauss(0, 1) if rows == 1 else float(i == j) for j in range(self.n)]
                 for i in range(rows)], self.backward)

    def make_lipschitz(self):
        r = self.random
        self.make_sampled()
        size = 10 ** r.uniform(-2, 0.5) / self.T2
        g = matrix_product(self.forward, [[size * r.gauss(0, 1)] for _ in range(self.n)])
        s = matrix_product([[r.gauss(0, 1) for _ in range(self.n)]], self.backward)
        self.plant["G"], self.plant["S"] = g, s
        self.plant["psi"] = ["sin(v1)"]
        self.plant["lipschitz_constant"] = 1
        slope = matrix_product(g, s)
        self.plant["vertices"] = {1: slope, 2: [[-value for value in row] for row in slope]}
        self.plant["integration"] = {"step": self.T2 / 1e4}

    def jump_map(self):
        r = self.random
        a_d = [[r.gauss(0, 1) * (r.random() < 0.4) + (i == j) * r.choice([0, 1, 1, -0.8])
                for j in range(self.n)] for i in range(self.n)]
        return {"A_d": self.in_states(a_d)}

    def make_jumping(self):
        r = self.random
        self.plant["A"] = self.in_states(self.modes())
        self.plant["jump_map"] = self.jump_map()
        which = r.choice(["at_jumps", "at_jumps", "continuous", "both"])
        if which != "continuous":
            self.sensors["d"] = {"C": self.outputs(), "measured": "at_jumps"}
        if which != "at_jumps":
            self.sensors["c"] = {"C": self.outputs(most=1 if r.random() < 0.7 else 3),
                                 "measured": "continuous", "source": {"topic": "c"}}

    def make_switched(self):
        r = self.random
        self.plant["modes"] = {
            label: {"A": self.in_states(self.modes())} for label in range(1, r.choice([3, 3, 4]))}
        timing = r.choice(["at_jumps", "continuous"])
        self.sensors["s"] = {"C": self.outputs(), "measured": timing}
        if timing == "continuous":
            self.sensors["s"]["source"] = {"topic": "s"}

    def methods(self, names):
        """Those among the names that are about plants of this kind."""
        papers = {
            "sampled": ("ferrante2016", "ferrante2019", "sferlazza2019", "etienne2019"),
            "lipschitz": ("ferrante2019", "etienne2019"),
            "jumping": ("bernard2022_equation", "bernard2022_example4", "bernard2022_corollary"),
            "switched": ("bernard2022_example7", "bernard2022_section7"),
        }[self.kind]
        return [name for name in names if name.startswith(papers) and "dwell_time" not in name]

    def settings(self, method):
        """What a design can't find itself: the rate of ferrante2019."""
        if not method.startswith("ferrante2019"):
            return []
        share = random.Random(math.fsum([self.T2, self.n])).choice([0.01, 0.1, 0.5])
        return ["--set", f"lambda_t={share / self.T2!r}"]
