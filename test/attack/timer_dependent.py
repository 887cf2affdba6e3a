"""Lyapunov functions e'P(τ)e, P multi-affine between nodes of the times τ since the last events of each timer."""

import itertools
from dataclasses import dataclass

from mpmath import mpf

from claim import Unreadable, number, numbers
from conditions import Fixed, Number, Statement
from high_precision import (identity, inverse, minus, plus, product, products, stacked, symmetrized, times,
                            transposed, zeros)


@dataclass
class Resets:
    """What events of one timer do: e⁺ = (J - K C) e - K noise, K a function of the node before it."""
    name: str
    T1: object
    T2: object
    J: list
    C: list
    K: object
    Z: object = None  # of P K = C'Z, where the timer may be 0 at an event and K is not given


class Grid:
    """Nodes of several timers, numbered with the last timer changing fastest."""

    def __init__(self, nodes):
        self.nodes = nodes
        self.places = list(itertools.product(*(range(len(of_timer)) for of_timer in nodes)))
        self.number_of = {place: number for number, place in enumerate(self.places)}

    def time(self, node, timer):
        return self.nodes[timer][self.places[node][timer]]

    def after(self, node, timer):
        place = list(self.places[node])
        place[timer] = 0
        return self.number_of[tuple(place)]

    def cells(self):
        """Of each cell, its corners; of each corner the node and the two ends of its edges."""
        for lowest in itertools.product(*(range(len(of_timer) - 1) for of_timer in self.nodes)):
            corners = []
            for steps in itertools.product((0, 1), repeat=len(lowest)):
                place = [low + step for low, step in zip(lowest, steps)]
                edges = []
                for timer, low in enumerate(lowest):
                    ends = [tuple(place[:timer] + [at] + place[timer + 1:]) for at in (low, low + 1)]
                    length = self.nodes[timer][low + 1] - self.nodes[timer][low]
                    edges.append(tuple(self.number_of[end] for end in ends) + (length,))
                corners.append((self.number_of[tuple(place)], edges))
            yield corners


def slopes(claim):
    """F of e' = F e, at each vertex of the nonlinearity; one, where the claim bounds it by chi."""
    if claim.flows:
        return claim.flows
    return [plus(claim.A, vertex) for vertex in claim.vertices] or [claim.A]


def fall_at_once(name, resets, P, level, Z):
    """V does not grow by an event right after another one of its timer, with P K = C'Z."""
    C, m = resets.C, len(Z)
    Q = products(transposed(Z), C, inverse(P), transposed(C), Z)
    across = minus(Z, Q)
    return Fixed(name, stacked([[minus(symmetrized(Z), Q), across],
                                [transposed(across), minus(times(level, identity(m)), Q)]]))


def fall_of_measured(name, resets, X, level):
    """The same where V is X in what is measured, and else in what the gain K leaves as it is."""
    M = product(resets.C, resets.K(0))
    kept = minus(identity(len(M)), M)
    across = products(transposed(kept), X, M)
    return Fixed(name, stacked([
        [minus(X, products(transposed(kept), X, kept)), across],
        [transposed(across), minus(times(level, identity(len(M))), products(transposed(M), X, M))]]))


def fall(name, resets, P, P_after, K, level, part=1):
    """V just after the event is at most this part of V before, and what noise of that level adds."""
    m = len(resets.C)
    P = times(part, P)
    kept = product(transposed(minus(resets.J, product(K, resets.C)) if m else resets.J), P_after)
    if m == 0:
        return Fixed(name, stacked([[P, kept], [transposed(kept), P_after]]))
    heard = times(mpf(-1), product(transposed(K), P_after))
    return Fixed(name, stacked([[P, zeros(len(P), m), kept],
                                [zeros(m, len(P)), times(level, identity(m)), heard],
                                [transposed(kept), transposed(heard), P_after]]))


def matrices_of(claim, grid, timers):
    """P of each node; P/0 from its parts, where the only timer may be 0 at an event."""
    first = timers[0]
    has_parts = first.T1 == 0 and first.Z is None
    P = [None if has_parts and node == 0 else claim.value(f"P/{node}")
         for node in range(len(grid.places))]
    if has_parts:
        K, C = first.K(0), first.C
        rest = minus(identity(len(K)), products(K, inverse(product(C, K)), C))
        P[0] = plus(products(transposed(C), claim.value("P_measured"), C),
                    products(transposed(rest), claim.value("P_rest"), rest))
    return P


def flows(claim, fields, grid, P, mode=""):
    """V falls in each cell, at each of its corners."""
    n, size = claim.states, len(fields[0])
    rate = claim.value("lambda_t")
    is_lipschitz = claim.G is not None and not claim.vertices

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

    for cell, corners in enumerate(grid.cells()):
        for node, edges in corners:
            change = zeros(size, size)
            for low, high, length in edges:
                change = plus(change, times(1 / length, minus(P[high], P[low])))
            for F in fields:
                yield Fixed(f"flow of cell {cell} at node {node}{mode}", flow(node, change, F))


def numbers_of_flow(claim):
    """What flows() takes for granted: of gamma it sees the square only."""
    yield Number("lambda_t >= 0", claim.value("lambda_t"), may_be_zero=True)
    if claim.N is not None:
        yield Number("gamma > 0", claim.value("gamma"))


def timer_dependent(claim, fields, timers, nodes):
    """e' = F e + N w + G phi between events, and those of each timer."""
    size = len(fields[0])
    is_lipschitz = claim.G is not None and not claim.vertices
    part = mpf(1)
    if "mu" in claim.values:
        part = claim.value("mu")
        yield Number("mu > 0", part)
        yield Number("mu < 1", 1 - part)
        yield Statement("mu is of one timer with T1 > 0", len(timers) == 1 and bool(timers[0].T1 > 0))
    yield from numbers_of_flow(claim)
    for timer, of_timer in zip(timers, nodes):
        may_coincide = of_timer[0] == timer.T1 == 0 and timer.J == identity(size)
        may_coincide = may_coincide and (len(timers) == 1 or timer.Z is not None)
        has_times = bool((timer.T1 > 0 or may_coincide) and timer.T1 <= timer.T2 and timer.T2 > 0)
        yield Statement(f"{timer.name}: 0 < T1 <= T2, or 0 = T1", has_times)
        if not has_times:
            return  # what follows is about such times
        yield Statement(f"{timer.name}: nodes from 0 to T2, T1 among them",
                        of_timer == sorted(set(of_timer)) and of_timer[0] == 0
                        and of_timer[-1] == timer.T2 and timer.T1 in of_timer)
        if timer.C:
            yield Number(f"nu/{timer.name} > 0", claim.value(f"nu/{timer.name}"))
    grid = Grid(nodes)
    P = matrices_of(claim, grid, timers)
    for node, value in enumerate(P):
        yield Fixed(f"P/{node} > 0", value)
        if is_lipschitz:
            yield Number(f"chi/{node} > 0", claim.value(f"chi/{node}"))

    yield from flows(claim, fields, grid, P)
    for index, timer in enumerate(timers):
        level = claim.value(f"nu/{timer.name}") if timer.C else None
        for node, value in enumerate(P):
            tau = grid.time(node, index)
            name = f"event of {timer.name} at node {node}"
            if tau < timer.T1:
                continue
            if tau > 0:
                K = timer.K(node) if timer.C else None
                yield fall(name, timer, value, P[grid.after(node, index)], K, level, part)
            elif timer.Z is not None:
                yield fall_at_once(name, timer, value, level, timer.Z(node))
            else:
                yield fall_of_measured(name, timer, claim.value("P_measured"), level)


def timer_dependent_sum(claim, fields, timers, nodes):
    """The same with P(tau) = P_constant + sum of P_i(tau_i), in parts that each see the nodes of one timer."""
    size = len(fields[0])
    rate = claim.value("lambda_t")
    is_lipschitz = claim.G is not None and not claim.vertices
    yield from numbers_of_flow(claim)
    yield Statement("several timers", len(timers) > 1)
    constant = claim.value("P_constant")
    yield Fixed("P_constant > 0", constant)
    P = {}
    for timer, of_timer in zip(timers, nodes):
        yield Statement(f"{timer.name}: 0 < T1 <= T2, nodes from 0 to T2, T1 among them", bool(
            0 < timer.T1 <= timer.T2 and of_timer == sorted(set(of_timer)) and of_timer[0] == 0
            and of_timer[-1] == timer.T2 and timer.T1 in of_timer))
        yield Number(f"nu/{timer.name} > 0", claim.value(f"nu/{timer.name}"))
        P[timer.name] = [claim.value(f"P/{timer.name}/{node}") for node in range(len(of_timer))]
        for node, value in enumerate(P[timer.name]):
            yield Fixed(f"P/{timer.name}/{node} > 0", value)

    def below(rows):
        return rows + zeros(size - claim.states, len(rows[0]))

    def beside(rows):
        return [row + [mpf(0)] * (size - claim.states) for row in rows]

    inputs = []
    if is_lipschitz:
        inputs.append(("G", below(claim.G)))
    if claim.N is not None:
        inputs.append(("N", below(claim.N)))

    def form(matrix, F, first, levels):
        """(e, phi, w) of what a summand of P has of the flow."""
        first = plus(plus(symmetrized(product(matrix, F)), times(2 * rate, matrix)), first)
        rows = [[first]]
        for name, columns in inputs:
            across = product(matrix, columns)
            rows[0].append(across)
            rows.append([transposed(across)] + [
                times(levels.get(name, mpf(0)), identity(len(columns[0]))) if other is columns
                else zeros(len(columns[0]), len(other[0])) for _, other in inputs])
        return stacked(rows)

    for number, F in enumerate(fields):
        suffix = f"/{number}" if len(fields) > 1 else ""
        output = zeros(size, size)
        if claim.C_p is not None and claim.N is not None:
            output = product(transposed(beside(claim.C_p)), beside(claim.C_p))
        levels = {"N": -claim.value("gamma") ** 2} if claim.N is not None else {}
        whole = form(constant, F, output, levels)
        for timer, of_timer in zip(timers, nodes):
            part = claim.value(f"flow_part/{timer.name}{suffix}")
            whole = plus(whole, part)
            for low in range(len(of_timer) - 1):
                ends = P[timer.name][low:low + 2]
                slope = times(1 / (of_timer[low + 1] - of_timer[low]), minus(ends[1], ends[0]))
                for node, value in zip((low, low + 1), ends):
                    first, own = slope, {}
                    if is_lipschitz:
                        chi = claim.value(f"chi/{timer.name}/{node}")
                        weight = chi * mpf(float(claim.lipschitz)) ** 2
                        first = plus(first, times(weight, product(transposed(beside(claim.S)), beside(claim.S))))
                        own = {"G": -chi}
                    yield Fixed(f"flow of {timer.name} in cell {low} at node {node}{suffix}",
                                minus(part, form(value, F, first, own)))
        yield Fixed(f"flow{suffix}", times(mpf(-1), whole))
    for timer, of_timer in zip(timers, nodes):
        if is_lipschitz:
            for node in range(len(of_timer)):
                yield Number(f"chi/{timer.name}/{node} > 0", claim.value(f"chi/{timer.name}/{node}"))
    yield from falls_of_sum(claim, timers, nodes, constant, P)


def falls_of_sum(claim, timers, nodes, constant, P):
    """V does not grow at samples but by noise, whatever the other timers are."""
    for timer, of_timer in zip(timers, nodes):
        K, C = timer.K(0), timer.C
        m, size = len(C), len(constant)
        heard = [row + [mpf(int(i == j)) for j in range(m)] for i, row in enumerate(C)]  # C e + noise

        def gained(matrix):
            """2 (C e + noise)' K' matrix e"""
            across = product(matrix, K)
            return stacked([[symmetrized(product(across, C)), across], [transposed(across), zeros(m, m)]])

        most = plus(constant, P[timer.name][0])
        parts = gained(most)
        for other in timers:
            if other is timer:
                continue
            most_of_other = claim.value(f"P_most/{other.name}")
            most = plus(most, most_of_other)
            part = claim.value(f"jump_part/{timer.name}/{other.name}")
            parts = plus(parts, part)
            for node, value in enumerate(P[other.name]):
                yield Fixed(f"P/{other.name}/{node} < P_most", minus(most_of_other, value))
                yield Fixed(f"part of {other.name} at node {node} in the jump of {timer.name}",
                            minus(gained(value), part))
        lost = products(transposed(heard), transposed(K), most, K, heard)
        noise = [[mpf(0)] * size + [claim.value(f"nu/{timer.name}") * int(i == j) for j in range(m)]
                 for i in range(m)]
        for node, value in enumerate(P[timer.name]):
            if of_timer[node] < timer.T1:
                continue
            fallen = stacked([[minus(value, P[timer.name][0]), zeros(size, m)]]) + noise
            yield Fixed(f"jump of {timer.name} at node {node}", minus(plus(fallen, parts), lost))


def nodes_of(source, key, names):
    by_name = source.get(key)
    if not isinstance(by_name, dict) or sorted(by_name) != sorted(names):
        raise Unreadable(f"{key} of {', '.join(names)} were expected")
    return [numbers([by_name[name]])[0] for name in names]


def times_of(claim, name):
    if len(claim.sampled) < 2:
        return claim.T1, claim.T2
    of_sensor = claim.values["sensors"][name]
    return number(of_sensor["T1"]), number(of_sensor["T2"])


def of_sensor(claim, symbol, name):
    return claim.value(symbol if len(claim.sampled) == 1 else f"{symbol}/{name}")


def names_of(claim):
    return [name for name, _ in claim.sampled]


def corrected_by_constants(claim):
    timers = []
    for name, C in claim.sampled:
        L = of_sensor(claim, "L", name)
        timers.append(Resets(name, *times_of(claim, name), identity(claim.states), C,
                             lambda _, L=L: L))
    return claim, slopes(claim), timers, nodes_of(claim.values, "timer_nodes", names_of(claim))


def timer_dependent_constant_gain(claim):
    yield from timer_dependent(*corrected_by_constants(claim))


def timer_dependent_sum_constant_gain(claim):
    yield from timer_dependent_sum(*corrected_by_constants(claim))


def timer_dependent_scheduled_gain(claim):
    """The sums of P/NODE K/NODE, P just after the event, are affine in between, as is the condition of the gain."""
    nodes = nodes_of(claim.gains, "timers", names_of(claim))
    yield Statement("the gains' nodes are the proof's",
                    nodes == nodes_of(claim.values, "timer_nodes", names_of(claim)))
    timers = []
    for name, C in claim.sampled:
        T1, T2 = times_of(claim, name)
        Z = None if T1 > 0 else lambda node, name=name: claim.value(f"Z/{name}/{node}")
        timers.append(Resets(name, T1, T2, identity(claim.states), C,
                             lambda node, name=name: claim.value(f"K/{name}/{node}"), Z))
    yield from timer_dependent(claim, slopes(claim), timers, nodes)


def injected(claim, sign, has_H):
    """e = (x - x_hat, theta of each sensor): x_hat' = f + sign L theta"""
    n = claim.states
    rows = [len(C) for _, C in claim.sampled]
    m, size = sum(rows), n + sum(rows)
    L, H, timers = zeros(n, 0), zeros(m, m), []
    first = 0
    for (name, C), count in zip(claim.sampled, rows):
        gain = times(mpf(-sign), of_sensor(claim, "L", name))
        L = [left + right for left, right in zip(L, gain)]
        if has_H:
            for i, row in enumerate(of_sensor(claim, "H", name)):
                H[first + i][first:first + count] = row
        # theta⁺ = C e + noise
        wide = [row + [mpf(0)] * m for row in C]
        K = zeros(size, count)
        for i in range(count):
            wide[i][n + first + i] = mpf(-1)
            K[n + first + i][i] = mpf(-1)
        timers.append(Resets(name, *times_of(claim, name), identity(size), wide, lambda _, K=K: K))
        first += count
    fields = [stacked([[A, L], [zeros(m, n), H]]) for A in slopes(claim)]
    return claim, fields, timers, nodes_of(claim.values, "timer_nodes", names_of(claim))


def timer_dependent_intersample_injection(claim):
    yield from timer_dependent(*injected(claim, 1, True))


def timer_dependent_sample_and_hold(claim):
    yield from timer_dependent(*injected(claim, -1, False))


def timer_dependent_sum_intersample_injection(claim):
    yield from timer_dependent_sum(*injected(claim, 1, True))


def timer_dependent_sum_sample_and_hold(claim):
    yield from timer_dependent_sum(*injected(claim, -1, False))


def timer_dependent_synchronized(claim):
    """The timer is the time since the last jump of the plant."""
    if claim.A_d is None:
        raise Unreadable("the jump map is not given by a matrix")
    fields = slopes(claim)
    if claim.C_c:
        fields = [minus(F, product(claim.value("L_c"), claim.C_c)) for F in fields]
    timer = Resets("jumps", claim.T1, claim.T2, claim.A_d, claim.C_d, lambda _: claim.value("L_d"))
    yield Statement("T1 > 0", bool(claim.T1 > 0))
    yield from timer_dependent(claim, fields, [timer],
                               nodes_of(claim.values, "timer_nodes", ["jumps"]))


def timer_dependent_switched(claim):
    """P of each mode; a switch leads into any other one."""
    nodes = nodes_of(claim.values, "timer_nodes", ["jumps"])
    grid = Grid(nodes)
    yield from numbers_of_flow(claim)
    yield Statement("0 < T1 <= T2, nodes from 0 to T2, T1 among them", bool(
        0 < claim.T1 <= claim.T2 and nodes[0] == sorted(set(nodes[0])) and nodes[0][0] == 0
        and nodes[0][-1] == claim.T2 and claim.T1 in nodes[0]))
    level = claim.value("nu/jumps") if claim.C_d else None
    if claim.C_d:
        yield Number("nu/jumps > 0", level)
    P = {mode.label: [claim.value(f"P/{mode.label}/{node}") for node in range(len(nodes[0]))]
         for mode in claim.modes}
    for mode in claim.modes:
        F, K = mode.A, None
        if claim.C_c:
            F = minus(F, product(claim.value(f"L_c/{mode.label}"), claim.C_c))
        if claim.C_d:
            K = claim.value(f"L_d/{mode.label}")
        own = P[mode.label]
        for node, value in enumerate(own):
            yield Fixed(f"P/{mode.label}/{node} > 0", value)
        yield from flows(claim, [F], grid, own, f" in mode {mode.label}")
        J = identity(claim.states) if mode.A_d is None else mode.A_d
        resets = Resets("jumps", claim.T1, claim.T2, J, claim.C_d, None)
        for after in claim.modes:
            if after is mode:
                continue
            for node, value in enumerate(own):
                if nodes[0][node] >= claim.T1:
                    yield fall(f"switch from {mode.label} to {after.label} at node {node}", resets, value,
                               P[after.label][0], K, level)
