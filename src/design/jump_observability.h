#pragma once

#include <Eigen/Core>

#include "certificate/certificate.h"

namespace sampled_data_observers {

/// How well outputs at jumps tell the state just after the first of a few intervals of flow began.
struct JumpObservability {
  /// Least eigenvalue, over the intervals tried, of Σ Φ_kᵀ H_kᵀ H_k Φ_k: H_k = C_d e^{A τ_k}, Φ_k
  /// carries the state to the begin of interval k.
  double least_gramian = 0.0;
  /// The intervals where it was found [s].
  std::vector<double> worst_intervals;
};

/// Looks for intervals in [T1, T2] between `jumps` jumps with which the equivalent discrete-time
/// plant of bernard2022, (34), is least observable: among all sequences of `points` equidistant
/// lengths. For a Kalman filter the least eigenvalue must be away from 0 (then its covariance stays
/// bounded where the noise is). A check by trial, no proof.
/// @throws std::invalid_argument for a plant that is switched, does not jump, or has no output at
/// jumps, and for more than a million sequences.
JumpObservability jump_observability(const CertificateSubject& subject, std::size_t jumps,
                                     std::size_t points = 9);

}  // namespace sampled_data_observers
