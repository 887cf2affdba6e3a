#pragma once

#include "certificate/certificate.h"

namespace sampled_data_observers {

/// The closed forms in which ferrante2016 states what its Theorems 1 and 2 guarantee, for
/// V = εᵀ e^{Aᵀτ} P e^{Aτ} ε with the time τ to the next sample and ε = x − x̂:
///   |ε(t, j)| <= e^{R/2} √(α2/α1) e^{−γ(t + j)/2} |ε(0, 0)|   (21)
/// and, where a noise |η| acts on the samples, the larger of
///   √(2 α2/α1) e^{R/2} e^{−γ(t + j)/2} |ε(0, 0)| and noise_gain · sup |η|   (35),
/// with θ, γ and R from β/2 in place of β.
///
/// What a certificate gives at run time (Theorem::error_bound()) is tighter: it follows the
/// samples.
struct Ferrante2016Bounds {
  double alpha_1 = 0.0;  ///< (15)
  double alpha_2 = 0.0;  ///< (16)
  double beta = 0.0;     ///< the largest in (18)
  double theta = 0.0;    ///< ln(1 − β/α2)
  double gamma = 0.0;    ///< |θ|/(1 + T2), the largest in (20a)
  double R = 0.0;        ///< T2 |θ|/(1 + T2), the least in (20a)
  /// Of (35), with ρ = ‖P‖ (1 + 2‖P‖/β) max ‖e^{Aτ}‖², which is what the proof comes to: where (28)
  /// is bounded, the print has the two terms of the sum in the wrong places.
  double noise_gain = 0.0;
};

/// @param values  P and L
/// @pre (12) holds
Ferrante2016Bounds ferrante2016_bounds(const CertificateSubject& subject,
                                       const NamedMatrices& values);

}  // namespace sampled_data_observers
