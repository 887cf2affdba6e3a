#include "config/gains/readers.h"
#include "sampled_data_observers/config/gains_config.h"

namespace sampled_data_observers {

std::vector<Eigen::MatrixXd> read_sampled_gains(ConfigSection& gains, const LawContext& context) {
  const Plant& plant = context.plant();
  return read_gain_per_sensor(gains, "L", plant, SensorTiming::kSampled, plant.states());
}

}  // namespace sampled_data_observers
