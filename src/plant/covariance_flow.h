#pragma once

#include <Eigen/Core>
#include <vector>

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// The exact flow of a covariance, Ṗ = A P + P Aᵀ + Q, over any whole number of nanoseconds:
///   P ← Φ P Φᵀ + Q_Δ,  Φ = e^{AΔ},  Q_Δ = ∫₀^Δ e^{As} Q e^{Aᵀs} ds.
///
/// As in LinearFlow, Φ and Q_Δ of every base-64 digit of a duration are tabulated, computed in
/// extended precision. The tables hold 1408 n² doubles: 180 kB for n = 4, 2.5 MB for n = 15.
class CovarianceFlow {
 public:
  /// @param A  n x n
  /// @param Q  n x n, symmetric positive semidefinite
  /// @throws std::invalid_argument for sizes that do not fit or entries that are not finite.
  CovarianceFlow(const Eigen::MatrixXd& A, const Eigen::MatrixXd& Q);

  /// Carries P (n x n, symmetric to the bit, and so again afterwards) over `duration` >= 0.
  /// `scratch`: n² entries that do not overlap it.
  void apply(Duration duration, double* P, double* scratch) const;

 private:
  std::size_t block() const { return static_cast<std::size_t>(2 * states_ * states_); }

  Eigen::Index states_;
  /// [Φ Q_Δ] of each digit, column-major: see digit_tables().
  std::vector<double> tables_;
};

}  // namespace sampled_data_observers
