#include "config/gains/readers.h"
#include "sampled_data_observers/config/gains_config.h"

namespace sampled_data_observers {

KalmanCovariances read_covariances(ConfigSection& gains, const LawContext& context) {
  const Eigen::Index n = context.plant().states();
  const auto matrix_or_zero = [&](const char* key) -> Eigen::MatrixXd {
    if (gains.has(key)) return gains.matrix(key, n, n);
    return Eigen::MatrixXd::Zero(n, n);
  };
  KalmanCovariances covariances;
  covariances.P0 = gains.matrix("P0", n, n);
  covariances.R = read_square_per_sensor(gains, "R", context.plant(),
                                         {SensorTiming::kSampled, SensorTiming::kAtJumps});
  covariances.Q = matrix_or_zero("Q");
  covariances.Q_d = matrix_or_zero("Q_d");
  return covariances;
}

}  // namespace sampled_data_observers
