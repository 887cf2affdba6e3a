"""What a plant file states of its formulas psi, against the formulas at many points."""

import ast
import math
import random

from claim import Unreadable

POINTS = 4000

FUNCTIONS = {
    "sin": math.sin, "cos": math.cos, "tan": math.tan, "asin": math.asin, "acos": math.acos,
    "atan": math.atan, "atan2": math.atan2, "sinh": math.sinh, "cosh": math.cosh, "tanh": math.tanh,
    "exp": math.exp, "ln": math.log, "sqrt": math.sqrt, "abs": abs, "min": min, "max": max,
    "sign": lambda x: (x > 0) - (x < 0),
}
OPERATIONS = {
    ast.Add: lambda a, b: a + b, ast.Sub: lambda a, b: a - b, ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b, ast.Pow: lambda a, b: a ** b,
}


def compiled(text):
    """v -> the value of a formula in v1, v2, ..."""
    tree = ast.parse(str(text).replace("^", "**"), mode="eval").body

    def value(node, v):
        if isinstance(node, ast.Constant):
            return float(node.value)
        if isinstance(node, ast.Name) and node.id[:1] == "v" and node.id[1:].isdigit():
            return v[int(node.id[1:]) - 1]
        if isinstance(node, ast.BinOp) and type(node.op) in OPERATIONS:
            return OPERATIONS[type(node.op)](value(node.left, v), value(node.right, v))
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.USub, ast.UAdd)):
            operand = value(node.operand, v)
            return -operand if isinstance(node.op, ast.USub) else operand
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") in FUNCTIONS:
            return FUNCTIONS[node.func.id](*(value(argument, v) for argument in node.args))
        raise Unreadable(f"a formula is not one that this program knows: {text}")

    return lambda v: value(tree, v)


def pairs(size, seed=1):
    """Points from 1e-3 to 1e3 away, each with one near it or as far away."""
    generator = random.Random(seed)
    for _ in range(POINTS):
        scale = 10 ** generator.uniform(-3, 3)
        a = [generator.gauss(0, scale) for _ in range(size)]
        apart = scale * 10 ** generator.uniform(-4, 0.5)
        yield a, [x + generator.gauss(0, apart) for x in a]


def values(formulas, v):
    try:
        return [formula(v) for formula in formulas]
    except (ValueError, ZeroDivisionError, OverflowError):
        return None


def steepest(formulas, size):
    """The largest |psi(a) - psi(b)| / |a - b| that was found."""
    largest = 0.0
    for a, b in pairs(size):
        at_a, at_b = values(formulas, a), values(formulas, b)
        if at_a is None or at_b is None or a == b:
            continue
        largest = max(largest, math.dist(at_a, at_b) / math.dist(a, b))
    return largest


def slopes(formulas, size):
    """Jacobians of psi at many points, by central differences."""
    for a, _ in pairs(size):
        jacobian = []
        for j in range(size):
            step = 1e-6 * max(1.0, abs(a[j]))
            above = values(formulas, a[:j] + [a[j] + step] + a[j + 1:])
            below = values(formulas, a[:j] + [a[j] - step] + a[j + 1:])
            if above is None or below is None:
                break
            jacobian.append([(x - y) / (2 * step) for x, y in zip(above, below)])
        else:
            yield jacobian  # by columns


def lipschitz_constant_is_refuted(psi, size, constant):
    return steepest([compiled(text) for text in psi], size) > float(constant) * (1 + 1e-6)


def vertices_are_refuted(psi, G, S, vertices):
    """Whether an entry of G psi'(v) S lies outside of those of all vertices."""
    formulas = [compiled(text) for text in psi]
    n, size = len(G), len(S)
    low = [[min(float(vertex[i][j]) for vertex in vertices) for j in range(n)] for i in range(n)]
    high = [[max(float(vertex[i][j]) for vertex in vertices) for j in range(n)] for i in range(n)]
    margin = 1e-5 * (1 + max(abs(x) for rows in (low, high) for row in rows for x in row))
    for columns in slopes(formulas, size):
        for i in range(n):
            for j in range(n):
                entry = sum(float(G[i][k]) * columns[q][k] * float(S[q][j])
                            for q in range(size) for k in range(len(formulas)))
                if not low[i][j] - margin <= entry <= high[i][j] + margin:
                    return True
    return False
