"""Lyapunov functions e'P(τ)e, P affine between nodes of the time τ since the last sample of one sensor."""

from mpmath import mpf

from claim import Unreadable, numbers
from conditions import Fixed, Number, Statement
from high_precision import identity, minus, plus, product, stacked, symmetrized, times, transposed, zeros


def slopes(claim):
    """F of e' = F e, at each vertex of the nonlinearity; one, where the claim bounds it by chi."""
    return [plus(claim.A, vertex) for vertex in claim.vertices] or [claim.A]


def timer_dependent(claim, fields, reset, noise_of, nodes):
    """e' = F e + N w + G phi; at a sample e⁺ = reset e + noise η, noise a function of the node."""
    if claim.T1 == 0:
        raise Unreadable("samples one right after another")
    n, size = claim.states, len(fields[0])
    rate, level = claim.value("lambda_t"), claim.value("nu")
    is_lipschitz = claim.G is not None and not claim.vertices
    P = [claim.value(f"P/{node}") for node in range(len(nodes))]
    yield Statement("0 < T1 <= T2", bool(0 < claim.T1 <= claim.T2))
    yield Statement("nodes from 0 to T2, T1 among them", nodes == sorted(set(nodes)) and nodes[0] == 0
                    and nodes[-1] == claim.T2 and claim.T1 in nodes)
    yield Number("lambda_t >= 0", rate, may_be_zero=True)
    yield Number("nu > 0", level)
    for node, value in enumerate(P):
        yield Fixed(f"P/{node} > 0", value)

    def below(rows):
        return rows + zeros(size - n, len(rows[0]))

    def flow(node, change, F):
        first = plus(plus(symmetrized(product(P[node], F)), change), times(2 * rate, P[node]))
        inputs = []
        if claim.N is not None:
            inputs.append((below(claim.N), claim.value("gamma") ** 2))
        if claim.C_p is not None and claim.N is not None:
            wide = [row + [mpf(0)] * (size - n) for row in claim.C_p]
            first = plus(first, product(transposed(wide), wide))
        if is_lipschitz:
            chi = claim.value(f"chi/{node}")
            wide = [row + [mpf(0)] * (size - n) for row in claim.S]
            weight = chi * mpf(float(claim.lipschitz)) ** 2
            first = plus(first, times(weight, product(transposed(wide), wide)))
            inputs.append((below(claim.G), chi))
        rows = [[first]]
        for matrix, bound in inputs:
            column = product(P[node], matrix)
            rows[0].append(column)
            rows.append([transposed(column)] + [
                times(-bound, identity(len(matrix[0]))) if other is matrix else
                zeros(len(matrix[0]), len(other[0])) for other, _ in inputs])
        return times(mpf(-1), stacked(rows))

    for cell, (low, high) in enumerate(zip(nodes, nodes[1:])):
        change = times(1 / (high - low), minus(P[cell + 1], P[cell]))
        for node in (cell, cell + 1):
            if is_lipschitz:
                yield Number(f"chi/{node} > 0", claim.value(f"chi/{node}"))
            for F in fields:
                yield Fixed(f"flow of cell {cell} at node {node}", flow(node, change, F))
    for node, tau in enumerate(nodes):
        if tau < claim.T1:
            continue
        noise = noise_of(node)
        m = len(noise[0])
        kept = product(transposed(reset(node)), P[0])
        heard = product(transposed(noise), P[0])
        yield Fixed(f"sample at node {node}", stacked([
            [P[node], zeros(size, m), kept],
            [zeros(m, size), times(level, identity(m)), heard],
            [transposed(kept), transposed(heard), P[0]]]))


def nodes_of(claim, source, key):
    by_sensor = source.get(key)
    if not isinstance(by_sensor, dict) or len(by_sensor) != 1:
        raise Unreadable(f"{key} of one sensor were expected")
    [(sensor, nodes)] = by_sensor.items()
    levels = claim.values.get("nu")
    if not isinstance(levels, dict) or list(levels) != [sensor]:
        raise Unreadable(f"nu/{sensor} was expected")
    claim.values = dict(claim.values, nu=levels[sensor])
    return numbers([nodes])[0], sensor


def timer_dependent_constant_gain(claim):
    nodes, _ = nodes_of(claim, claim.values, "timer_nodes")
    L = claim.value("L")
    kept = minus(identity(claim.states), product(L, claim.C))
    yield from timer_dependent(claim, slopes(claim), lambda _: kept,
                               lambda _: times(mpf(-1), L), nodes)


def timer_dependent_scheduled_gain(claim):
    """Y/NODE = P/0 K/NODE is affine in between, and so is the gain's condition."""
    nodes, sensor = nodes_of(claim, claim.gains, "timers")

    def gain(node):
        return claim.value(f"K/{sensor}/{node}")

    yield from timer_dependent(
        claim, slopes(claim), lambda node: minus(identity(claim.states), product(gain(node), claim.C)),
        lambda node: times(mpf(-1), gain(node)), nodes)


def injected(claim, L, H):
    """e = (x - x_hat, theta)"""
    n, m = claim.states, len(claim.C)
    nodes, _ = nodes_of(claim, claim.values, "timer_nodes")
    fields = [stacked([[A, L], [zeros(m, n), H]]) for A in slopes(claim)]
    reset = stacked([[identity(n), zeros(n, m)], [claim.C, zeros(m, m)]])
    noise = zeros(n, m) + identity(m)
    yield from timer_dependent(claim, fields, lambda _: reset, lambda _: noise, nodes)


def timer_dependent_intersample_injection(claim):
    yield from injected(claim, times(mpf(-1), claim.value("L")), claim.value("H"))


def timer_dependent_sample_and_hold(claim):
    m = len(claim.C)
    yield from injected(claim, claim.value("L"), zeros(m, m))
