#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// The exact flow of ẋ = A x + B u + c with constant u, over any whole number of nanoseconds.
///
/// Time is an integer, so every duration is a sum of few tabulated ones: it is written in base 64,
/// and the transition matrix of every digit at every place is computed once, in extended precision
/// from (A, B, c) itself. A flow then costs one matrix-vector product a non-zero digit, at most
/// five up to 1 s and eleven at all, whatever the norm of A: stiff, nilpotent, oscillating and
/// unstable plants take the same time and are exact to rounding.
///
/// The tables hold 638 n (n + p) doubles, and 638 n for c, the first n rounded up to a multiple of
/// 4: 80 kB for n = 4, 1.2 MB for n = 15, without inputs. Flows of the same matrices in one process
/// share them.
class LinearFlow {
 public:
  /// @param A  n x n
  /// @param B  n x p; p may be 0
  /// @param c  n, or empty: there is none
  /// @throws std::invalid_argument for dimensions that do not fit or entries that are not finite.
  LinearFlow(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, const Eigen::VectorXd& c = {});

  /// Carries x (n entries) over `duration` >= 0 under the constant input u (p entries); x becomes
  /// NaN where the transition overflows. `scratch`: n entries that overlap neither.
  void apply(Duration duration, double* x, const double* u, double* scratch) const;

  /// E (n x n) ← e^{A duration}, with `scratch` as for apply().
  /// @pre no c
  void transition(Duration duration, double* E, double* scratch) const;

 private:
  Eigen::Index states_;
  Eigen::Index inputs_;
  bool has_constant_;
  /// [Φ Γ γ] of each digit, columns padded: see digit_tables().
  std::shared_ptr<const std::vector<double>> tables_;
};

}  // namespace sampled_data_observers
