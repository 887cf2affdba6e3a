#include "sampled_data_observers/observer/gain_check.h"

#include <stdexcept>

namespace sampled_data_observers {

void check_gains(const std::string& name, const std::vector<Eigen::MatrixXd>& gains,
                 const Plant& plant, SensorTiming timing) {
  if (gains.size() != plant.sensors().size()) {
    throw std::invalid_argument(name + ": one gain per sensor");
  }
  for (std::size_t i = 0; i < gains.size(); ++i) {
    const Sensor& sensor = plant.sensors()[i];
    if (sensor.timing != timing) continue;
    if (gains[i].rows() != plant.states() || gains[i].cols() != sensor.outputs()) {
      throw std::invalid_argument(name + " of sensor '" + sensor.name +
                                  "': one row per state, one column per output");
    }
  }
}

}  // namespace sampled_data_observers
