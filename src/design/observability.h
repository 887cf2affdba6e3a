#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>
#include <vector>

namespace sampled_data_observers {

/// Whether x follows ẋ = A x or x⁺ = A x.
enum class TimeDomain { kContinuous, kDiscrete };

/// What one real eigenvalue, or one pair of conjugate ones, of a matrix does to the state.
/// Eigenvalues closer to each other than rounding can tell are one, of higher multiplicity.
struct Mode {
  std::complex<double> eigenvalue;  ///< that of imaginary part >= 0
  /// Orthonormal columns that span the states it moves, n x d: one column for each time it occurs,
  /// two for each time that a pair does.
  Eigen::MatrixXd directions;

  /// Whether what it moves converges to zero; false on the edge of stability.
  bool decays(TimeDomain domain) const;
};

/// The modes of A (n x n), slowest decay first where it is a flow.
std::vector<Mode> modes_of(const Eigen::MatrixXd& A);

/// The modes of A that no output y = C x (m x n) and no derivative (or later value) of it shows:
/// for λ the rank of [A − λI; C] is less than n (Popov, Belevitch, Hautus).
std::vector<Mode> unseen_modes(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C);

/// Whether all unseen modes decay; without that no observer can converge.
bool is_detectable(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C, TimeDomain domain);

/// Least singular value of [A − λI; C] over the eigenvalues λ of A that don't decay; infinity where
/// all decay. Zero where (A, C) is not detectable.
double detectability_margin(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C, TimeDomain domain);

/// Least k for which C x, C A x, …, C A^(k−1) x determine x; nothing where none does. For a flow
/// this is the order of strong differential observability: a high-gain observer needs it.
std::optional<int> observability_order(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C);

/// Least singular value of the observability matrix [C; C F; …; C F^(n−1)] of samples τ apart,
/// F = e^{Aτ} (sferlazza2019, Fig. 2), on the states that the flow itself lets the output see.
double sampled_observability(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C, double tau);

/// A time between samples at which two modes of the flow look the same: some state that the flow
/// would show is seen by no sample.
struct PathologicalInterval {
  double tau = 0.0;  ///< [s]
  /// What is unseen then, in the states of the plant.
  Eigen::MatrixXd directions;
  /// Whether it decays, so that constant intervals τ leave the plant detectable all the same.
  bool decays = false;
};

/// All pathological intervals up to `longest` [s], in increasing order; the first 1000 where there
/// are more. For eigenvalues λ, μ of equal real part they are among 2πk / |Im(λ − μ)|, exact to
/// rounding.
std::vector<PathologicalInterval> pathological_intervals(const Eigen::MatrixXd& A,
                                                         const Eigen::MatrixXd& C, double longest);

/// Time after which all pairs of eigenvalues of equal real part have looked the same once [s]; zero
/// where there are no such pairs.
double longest_beat(const Eigen::MatrixXd& A);

/// A plant that flows for a time τ and then jumps, from jump to jump, measured before each
/// (bernard2022 (33)): x_{k+1} = F x_k, y_k = H x_k with F = A_d e^{Aτ}, H = C_d e^{Aτ}.
struct DiscretePair {
  Eigen::MatrixXd F;
  Eigen::MatrixXd H;
};
DiscretePair pair_at_jumps(const Eigen::MatrixXd& A, const Eigen::MatrixXd& A_d,
                           const Eigen::MatrixXd& C_d, double tau);

}  // namespace sampled_data_observers
