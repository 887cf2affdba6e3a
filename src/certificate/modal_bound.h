#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "certificate/certificate.h"

namespace sampled_data_observers {

/// What a theorem of bernard2022 says of a plant in one of its modes q, with V = (x − x̂)ᵀ P_q
/// (x − x̂). A plant that does not switch has one.
struct ModalProof {
  Eigen::MatrixXd P;    ///< n x n
  Eigen::MatrixXd L_c;  ///< n x m_c; no columns where the flow is not corrected
  Eigen::MatrixXd L_d;  ///< n x m_d; no columns where jumps are not corrected
};

/// The bound of an observer that is corrected in flow, by a continuous output that is held between
/// its messages, and perhaps at jumps. With h = y_held − C_c x, ė = (A_q − L_c C_c) e − L_c h + N
/// w, and since V̇ <= −flow_decay V without h and w,
///
///   d/dt |e|_P <= −(flow_decay / 2) |e|_P + |L_c|_P |h| + |N|_P |w|,  |a|_P = sup |a v|_P, |v| <=
///   1,
///
/// with |h| <= noise + output_rate s, s the time since the message. Where nothing is known of what
/// is held but the innovation ν = y_held − C_c x̂ (the observer was reset, or a jump was refused), h
/// is |ν| + ‖C_c‖ |e| there, and grows as fast. Where no output is held yet, as after each jump,
/// the error grows as the plant lets it grow at most. A jump from mode q into q' makes of |e|_{P_q}
/// at most √λ_max(RᵀP_q'R, P_q) |e|_{P_q} + |L_d|_P' noise, R = A_d − L_d C_d.
///
/// Where a Lipschitz constant k stands for the jump map, a jump makes of |e|_P at most
/// √(λ_max(P)/λ_min(P)) k |e|_P.
///
/// Where the flow takes the output in place of a state x_s = C_c x, k bounding what f_i makes of it
/// (ErrorAssumptions::injection_lipschitz), f(x) − f(x̂ with y_held) is A e + d with |d_i| <= k_i
/// |h|, and k_i |x_s − x̂_s| where nothing is held: |d|_P <= √(kᵀ |P| k) |h|, |P| entry by entry.
///
/// Where the reset μ of a jump waits for its release, x̂ goes on as above from |x − μ| + |μ − x̂|.
/// With x̂_v from μ on by ẋ̂_v = f(x̂_v), e_v = x − x̂_v flows as the plant lets it, and x̂_v − μ by
/// d/dt (x̂_v − μ) = A (x̂_v − μ) + f(μ, u): at the release x − μ is the sum of the two.
/// @param flow_decay  1/s
/// @throws std::invalid_argument without an output_rate, and where stamps of jumps may be off.
std::unique_ptr<const ErrorBound> held_output_bound(const CertificateSubject& subject,
                                                    const std::vector<ModalProof>& modes,
                                                    double flow_decay,
                                                    const ErrorAssumptions& assumptions);

/// The bound of an observer that is corrected when the mode of its plant changes: V falls by
/// e^{−2 jump_decay} from just after a switch to just after the next, τ in [T1, T2] later, into
/// another mode. After other times, at the first switch and at one that stays in its mode it is
/// what flow and reset make of it at most. Each switch must be told once.
/// @param jump_decay  nothing where V need not fall from switch to switch: then each counts by what
///                    its reset makes of V
/// @throws std::invalid_argument where stamps of jumps may be off.
std::unique_ptr<const ErrorBound> switch_bound(const CertificateSubject& subject,
                                               const std::vector<ModalProof>& modes,
                                               std::optional<double> jump_decay,
                                               const ErrorAssumptions& assumptions);

}  // namespace sampled_data_observers
