#include "sampled_data_observers/config/law_registry.h"

#include <map>

#include "sampled_data_observers/observer/constant_gain_observer.h"

namespace sampled_data_observers {
namespace {

using Builder = std::shared_ptr<const ObserverLaw> (*)(ConfigSection&, const LawContext&);

/// One n x m_i matrix per sensor: a map from sensor names to matrices, or, where there is one
/// sensor only, its matrix.
std::vector<Eigen::MatrixXd> read_gain_per_sensor(ConfigSection& gains, const std::string& key,
                                                  const LinearPlant& plant) {
  const std::vector<Sensor>& sensors = plant.sensors();
  if (sensors.size() == 1 && !gains.is_map(key)) {
    return {gains.matrix(key, plant.states(), sensors.front().C.rows())};
  }
  ConfigSection section = gains.section(key);
  std::vector<Eigen::MatrixXd> result;
  for (const Sensor& sensor : sensors) {
    result.push_back(section.matrix(sensor.name, plant.states(), sensor.C.rows()));
  }
  section.finish();
  return result;
}

std::shared_ptr<const ObserverLaw> build_constant_gain(ConfigSection& gains,
                                                       const LawContext& context) {
  return std::make_shared<const ConstantGainObserver>(
      context.plant, read_gain_per_sensor(gains, "L", *context.plant), context.initial_estimate,
      context.initial_input);
}

const std::map<std::string, Builder>& builders() {
  static const std::map<std::string, Builder> kBuilders = {
      {"ConstantGainObserver", build_constant_gain},
  };
  return kBuilders;
}

}  // namespace

std::vector<std::string> observer_types() {
  std::vector<std::string> types;
  for (const auto& builder : builders()) types.push_back(builder.first);
  return types;
}

std::shared_ptr<const ObserverLaw> build_law(const std::string& type, ConfigSection& gains,
                                             const LawContext& context) {
  return builders().at(type)(gains, context);
}

}  // namespace sampled_data_observers
