#pragma once

#include <memory>
#include <vector>

#include "certificate/certificate.h"
#include "certificate/timer_dependent_conditions.h"

namespace sampled_data_observers {

/// The bound of an observer that jumps with its plant, by V = eᵀ P(τ) e with τ the time since the
/// last jump that was told: TimerDependentBound with what jumps do. Of a plant that switches each
/// mode q has a P_q(τ), and a switch takes V from that of one to that of the next.
///
/// P(τ) decreases along the flow as the theorem says, however τ came to be what it is. So a jump
/// that is not as foreseen resets τ, too, and W takes what it may have done at most:
/// - one whose outputs did not come, by A_d alone;
/// - one sooner than T1 after another, or after the start, may have been told twice: then x stayed,
///   and x̂ moved by what is known;
/// - of one that the law refused, the plant may have made it or not, and of a plant that switches
///   nothing is known from there on;
/// - a switch that stays in its mode counts by what its reset makes of V.
/// Of a plant that switches, the bound of where the estimate begins is that of the norm until the
/// law tells its mode.
///
/// Where the law corrects with a continuous output, which it holds between messages, the error is
/// e = e_1 + e_2: e_1 flows from where the interval began as if the output were known at all times,
/// e_2 from 0 on by the flow with −L_c h in place of N w, h being by how much what is held is off
/// (HeldOutput). √V(e_1) <= √W, and d/dt √V(e_2) <= −λ √V(e_2) + |L_c|_P |h|: (3) is about the
/// difference of any two solutions. After a jump, until a message comes, the plant's own flow
/// counts, d/dt √V <= c √V + |N|_P |w| by LateFlow::growth_on_face(). An output that f takes in
/// place of a state adds d with |d_i| <= k_i |h| likewise, and k_i |C_c e| where none is held.
/// @param functions  of each mode, whose conditions hold for the values
/// @throws std::invalid_argument for stamps of jumps that may be off, held outputs without an
/// output_rate, a disturbance without N, and where rounding hides a bound
std::unique_ptr<const ErrorBound> timer_dependent_jump_bound(
    const std::vector<TimerDependentFunction>& functions, const CertificateSubject& subject,
    const NamedMatrices& values, const ErrorAssumptions& assumptions);

}  // namespace sampled_data_observers
