#pragma once

#include <Eigen/Core>
#include <vector>

#include "sampled_data_observers/observer/law_gains.h"
#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// The covariances that a HybridKalmanFilter is tuned by.
struct KalmanCovariances {
  Eigen::MatrixXd P0;  ///< of the initial estimate: n x n, symmetric positive definite
  /// Of each sensor: m_i x m_i, symmetric positive definite; without entries where it comes with
  /// the samples.
  std::vector<Eigen::MatrixXd> R;
  Eigen::MatrixXd Q;             ///< in flow, per second: n x n, symmetric positive semidefinite
  Eigen::MatrixXd Q_d;           ///< at jumps: n x n, symmetric positive semidefinite
  double stamp_deviation = 0.0;  ///< standard deviation of the stamps of jumps [s], >= 0
  int iterations = 1;            ///< of an update by outputs that are not affine, >= 1
};

/// What a HybridKalmanFilter computes with: outputs are transformed so that their noises are
/// independent and of variance 1.
struct KalmanMatrices {
  Eigen::MatrixXd P0;  ///< symmetric to the bit, as the others
  Eigen::MatrixXd Q;
  Eigen::MatrixXd Q_d;
  double stamp_deviation = 0.0;  ///< of jumps [s]
  /// Of each sensor, without entries where it comes with the samples; and L with R = L Lᵀ.
  std::vector<Eigen::MatrixXd> R;
  std::vector<Eigen::MatrixXd> noise_roots;
  /// Of each mode and sensor: (L⁻¹ C)ᵀ, n x m; without entries where the output is not affine, or R
  /// comes with the samples.
  std::vector<std::vector<Eigen::MatrixXd>> outputs;
};

/// S ← R of what a sensor measured: behind its outputs y, where it comes with them.
void write_noise(const KalmanMatrices& matrices, std::size_t sensor, Eigen::Index outputs,
                 const double* y, double* S);

/// Whether the R of some sensor comes with its samples.
bool takes_covariances(const KalmanMatrices& matrices);

/// @throws std::invalid_argument for covariances that do not fit the plant or are not definite as
/// they must be, and for a stamp_deviation that is negative or infinite.
KalmanMatrices kalman_matrices(const KalmanCovariances& covariances, const Plant& plant);

/// The covariances among them, by the keys that they have in a file.
LawGains gains_of(const KalmanMatrices& matrices, const Plant& plant);

}  // namespace sampled_data_observers
