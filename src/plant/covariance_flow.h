#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// The exact flow of a covariance, Ṗ = A P + P Aᵀ + Q, over any whole number of nanoseconds:
///   P ← Φ P Φᵀ + Q_Δ,  Φ = e^{AΔ},  Q_Δ = ∫₀^Δ e^{As} Q e^{Aᵀs} ds.
///
/// As in LinearFlow, Φ and Q_Δ of every base-64 digit of a duration are tabulated, computed in
/// extended precision; of Φ those entries only that may differ from zero, since there is a path of
/// entries of A from one state to the other. The tables hold some 957 n² doubles at most,
/// since of Q_Δ one half is enough: 160 kB for n = 4, 1.9 MB for n = 15. Flows of the same A and Q
/// in one process share them.
class CovarianceFlow {
 public:
  /// @param A  n x n
  /// @param Q  n x n, symmetric positive semidefinite
  /// @throws std::invalid_argument for sizes that do not fit or entries that are not finite.
  CovarianceFlow(const Eigen::MatrixXd& A, const Eigen::MatrixXd& Q);

  /// Number of entries of the scratch memory of apply(), for n states.
  static Eigen::Index scratch_size(Eigen::Index n);

  /// Carries P (n x n, symmetric to the bit, and so again afterwards) over `duration` >= 0. Where
  /// that overflows, or an entry of P is not finite, not all of P is finite afterwards.
  /// `scratch`: scratch_size(n) entries that do not overlap it.
  void apply(Duration duration, double* P, double* scratch) const;

 private:
  std::size_t block() const;

  Eigen::Index states_;
  /// Where Φ may differ from zero: as SparseRows.
  std::vector<std::int32_t> row_begins_;
  std::vector<std::int32_t> offsets_;
  /// Of each digit: these entries of Φ, then Q_Δ, as Kernels::covariance_flow takes them.
  std::shared_ptr<const std::vector<double>> tables_;
};

}  // namespace sampled_data_observers
