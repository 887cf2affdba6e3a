#include <cmath>

#include "config/gains/readers.h"
#include "config/size_limits.h"
#include "sampled_data_observers/config/gains_config.h"

namespace sampled_data_observers {
namespace {

constexpr std::size_t kMostIterations = 20;

Eigen::Index outputs_of(const Plant& plant) {
  Eigen::Index outputs = 0;
  for (const Sensor& sensor : plant.sensors()) outputs += sensor.outputs();
  return outputs;
}

}  // namespace

KalmanGains read_kalman_gains(ConfigSection& gains, const LawContext& context) {
  const Plant& plant = context.plant();
  const Eigen::Index n = plant.states();
  const Eigen::Index variables = n + plant.inputs() + outputs_of(plant);
  require_bounded(static_cast<std::size_t>(variables), plant.modes().size(), kMostWithCovariance,
                  gains, "P0");
  const auto matrix_or_zero = [&](const char* key) -> Eigen::MatrixXd {
    if (gains.has(key)) return gains.square_matrix(key, n);
    return Eigen::MatrixXd::Zero(n, n);
  };
  KalmanGains result;
  result.is_unscented =
      gains.has("variant") && gains.choice("variant", {"extended", "unscented"}) == "unscented";
  if (result.is_unscented && gains.has("iterations")) {
    throw gains.error("iterations",
                      "no such key beside variant: unscented, which linearizes nothing",
                      "iterations");
  }
  KalmanCovariances& covariances = result.covariances;
  covariances.P0 = gains.square_matrix("P0", n);
  covariances.R = read_noise_covariances(gains, plant);
  covariances.Q = matrix_or_zero("Q");
  covariances.Q_d = matrix_or_zero("Q_d");
  covariances.iterations = static_cast<int>(gains.count("iterations", 1, kMostIterations, 1));
  // Nothing is known but the limits, as of a uniform distribution between them.
  covariances.stamp_deviation = context.jump_stamp_error / std::sqrt(3.0);
  return result;
}

}  // namespace sampled_data_observers
