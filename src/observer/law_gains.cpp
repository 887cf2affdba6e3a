#include "sampled_data_observers/observer/law_gains.h"

namespace sampled_data_observers {

LawGains& LawGains::add(const std::string& name, const Eigen::MatrixXd& value) {
  all.push_back({name, value});
  return *this;
}

LawGains& LawGains::add(const std::string& name, double value) {
  return add(name, Eigen::MatrixXd::Constant(1, 1, value));
}

LawGains& LawGains::add(const std::string& symbol, const std::vector<Eigen::MatrixXd>& per_sensor,
                        const Plant& plant, SensorTiming timing) {
  for (std::size_t i = 0; i < per_sensor.size(); ++i) {
    const Sensor& sensor = plant.sensors()[i];
    if (sensor.timing == timing) add(symbol + "/" + sensor.name, per_sensor[i]);
  }
  return *this;
}

const LawGain* LawGains::find(const std::string& symbol) const {
  const LawGain* found = nullptr;
  for (const LawGain& gain : all) {
    if (!is_named(gain.name, symbol)) continue;
    if (found != nullptr) return nullptr;
    found = &gain;
  }
  return found;
}

bool is_named(const std::string& name, const std::string& symbol) {
  return name == symbol || name.compare(0, symbol.size() + 1, symbol + "/") == 0;
}

}  // namespace sampled_data_observers
