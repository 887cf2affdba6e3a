#include "observer/hybrid_kalman_filter.h"

#include "config/gains/builders.h"
#include "sampled_data_observers/config/gains_config.h"

namespace sampled_data_observers {

std::shared_ptr<const ObserverLaw> build_hybrid_kalman_filter(ConfigSection& gains,
                                                              const LawContext& context) {
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
  return std::make_shared<const HybridKalmanFilter>(context.observer, covariances);
}

}  // namespace sampled_data_observers
