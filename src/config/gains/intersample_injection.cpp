#include "config/gains/readers.h"
#include "sampled_data_observers/config/gains_config.h"

namespace sampled_data_observers {
namespace {

/// θ before the first sample: a list per sensor, zeros where the key is missing.
void read_initial_theta(ConfigSection& gains, const Plant& plant,
                        std::vector<IntersampleGains>& result) {
  ConfigSection section = gains.section_or_empty("theta0");
  for (std::size_t i = 0; i < result.size(); ++i) {
    const Sensor& sensor = plant.sensors()[i];
    result[i].initial_theta = section.has(sensor.name)
                                  ? section.vector(sensor.name, sensor.outputs())
                                  : Eigen::VectorXd::Zero(sensor.outputs());
  }
  section.finish();
}

void require_linear_outputs(ConfigSection& gains, const Plant& plant) {
  for (std::size_t i = 0; i < plant.sensors().size(); ++i) {
    const AffineMap* map = plant.modes().front().outputs[i]->affine();
    if (plant.switches() || map == nullptr) {
      throw gains.error("variant",
                        "output maps C x that are the same in all modes, for a predictor",
                        "another one of sensor '" + plant.sensors()[i].name + "'");
    }
  }
}

}  // namespace

std::vector<IntersampleGains> read_intersample_gains(ConfigSection& gains,
                                                     const LawContext& context) {
  const Plant& plant = context.plant();
  const std::vector<Eigen::MatrixXd> L =
      read_gain_per_sensor(gains, "L", plant, SensorTiming::kSampled, plant.states());
  std::vector<IntersampleGains> result(L.size());
  for (std::size_t i = 0; i < L.size(); ++i) result[i].L = L[i];
  if (gains.has("variant")) {
    const bool predicts = gains.choice("variant", {"predictor", "zero_order_hold"}) == "predictor";
    if (predicts) require_linear_outputs(gains, plant);
    for (std::size_t i = 0; i < L.size(); ++i) {
      result[i].H =
          predicts ? predictor_H(plant, i, L[i]) : Eigen::MatrixXd::Zero(L[i].cols(), L[i].cols());
    }
  } else {
    const auto H = read_square_per_sensor(gains, "H", plant, {SensorTiming::kSampled});
    for (std::size_t i = 0; i < L.size(); ++i) result[i].H = H[i];
  }
  read_initial_theta(gains, plant, result);
  return result;
}

}  // namespace sampled_data_observers
