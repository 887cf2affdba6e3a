"""What each theorem demands, as the papers have it, with their errors mended."""

import mpmath
from mpmath import mpf

from claim import Unreadable
from conditions import Contracts, Fixed, Number, OverTimes, Statement
from formulas import lipschitz_constant_is_refuted, vertices_are_refuted
from high_precision import (exponential, identity, inverse, minus, null_space, pivots_and_factor, plus,
                            product, products, solved, stacked, symmetrized, times, transposed, zeros)
from timer_dependent import (timer_dependent_constant_gain, timer_dependent_intersample_injection,
                             timer_dependent_sample_and_hold, timer_dependent_scheduled_gain,
                             timer_dependent_sum_constant_gain, timer_dependent_sum_intersample_injection,
                             timer_dependent_sum_sample_and_hold, timer_dependent_switched,
                             timer_dependent_synchronized)


def root_of(P):
    """Z with Z' Z = P; nothing where P is not positive definite, which another condition says."""
    factor = pivots_and_factor(P)[1]
    return transposed(factor) if factor else None


def between(low, high, count=7):
    """Times for a look at the error itself."""
    low = max(low, high / 1000)
    return [low + (high - low) * k / (count - 1) for k in range(count)]


def times_are_valid(claim, T1_may_be_zero=False):
    sampling = claim.T1 > 0 or (T1_may_be_zero and claim.T1 == 0)
    return Statement("0 < T1 <= T2", bool(sampling and claim.T1 <= claim.T2 and claim.T2 > 0))


def at_times(claim, name, sign, Z, B, Y, X):
    return OverTimes(name, sign, Z, B, Y, X, claim.T1, claim.T2)


# ferrante2016


def ferrante2016_theorem1(claim):
    """(12) for A + decay I: e^{decay t} times the error falls from sample to sample."""
    n = claim.states
    P, L, decay = claim.value("P"), claim.value("L"), claim.value("decay")
    kept = minus(identity(n), product(L, claim.C))
    yield times_are_valid(claim)
    yield Number("decay >= 0", decay, may_be_zero=True)
    yield Fixed("P > 0", P)
    Z = root_of(P)
    if Z is None:
        return
    B = plus(claim.A, times(decay, identity(n)))
    yield at_times(claim, "(I - LC)' e^{A'tau} P e^{A tau} (I - LC) < P, (12)", -1, Z, B, kept, P)
    yield Contracts("the error at constant times", claim.A, kept,
                    lambda tau: mpmath.exp(-decay * tau), between(claim.T1, claim.T2))


# ferrante2019


def ferrante2019(claim, rate, N, C_p):
    """V = e'P1 e + e^{delta tau} t'P2 t along the flow, t = C e - theta, tau running down from T2."""
    n, m = claim.states, len(claim.C)
    A, C, L, H = claim.A, claim.C, claim.value("L"), claim.value("H")
    P1, P2, delta = claim.value("P1"), claim.value("P2"), claim.value("delta")
    yield times_are_valid(claim, T1_may_be_zero=True)
    yield Number("delta > 0", delta)
    yield Fixed("P1 > 0", P1)
    yield Fixed("P2 > 0", P2)
    CL = product(C, L)
    # e' = (A - LC) e + L t + N w, t' = C e' - H theta with theta = C e - t
    flow = stacked([[minus(A, product(L, C)), L],
                    [minus(product(C, A), product(plus(CL, H), C)), plus(CL, H)]])
    inputs = []
    if N is not None:
        gamma = claim.value("gamma")
        yield Number("gamma > 0", gamma)
        inputs.append((N, gamma ** 2))
    if claim.G is not None:
        chi = claim.value("chi")
        yield Number("chi > 0", chi)
        inputs.append((claim.G, chi))
    for name, tau in (("M(0) <= 0", mpf(0)), ("M(T2) <= 0", claim.T2)):
        e = mpmath.exp(delta * tau)
        V = stacked([[P1, zeros(n, m)], [zeros(m, n), times(e, P2)]])
        in_e = times(2 * rate, P1)
        if C_p is not None and N is not None:
            in_e = plus(in_e, product(transposed(C_p), C_p))
        if claim.G is not None:
            weight = claim.value("chi") * mpf(float(claim.lipschitz)) ** 2
            in_e = plus(in_e, times(weight, product(transposed(claim.S), claim.S)))
        grows = stacked([[in_e, zeros(n, m)],
                         [zeros(m, n), times((2 * rate - delta) * e, P2)]])
        rows = [[plus(symmetrized(product(V, flow)), grows)]]
        for matrix, level in inputs:
            column = product(V, stacked([[matrix], [product(C, matrix)]]))
            rows[0].append(column)
            rows.append([transposed(column)] + [
                times(-level if other is matrix else mpf(0),
                      identity(len(matrix[0])) if other is matrix else
                      zeros(len(matrix[0]), len(other[0]))) for other, _ in inputs])
        yield Fixed(name, times(mpf(-1), stacked(rows)))
    if claim.G is None:
        yield Contracts("the error at constant times",
                        stacked([[A, times(mpf(-1), L)], [zeros(m, n), H]]),
                        stacked([[identity(n), zeros(n, m)], [C, zeros(m, m)]]),
                        lambda tau: mpmath.exp(-rate * tau), between(claim.T1, claim.T2))


def ferrante2019_theorem2(claim):
    """(28)"""
    rate = claim.value("lambda_t")
    yield Number("lambda_t > 0", rate)
    yield from ferrante2019(claim, rate, claim.N, claim.C_p)


def ferrante2019_corollary1(claim):
    """(32): of the rate only."""
    rate = claim.value("lambda_t")
    yield Number("lambda_t > 0", rate)
    yield from ferrante2019(claim, rate, None, None)


def ferrante2019_corollary2(claim):
    """(33): of the gain only."""
    yield from ferrante2019(claim, mpf(0), claim.N, claim.C_p)


# sferlazza2019


def gain_of(claim, P, share, tau):
    """(36), with lambda = 0 (25): what is unseen orthogonal, in the norm of before, to the error."""
    C, n = claim.C, claim.states
    unseen = null_space(C)
    back = exponential(times(-tau, claim.A))
    before = products(transposed(back), P, back)
    W = inverse(products(transposed(unseen), before, unseen))
    mixed = products(transposed(unseen), before, transposed(C))
    K = minus(transposed(C), products(unseen, W, mixed))
    if share != 0:
        M11 = minus(products(C, before, transposed(C)), products(transposed(mixed), W, mixed))
        to_unseen = product(transposed(unseen), P)
        M22 = minus(P, products(transposed(to_unseen), W, to_unseen))
        R11, R22 = root_of(M11), root_of(M22)
        if R11 is None or R22 is None:
            return None
        tall = R11 + zeros(n - len(C), len(C))
        K = minus(K, solved(P, times(share, product(transposed(R22), tall))))
    return product(K, inverse(product(C, transposed(C))))


def sferlazza2019(claim, decay):
    """(21) for A + decay I, without its last block, which P > 0 leaves out."""
    P, share = claim.value("P"), claim.value("lambda")
    n = claim.states
    yield times_are_valid(claim)
    yield Number("decay >= 0", decay, may_be_zero=True)
    yield Number("lambda >= 0", share, may_be_zero=True)
    yield Number("lambda e^{decay T2} < 1", 1 - share * mpmath.exp(decay * claim.T2))
    yield Fixed("P > 0", P)
    Z = root_of(P)
    unseen = null_space(claim.C)
    yield Statement("outputs don't depend on each other", len(unseen[0]) == n - len(claim.C))
    if Z is None or not unseen[0]:
        return
    yield at_times(claim, "what is unseen was larger a time tau before, (21)", 1, Z,
                   times(mpf(-1), plus(claim.A, times(decay, identity(n)))), unseen,
                   products(transposed(unseen), P, unseen))
    for tau in between(claim.T1, claim.T2, 5 if share == 0 else 17):
        K = gain_of(claim, P, share, tau)
        yield Statement(f"there is a gain at {mpmath.nstr(tau, 6)} s", K is not None)
        if K is None:
            continue
        kept = minus(identity(n), product(K, claim.C))
        step = products(kept, exponential(times(tau, claim.A)))
        before = times(mpmath.exp(-2 * decay * tau) * (1 + mpf(10) ** -20), P)
        yield Fixed(f"V does not grow in {mpmath.nstr(tau, 6)} s",
                    minus(before, products(transposed(step), P, step)))
        yield Contracts("the error at constant times", claim.A, kept,
                        lambda tau: mpmath.exp(-decay * tau), [tau])


def sferlazza2019_theorem2(claim):
    yield from sferlazza2019(claim, mpf(0))


def sferlazza2019_theorem2_rate(claim):
    yield from sferlazza2019(claim, claim.value("decay"))


def sferlazza2019_theorem2_norm(claim):
    """The theorem, and a matrix in whose norm the error is followed: any that is positive definite."""
    yield Fixed("Q > 0", claim.value("Q"))
    yield from sferlazza2019(claim, mpf(0))


def sferlazza2019_equation17(claim):
    """(17): each sample keeps the part lambda of the error, whatever P."""
    share = claim.value("lambda")
    yield times_are_valid(claim)
    yield Number("lambda >= 0", share, may_be_zero=True)
    yield Number("lambda < 1", 1 - share)
    yield Statement("no P", "P" not in claim.gains)
    yield Statement("C is square", len(claim.C) == claim.states)
    yield Fixed("C is invertible", product(claim.C, transposed(claim.C)))


# etienne2019


def etienne2019(claim, slacks, inputs):
    """(12)-(16) with (z, z', w = z(t_k) - z, inputs), for each vertex and both ends of e^{-alpha t}."""
    n = claim.states
    P, X, Y = claim.value("P"), claim.value("X"), claim.value("Y")
    alpha, LC = claim.value("alpha"), product(claim.value("L"), claim.C)
    yield times_are_valid(claim, T1_may_be_zero=True)
    yield Number("alpha > 0", alpha)
    yield Fixed("P > 0", P)
    yield Fixed("X > 0", X)
    yield Fixed("Y > 0", Y)
    if claim.G is not None and not claim.vertices:
        raise Unreadable("plant/vertices are missing")
    vertices = [plus(claim.A, vertex) for vertex in claim.vertices] or [claim.A]
    stretch = (2 * claim.T2 / mpmath.pi) ** 2
    for number, R in enumerate(vertices, 1):
        for end, rho in (("1", mpf(1)), ("e^{-alpha T2}", mpmath.exp(-alpha * claim.T2))):
            widths = [n, n, n] + [len(matrix[0]) for matrix, _ in inputs]
            grid = [[zeros(a, b) for b in widths] for a in widths]
            grid[0][0] = times(alpha, P)
            grid[0][1] = grid[1][0] = P
            grid[1][1] = times(rho * stretch, X)
            grid[1][2] = grid[2][1] = times(-rho, Y)
            grid[2][2] = times(-rho, X)
            for index, (matrix, level) in enumerate(inputs, 3):
                grid[index][index] = times(-level, identity(len(matrix[0])))
            equation = stacked([[plus(R, LC), times(mpf(-1), identity(n)), LC]
                                + [matrix for matrix, _ in inputs]])
            total = plus(stacked(grid), symmetrized(product(transposed(slacks), equation)))
            yield Fixed(f"(13) at vertex {number}, rho = {end}", times(mpf(-1), total))
    for number, R in enumerate(vertices, 1):
        held = stacked([[R, LC], [zeros(n, n), zeros(n, n)]])
        again = stacked([[identity(n), zeros(n, n)], [identity(n), zeros(n, n)]])
        yield Contracts(f"the error at constant times, vertex {number}", held, again,
                        lambda tau: mpmath.exp(-alpha / 2 * tau), between(claim.T1, claim.T2))


def etienne2019_proposition1(claim):
    n = claim.states
    G = claim.value("G")
    yield from etienne2019(claim, stacked([[G, G, zeros(n, n)]]), [])


def etienne2019_theorem1(claim):
    G = stacked([[claim.value(f"G_{k}") for k in (1, 2, 3)]])
    yield from etienne2019(claim, G, [])


def etienne2019_proposition2(claim):
    n = claim.states
    G = stacked([[claim.value(f"G_{k}") for k in (1, 2, 3, 4)]])
    gamma = claim.value("gamma")
    yield Number("gamma > 0", gamma)
    yield Fixed("P > I", minus(claim.value("P"), identity(n)))
    yield from etienne2019(claim, G, [(identity(n), gamma ** 2)])


def etienne2019_proposition2_channels(claim):
    """Proposition 2 with the noise through L and the disturbance through N, for their sizes."""
    n = claim.states
    gamma, noise = claim.value("gamma"), claim.value("noise_size")
    yield Number("gamma > 0", gamma)
    yield Number("noise_size > 0", noise)
    slacks = [claim.value(f"G_{k}") for k in (1, 2, 3, 4)]
    inputs = [(times(noise, claim.value("L")), gamma ** 2)]
    if claim.N is not None:
        disturbance = claim.value("disturbance_size")
        yield Number("disturbance_size > 0", disturbance)
        slacks.append(claim.value("G_5"))
        inputs.append((times(disturbance, claim.N), gamma ** 2))
    yield Fixed("P > I", minus(claim.value("P"), identity(n)))
    yield from etienne2019(claim, stacked([slacks]), inputs)


# bernard2022


def jump_of(mode, n):
    return mode.A_d if mode.A_d is not None else identity(n)


def lyapunov_rates(claim, decays):
    """a_c and a_d of theorem 3.1, V' <= a_c V and V⁺ <= e^{a_d} V, as they follow from the claim.

    At times between jumps, a_c tau + a_d <= -2 jump_decay. With a dwell time, N jumps in t make of V
    e^{a_c t + a_d N}: at most t/tau + N0 of them, or at least t/tau - N0, so that a_c + a_d / tau
    must be -2 decay.
    """
    rate = claim.value("flow_decay" if decays else "flow_growth")
    a_c = -rate if decays else rate
    if not claim.has_dwell_time:
        return a_c, -a_c * (claim.T1 if decays else claim.T2) - 2 * claim.value("jump_decay")
    key = "average_dwell_time" if decays else "reverse_average_dwell_time"
    return a_c, (-a_c - 2 * claim.value("decay")) * claim.value(key + "/tau")


def lyapunov_domains(claim, decays):
    yield times_are_valid(claim, T1_may_be_zero=True)
    yield Number("flow_decay > 0" if decays else "flow_growth > 0",
                 claim.value("flow_decay" if decays else "flow_growth"))
    if not claim.has_dwell_time:
        yield Number("jump_decay > 0", claim.value("jump_decay"))
        return
    key = "average_dwell_time" if decays else "reverse_average_dwell_time"
    yield Number("decay > 0", claim.value("decay"))
    yield Number("tau > 0", claim.value(key + "/tau"))
    yield Number("N0 >= 1", claim.value(key + "/N0") - 1, may_be_zero=True)
    if decays:
        yield Number("a_d >= 0", lyapunov_rates(claim, decays)[1], may_be_zero=True)


def lyapunov(claim, flow, reset, decays):
    """Theorem 3.1 for V = e'Pe."""
    P = claim.value("P")
    a_c, a_d = lyapunov_rates(claim, decays)
    yield from lyapunov_domains(claim, decays)
    yield Fixed("P > 0", P)
    yield Fixed("flow", minus(times(a_c, P), symmetrized(product(P, flow))))
    yield Fixed("jump", minus(times(mpmath.exp(a_d), P), products(transposed(reset), P, reset)))
    if claim.has_dwell_time:
        key = "average_dwell_time" if decays else "reverse_average_dwell_time"
        tau, decay = claim.value(key + "/tau"), claim.value("decay")
        yield Contracts("the error at the dwell time", flow, reset,
                        lambda tau: mpmath.exp(-decay * tau), [tau])
        return
    high = 10 * claim.T1 if decays else claim.T2
    if mpmath.isfinite(claim.T2):
        high = max(high, claim.T2)
    if high == 0:
        high = 1 / claim.value("flow_decay")
    jump_decay = claim.value("jump_decay")
    yield Contracts("the error at constant times", flow, reset,
                    lambda tau: mpmath.exp(-jump_decay), between(claim.T1, high))


def bernard2022_equation14(claim):
    flow = minus(claim.A, product(claim.value("L_c"), claim.C_c))
    reset = minus(claim.A_d, product(claim.value("L_d"), claim.C_d))
    yield from lyapunov(claim, flow, reset, decays=True)


def bernard2022_equation22(claim):
    flow = minus(claim.A, product(claim.value("L_c"), claim.C_c))
    yield from lyapunov(claim, flow, claim.A_d, decays=True)


def bernard2022_equation26(claim):
    reset = minus(claim.A_d, product(claim.value("L_d"), claim.C_d))
    yield from lyapunov(claim, claim.A, reset, decays=False)


def bernard2022_equation14_average_dwell_time(claim):
    yield from bernard2022_equation14(claim)


def bernard2022_equation22_average_dwell_time(claim):
    yield from bernard2022_equation22(claim)


def bernard2022_equation26_reverse_average_dwell_time(claim):
    yield from bernard2022_equation26(claim)


def high_gain_flow(claim):
    """A - L_c H with the gain that gives it the eigenvalues ell times those of K (Ackermann)."""
    n = claim.states
    K, ell = claim.gains["K"], claim.value("ell")
    K = claim.value("K")[0] if isinstance(K[0], list) else [mpf(float(value)) for value in K]
    rows = [claim.C_c[0]]
    for _ in range(n - 1):
        rows.append(product([rows[-1]], claim.A)[0])
    value, power = zeros(n, n), identity(n)  # of s^n + K_n ell s^(n-1) + ... + K_1 ell^n at A
    for k in range(n):
        value = plus(value, times(K[k] * ell ** (n - k), power))
        power = product(power, claim.A)
    value = plus(value, power)
    last = [[mpf(int(i == n - 1))] for i in range(n)]
    L_c = product(value, solved(rows, last))
    return minus(claim.A, product(L_c, claim.C_c))


def bernard2022_example4_2(claim):
    """(22) with a high gain."""
    yield Number("ell > 0", claim.value("ell"))
    yield from lyapunov(claim, high_gain_flow(claim), claim.A_d, decays=True)


def bernard2022_example4_2_average_dwell_time(claim):
    yield from bernard2022_example4_2(claim)


def bernard2022_corollary4_1(claim):
    """The same for every jump map with a Lipschitz constant: P <= p I and k^2 p I <= e^{a_d} P."""
    P, largest = claim.value("P"), claim.value("P_largest")
    a_c, a_d = lyapunov_rates(claim, True)
    flow = high_gain_flow(claim)
    one = identity(claim.states)
    yield Number("ell > 0", claim.value("ell"))
    yield from lyapunov_domains(claim, True)
    yield Fixed("P > 0", P)
    yield Fixed("flow", minus(times(a_c, P), symmetrized(product(P, flow))))
    yield Number("P_largest > 0", largest)
    yield Fixed("largest eigenvalue of P", minus(times(largest, one), P))
    yield Fixed("jump", minus(times(mpmath.exp(a_d), P),
                              times(claim.jump_lipschitz ** 2 * largest, one)))


def bernard2022_corollary4_1_average_dwell_time(claim):
    yield from bernard2022_corollary4_1(claim)


def bernard2022_corollary5_2(claim):
    """(32), by the factor e^{-2 jump_decay}."""
    P, jump_decay = claim.value("P"), claim.value("jump_decay")
    yield times_are_valid(claim, T1_may_be_zero=True)
    yield Number("jump_decay > 0", jump_decay)
    yield Fixed("P > 0", P)
    Z = root_of(P)
    if Z is None:
        return
    reset = minus(claim.A_d, product(claim.value("L_d"), claim.C_d))
    yield at_times(claim, "V falls from jump to jump, (32)", -1, product(Z, reset), claim.A,
                   identity(claim.states), times(mpmath.exp(-2 * jump_decay), P))
    yield Contracts("the error at constant times", claim.A, reset,
                    lambda tau: mpmath.exp(-jump_decay), between(claim.T1, claim.T2))


def rates_of_modes(claim, decays):
    """(47b) in each mode, (49) between all of them."""
    n = claim.states
    a_c, a_d = lyapunov_rates(claim, decays)
    yield from lyapunov_domains(claim, decays)
    kept = mpmath.exp(a_d)
    for mode in claim.modes:
        P = claim.value(f"P/{mode.label}")
        flow, jump = mode.A, jump_of(mode, n)
        if decays:
            flow = minus(flow, product(claim.value(f"L_c/{mode.label}"), claim.C_c))
        else:
            jump = minus(jump, product(claim.value(f"L_d/{mode.label}"), claim.C_d))
        yield Fixed(f"P > 0 in mode {mode.label}", P)
        yield Fixed(f"flow in mode {mode.label}",
                    minus(times(a_c, P), symmetrized(product(P, flow))))
        for other in claim.modes:
            after = products(transposed(jump), claim.value(f"P/{other.label}"), jump)
            yield Fixed(f"switch from {mode.label} to {other.label}", minus(times(kept, P), after))


def bernard2022_example7_1(claim):
    yield from rates_of_modes(claim, decays=True)


def bernard2022_example7_1_average_dwell_time(claim):
    yield from rates_of_modes(claim, decays=True)


def bernard2022_equation49_reverse_average_dwell_time(claim):
    yield from rates_of_modes(claim, decays=False)


def bernard2022_section7_3_2(claim):
    """(52) with a constant gain for each mode, between modes that differ."""
    n = claim.states
    jump_decay = claim.value("jump_decay")
    yield times_are_valid(claim, T1_may_be_zero=True)
    yield Number("jump_decay > 0", jump_decay)
    for mode in claim.modes:
        P = claim.value(f"P/{mode.label}")
        yield Fixed(f"P > 0 in mode {mode.label}", P)
        reset = minus(jump_of(mode, n), product(claim.value(f"L_d/{mode.label}"), claim.C_d))
        for other in claim.modes:
            Z = root_of(claim.value(f"P/{other.label}"))
            if other is mode or Z is None:
                continue
            yield at_times(claim, f"cycle from {mode.label} to {other.label}", -1,
                           product(Z, reset), mode.A, identity(n),
                           times(mpmath.exp(-2 * jump_decay), P))


def metrics(claim, metric_of, next_modes):
    """Before a jump V is e'Psi e, Psi = e^{-A'tau} P e^{-A tau}; the gain leaves A_d of what is in the
    null space of the output, of which the next mode's V must be less than e^{-2 jump_decay} of it."""
    n = claim.states
    jump_decay = claim.value("jump_decay")
    yield times_are_valid(claim, T1_may_be_zero=True)
    yield Number("jump_decay > 0", jump_decay)
    yield Fixed("independent outputs", product(claim.C_d, transposed(claim.C_d)))
    yield Statement("no L_d beside", "L_d" not in claim.gains and "L_c" not in claim.gains)
    N = null_space(claim.C_d)
    for mode in claim.modes:
        P = claim.value(metric_of(mode))
        yield Fixed(f"P > 0 in mode {mode.label}", P)
        Z = root_of(P)
        if Z is None or not N or not N[0]:
            continue
        for other in next_modes(mode):
            after = product(jump_of(mode, n), N)
            left = products(transposed(after), claim.value(metric_of(other)), after)
            yield at_times(claim, f"jump from {mode.label} to {other.label}", 1,
                           times(mpmath.exp(-jump_decay), Z), times(mpf(-1), mode.A), N, left)


def bernard2022_corollary5_2_metric(claim):
    yield from metrics(claim, lambda mode: "metric", lambda mode: claim.modes)


def bernard2022_section7_3_2_metric(claim):
    yield from metrics(claim, lambda mode: f"metric/{mode.label}",
                       lambda mode: [other for other in claim.modes if other is not mode])


def bernard2022_section7_3_1(claim):
    """(47b) for P = Pi'Q Pi + H'S H, where a switch makes Pi e of e, and Pi depends on the mode's metric.

    That V does not grow at switches needs no numbers but is looked at: V before less V after is
    H'S H, which is the difference of both as they are computed.
    """
    n = claim.states
    H = claim.C_d or claim.C_c
    decay, Q = claim.value("decay"), claim.value("Q")
    yield times_are_valid(claim, T1_may_be_zero=True)
    yield Number("decay > 0", decay)
    yield Fixed("Q > 0", Q)
    projectors, forms = [], []
    for mode in claim.modes:
        yield Statement("no jump map", mode.A_d is None or mode.A_d == identity(n))
        lifted = product(inverse(claim.value(f"projection/{mode.label}")), transposed(H))
        projector = minus(identity(n), products(lifted, inverse(product(H, lifted)), H))
        measured = products(transposed(H), claim.value(f"S/{mode.label}"), H)
        P = plus(products(transposed(projector), Q, projector), measured)
        flow = minus(mode.A, product(claim.value(f"L_c/{mode.label}"), claim.C_c))
        yield Fixed(f"P > 0 in mode {mode.label}", P)
        yield Fixed(f"flow in mode {mode.label}",
                    minus(times(-2 * decay, P), symmetrized(product(P, flow))))
        projectors.append(projector)
        forms.append((P, measured))
    for projector, (P, measured) in zip(projectors, forms):
        for after, _ in forms:
            fall = minus(P, products(transposed(projector), after, projector))
            error = max(abs(value) for row in minus(fall, measured) for value in row)
            size = max(abs(value) for row in P for value in row)
            yield Statement("V falls at switches", bool(error < size * mpf(10) ** -20))


OBSERVERS = {
    ferrante2016_theorem1: "ConstantGainObserver",
    ferrante2019_theorem2: "IntersampleInjectionObserver",
    ferrante2019_corollary1: "IntersampleInjectionObserver",
    ferrante2019_corollary2: "IntersampleInjectionObserver",
    sferlazza2019_theorem2: "TimeVaryingGainObserver",
    sferlazza2019_theorem2_rate: "TimeVaryingGainObserver",
    sferlazza2019_theorem2_norm: "TimeVaryingGainObserver",
    sferlazza2019_equation17: "TimeVaryingGainObserver",
    etienne2019_proposition1: "SampleAndHoldObserver",
    etienne2019_theorem1: "SampleAndHoldObserver",
    etienne2019_proposition2_channels: "SampleAndHoldObserver",
    etienne2019_proposition2: "SampleAndHoldObserver",
    bernard2022_equation14: "SynchronizedObserver",
    bernard2022_equation22: "SynchronizedObserver",
    bernard2022_equation26: "SynchronizedObserver",
    bernard2022_equation14_average_dwell_time: "SynchronizedObserver",
    bernard2022_equation22_average_dwell_time: "SynchronizedObserver",
    bernard2022_equation26_reverse_average_dwell_time: "SynchronizedObserver",
    bernard2022_corollary5_2_metric: "SynchronizedObserver",
    bernard2022_corollary5_2: "SynchronizedObserver",
    bernard2022_corollary4_1: "HighGainObserver",
    bernard2022_corollary4_1_average_dwell_time: "HighGainObserver",
    bernard2022_example4_2: "HighGainObserver",
    bernard2022_example4_2_average_dwell_time: "HighGainObserver",
    bernard2022_example7_1: "SwitchedObserver",
    bernard2022_example7_1_average_dwell_time: "SwitchedObserver",
    bernard2022_equation49_reverse_average_dwell_time: "SwitchedObserver",
    bernard2022_section7_3_1: "SwitchedObserver",
    bernard2022_section7_3_2_metric: "SwitchedObserver",
    bernard2022_section7_3_2: "SwitchedObserver",
    timer_dependent_constant_gain: "ConstantGainObserver",
    timer_dependent_scheduled_gain: "TimeVaryingGainObserver",
    timer_dependent_intersample_injection: "IntersampleInjectionObserver",
    timer_dependent_sample_and_hold: "SampleAndHoldObserver",
    timer_dependent_sum_constant_gain: "ConstantGainObserver",
    timer_dependent_sum_intersample_injection: "IntersampleInjectionObserver",
    timer_dependent_sum_sample_and_hold: "SampleAndHoldObserver",
    timer_dependent_synchronized: "SynchronizedObserver",
    timer_dependent_switched: "SwitchedObserver",
}


def statements_of_formulas(claim):
    """That no pair of points refutes what the file states of psi proves nothing of it."""
    if claim.psi is None:
        return
    if claim.theorem.startswith("ferrante2019") or (
            claim.theorem.startswith("timer_dependent") and not claim.vertices):
        yield Statement("no points refute lipschitz_constant", not lipschitz_constant_is_refuted(
            claim.psi, len(claim.S), claim.lipschitz))
    elif claim.vertices:
        yield Statement("no point refutes vertices", not vertices_are_refuted(
            claim.psi, claim.G, claim.S, claim.vertices))


def conditions_of(claim):
    if claim.flows and not claim.theorem.startswith("timer_dependent"):
        raise Unreadable(f"{claim.theorem} is not about the hull of several flows")
    for theorem, observer in OBSERVERS.items():
        if theorem.__name__ == claim.theorem:
            yield Statement(f"gains of a {observer}", claim.observer == observer)
            yield from statements_of_formulas(claim)
            yield from theorem(claim)
            return
    raise Unreadable(f"no theorem {claim.theorem} is known here")
