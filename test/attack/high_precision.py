"""Matrices of mpmath numbers, as lists of rows: sums, products, exponentials, factors."""

import mpmath
from mpmath import mp, mpf


def matrix(rows):
    return [[mpf(value) for value in row] for row in rows]


def zeros(rows, cols):
    return [[mpf(0)] * cols for _ in range(rows)]


def identity(n):
    return [[mpf(int(i == j)) for j in range(n)] for i in range(n)]


def transposed(a):
    return [list(column) for column in zip(*a)]


def product(a, b):
    """A row of `a` may be empty: then the result has as many columns as `b`, which has no rows."""
    columns = transposed(b)
    return [[mp.fdot(row, column) for column in columns] for row in a]


def products(first, *others):
    for other in others:
        first = product(first, other)
    return first


def plus(a, b):
    return [[x + y for x, y in zip(r, s)] for r, s in zip(a, b)]


def minus(a, b):
    return [[x - y for x, y in zip(r, s)] for r, s in zip(a, b)]


def times(scalar, a):
    return [[scalar * value for value in row] for row in a]


def symmetrized(a):
    """a + a'"""
    return plus(a, transposed(a))


def stacked(blocks):
    """One matrix of a list of rows of blocks."""
    result = []
    for row in blocks:
        result.extend([sum(parts, []) for parts in zip(*row)])
    return result


def frobenius(a):
    return mpmath.sqrt(mp.fsum(value * value for row in a for value in row))


def norm_1(a):
    return max(mp.fsum(abs(value) for value in column) for column in transposed(a))


def solved(a, b):
    """x of a x = b, by elimination with row pivots.

    Raises ZeroDivisionError where `a` is singular.
    """
    n = len(a)
    rows = [list(a[i]) + list(b[i]) for i in range(n)]
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for i in range(k + 1, n):
            ratio = rows[i][k] / rows[k][k]
            if ratio != 0:
                rows[i] = [x - ratio * y for x, y in zip(rows[i], rows[k])]
    for k in reversed(range(n)):
        rows[k] = [value / rows[k][k] for value in rows[k]]
        for i in range(k):
            ratio = rows[i][k]
            if ratio != 0:
                rows[i] = [x - ratio * y for x, y in zip(rows[i], rows[k])]
    return [row[n:] for row in rows]


def inverse(a):
    return solved(a, identity(len(a)))


def null_space(c):
    """Columns that span what `c` maps to zero, by elimination with full pivots."""
    rows = [list(row) for row in c]
    n = len(rows[0])
    pivots = []
    for row in range(len(rows)):
        best = max(((abs(rows[i][j]), i, j) for i in range(row, len(rows)) for j in range(n)
                    if j not in pivots), default=(mpf(0), 0, 0))
        if best[0] == 0:
            break
        _, i, j = best
        rows[row], rows[i] = rows[i], rows[row]
        rows[row] = [value / rows[row][j] for value in rows[row]]
        for k in range(len(rows)):
            if k != row and rows[k][j] != 0:
                ratio = rows[k][j]
                rows[k] = [x - ratio * y for x, y in zip(rows[k], rows[row])]
        pivots.append(j)
    free = [j for j in range(n) if j not in pivots]
    columns = []
    for j in free:
        column = [mpf(0)] * n
        column[j] = mpf(1)
        for row, pivot in enumerate(pivots):
            column[pivot] = -rows[row][j]
        columns.append(column)
    return transposed(columns) if columns else [[] for _ in range(n)]


def balancing(a):
    """Powers of two d with which d_i⁻¹ a_ij d_j has rows and columns of like norms."""
    n = len(a)
    d = [mpf(1)] * n
    for _ in range(60):
        changed = False
        for i in range(n):
            row = mp.fsum(abs(a[i][j]) * d[j] for j in range(n) if j != i) / d[i]
            column = mp.fsum(abs(a[j][i]) / d[j] for j in range(n) if j != i) * d[i]
            if row == 0 or column == 0:
                continue
            factor = mpf(2) ** int(mpmath.nint(mpmath.log(row / column, 2) / 2))
            if factor != 1:
                d[i] *= factor
                changed = True
        if not changed:
            break
    return d


def exponential(a):
    """e^a, by balancing, scaling and squaring, and the Taylor series until its terms vanish."""
    n = len(a)
    if n == 0:
        return []
    d = balancing(a)
    b = [[a[i][j] * d[j] / d[i] for j in range(n)] for i in range(n)]
    norm = norm_1(b)
    squarings = max(0, int(mpmath.ceil(mpmath.log(norm, 2))) + 4) if norm > 0 else 0
    with mp.workdps(mp.dps + 10 + squarings):
        b = times(mpf(2) ** -squarings, b)
        result = identity(n)
        term = identity(n)
        k = 0
        while True:
            k += 1
            term = times(mpf(1) / k, product(term, b))
            result = plus(result, term)
            if norm_1(term) < mpf(10) ** -(mp.dps + 5):
                break
        for _ in range(squarings):
            result = product(result, result)
        result = [[result[i][j] * d[i] / d[j] for j in range(n)] for i in range(n)]
    return result


def pivots_and_factor(a):
    """The pivots of a = f f' after scaling to unit diagonal, and f.

    The list of pivots ends with the first that is not positive; then f is None. A diagonal entry
    that is not positive counts as a pivot.
    """
    n = len(a)
    worst = min((a[i][i] for i in range(n)), default=mpf(1))
    if worst <= 0:
        return [worst], None
    scale = [mpmath.sqrt(a[i][i]) for i in range(n)]
    factor = zeros(n, n)
    pivots = []
    for j in range(n):
        pivot = 1 - mp.fdot(factor[j][:j], factor[j][:j])
        pivots.append(pivot)
        if pivot <= 0:
            return pivots, None
        factor[j][j] = mpmath.sqrt(pivot)
        for i in range(j + 1, n):
            entry = (a[i][j] + a[j][i]) / 2 / scale[i] / scale[j]
            factor[i][j] = (entry - mp.fdot(factor[i][:j], factor[j][:j])) / factor[j][j]
    return pivots, [[scale[i] * factor[i][j] for j in range(n)] for i in range(n)]


def least_pivot(a):
    return min(pivots_and_factor(a)[0], default=mpf(1))
