#include "observer/kalman_matrices.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "linear_algebra/definite_matrix.h"
#include "linear_algebra/ordered_linear_algebra.h"

namespace sampled_data_observers {

bool takes_covariances(const KalmanMatrices& matrices) {
  return std::any_of(matrices.R.begin(), matrices.R.end(),
                     [](const Eigen::MatrixXd& R) { return R.size() == 0; });
}

void write_noise(const KalmanMatrices& matrices, std::size_t sensor, Eigen::Index outputs,
                 const double* y, double* S) {
  const Eigen::MatrixXd& R = matrices.R[sensor];
  if (R.size() > 0) {
    std::copy_n(R.data(), R.size(), S);
  } else {
    unpack_lower(y + outputs, outputs, S);
  }
}

KalmanMatrices kalman_matrices(const KalmanCovariances& covariances, const Plant& plant) {
  const Eigen::Index n = plant.states();
  KalmanMatrices result;
  result.P0 = checked_positive_definite("P0", covariances.P0, n);
  result.Q_d = checked_positive_semidefinite("Q_d", covariances.Q_d, n);
  if (!(covariances.stamp_deviation >= 0.0) || !std::isfinite(covariances.stamp_deviation)) {
    throw std::invalid_argument("stamp_deviation: a finite number of seconds, not negative");
  }
  result.stamp_deviation = covariances.stamp_deviation;
  const std::vector<Sensor>& sensors = plant.sensors();
  if (covariances.R.size() != sensors.size()) {
    throw std::invalid_argument("R: one matrix per sensor");
  }
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (covariances.R[i].size() == 0 && sensors[i].timing == SensorTiming::kSampled) {
      result.R.emplace_back();
      result.noise_roots.emplace_back();
      continue;
    }
    Eigen::MatrixXd root = checked_positive_definite("R of sensor '" + sensors[i].name + "'",
                                                     covariances.R[i], sensors[i].outputs());
    result.R.push_back(root);
    factor_cholesky(root.data(), root.rows());
    result.noise_roots.push_back(root);
  }
  result.Q = checked_positive_semidefinite("Q", covariances.Q, n);
  for (const PlantMode& mode : plant.modes()) {
    std::vector<Eigen::MatrixXd>& outputs = result.outputs.emplace_back();
    for (std::size_t i = 0; i < sensors.size(); ++i) {
      const AffineMap* output = mode.outputs[i]->affine();
      if (output == nullptr || result.R[i].size() == 0) {
        outputs.emplace_back();
        continue;
      }
      Eigen::MatrixXd C = output->M();
      solve_lower(result.noise_roots[i].data(), C.rows(), C.rows(), C.data(), n);
      outputs.emplace_back(C.transpose());
    }
  }
  return result;
}

LawGains gains_of(const KalmanMatrices& matrices, const Plant& plant) {
  LawGains all;
  for (std::size_t i = 0; i < plant.sensors().size(); ++i) {
    all.add("R/" + plant.sensors()[i].name, matrices.R[i]);
  }
  return all.add("P0", matrices.P0).add("Q", matrices.Q).add("Q_d", matrices.Q_d);
}

}  // namespace sampled_data_observers
