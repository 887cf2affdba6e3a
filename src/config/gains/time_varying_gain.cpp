#include "config/gains/readers.h"

namespace sampled_data_observers {

TimeVaryingGains read_time_varying_gains(ConfigSection& gains, const LawContext& context) {
  const Eigen::Index n = context.plant().states();
  TimeVaryingGains result;
  if (gains.has("P")) result.P = gains.matrix("P", n, n);
  const std::optional<double> fallback = result.P ? std::optional<double>(0.0) : std::nullopt;
  result.lambda = gains.number_in("lambda", 0.0, 1.0, fallback);
  if (result.lambda == 1.0) throw gains.error("lambda", "a number in [0, 1)", "1");
  return result;
}

}  // namespace sampled_data_observers
