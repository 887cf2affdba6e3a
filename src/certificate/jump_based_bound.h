#pragma once

#include <memory>

#include "certificate/certificate.h"

namespace sampled_data_observers {

/// By how much |x − x̂|_P = √((x − x̂)ᵀ P (x − x̂)) falls from just after a jump to just after the
/// next, τ later: by the factor e^{offset + slope τ}.
struct JumpContraction {
  double offset = 0.0;
  double slope = 0.0;  ///< 1/s
};

/// The bound of an observer that is corrected at jumps alone. For times between jumps in [T1, T2]
/// it falls as the contraction says, after longer ones and at the first jump it is what flow and
/// reset make of it at most. No jump may be missed.
///
/// Stamps that are off by ε, |ε| <= δ: let x̃ be the plant as its jumps are told, z = x̃ before the
/// jump at its stamp, and Φ_ε the flow ẋ = f(x) = A x + b over ε. The plant jumped at Φ_{−ε}(z), so
/// that the error of x̃ after the stamp differs from (A_d − L_d C_d)(z − x̂) − L_d η by
///
///   r(ε) = Φ_ε(g(Φ_{−ε}(z))) − g(z) + L_d C_d (z − Φ_{−ε}(z)),  r(0) = 0,
///
/// for ε of either sign. With γ = e^{‖A‖δ} >= ‖e^{Aε}‖ and f(Φ_ε(x)) = e^{Aε} f(x),
///
///   |r'(ε)| <= γ |f(g(z))| + γ (‖A_d − L_d C_d‖ + 2 (γ − 1) ‖A_d‖) |f(z)|,
///
/// where |f(z)| <= |f(x̂)| + ‖A‖ |z − x̂| and |f(g(z))| <= |f(g(x̂))| + ‖A‖ ‖A_d‖ |z − x̂|. A
/// disturbance |w| <= d that acts between jump and stamp adds up to (1 + γ ‖A_d‖ + ‖L_d‖ ‖C_d‖) γ δ
/// ‖N‖ d. Between stamps the error of x̃ moves as without.
///
/// Where the reset μ of a jump waits for its release while x̂ flows on: let x̂_v be the estimate that
/// flows from μ on, so that x − x̂_v is the error of an observer without delay, of which all of the
/// above is true. Until the release x̂_v − x̂ flows by ẋ = A x from μ − x̂ on. From then on x̂ begins
/// at μ, and x̂_v − x̂ at what x̂_v has moved by: d/dt (x̂_v − μ) = A (x̂_v − μ) + f(μ, u), f affine
/// in x. That is added to what was caused since the jump, and so goes through the next reset.
///
/// Where the flow takes an output in place of a state: as held_output_bound().
/// @param P       n x n
/// @param L_d     n x m
std::unique_ptr<const ErrorBound> jump_based_bound(const CertificateSubject& subject,
                                                   const Eigen::MatrixXd& P,
                                                   const Eigen::MatrixXd& L_d,
                                                   const JumpContraction& contraction,
                                                   const ErrorAssumptions& assumptions);

}  // namespace sampled_data_observers
