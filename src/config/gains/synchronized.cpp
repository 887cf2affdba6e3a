#include "config/gains/readers.h"
#include "sampled_data_observers/config/gains_config.h"

namespace sampled_data_observers {
namespace {

/// Zero gains where the key is missing.
std::vector<Eigen::MatrixXd> read_gains(ConfigSection& gains, const std::string& key,
                                        const Plant& plant, SensorTiming timing) {
  if (gains.has(key)) return read_gain_per_sensor(gains, key, plant, timing, plant.states());
  std::vector<Eigen::MatrixXd> result;
  for (const Sensor& sensor : plant.sensors()) {
    result.push_back(Eigen::MatrixXd::Zero(plant.states(), sensor.outputs()));
  }
  return result;
}

}  // namespace

SynchronizedGains read_synchronized_gains(ConfigSection& gains, const LawContext& context) {
  const Plant& plant = context.plant();
  if (!gains.has("L_c") && !gains.has("L_d") && !gains.has("metric")) {
    throw ConfigError(gains.origin(), gains.path(), "L_c, L_d or both, or metric in place of L_d",
                      "neither");
  }
  SynchronizedGains result;
  result.L_c = read_gains(gains, "L_c", plant, SensorTiming::kContinuous);
  result.L_d = read_gains(gains, "L_d", plant, SensorTiming::kAtJumps);
  if (gains.has("metric")) result.metric = gains.matrix("metric", plant.states(), plant.states());
  result.output_injections = read_output_injections(gains, plant);
  return result;
}

}  // namespace sampled_data_observers
