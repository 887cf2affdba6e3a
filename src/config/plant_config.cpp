#include "sampled_data_observers/config/plant_config.h"

#include <algorithm>
#include <set>
#include <utility>

namespace sampled_data_observers {
namespace {

/// Names that are not empty and differ.
std::vector<std::string> read_names(ConfigSection& section, const std::string& key) {
  std::vector<std::string> names = section.texts(key);
  if (names.empty()) throw section.error(key, "at least one name", "an empty list");
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (name.empty()) throw section.error(key, "names that are not empty", "an empty one");
    if (!seen.insert(name).second)
      throw section.error(key, "different names", "'" + name + "' twice");
  }
  return names;
}

void read_sensor(ConfigSection section, const std::string& name, LinearPlantDescription& plant,
                 std::vector<BiasState>& biases) {
  Sensor sensor;
  sensor.name = name;
  sensor.C = section.matrix("C", -1, plant.A.rows());
  const auto outputs = static_cast<std::size_t>(sensor.C.rows());
  sensor.angular = section.has("angular") ? section.flags("angular", outputs)
                                          : std::vector<bool>(outputs, false);
  if (section.has("bias")) {
    const std::vector<std::string> names = section.texts("bias", outputs);
    for (std::size_t output = 0; output < outputs; ++output) {
      if (names[output].empty()) continue;
      const auto is_taken = [&](const std::string& taken) { return taken == names[output]; };
      if (std::any_of(plant.state_names.begin(), plant.state_names.end(), is_taken) ||
          std::any_of(biases.begin(), biases.end(),
                      [&](const BiasState& bias) { return is_taken(bias.name); })) {
        throw section.error("bias", "names that no other state has", "'" + names[output] + "'");
      }
      biases.push_back({names[output], plant.sensors.size(), static_cast<Eigen::Index>(output)});
    }
  }
  plant.sensors.push_back(std::move(sensor));
}

std::vector<std::string> sorted_sensor_names(const ConfigSection& sensors) {
  // The parameter server knows no order of keys, so the file's order can't count.
  std::vector<std::string> names = sensors.keys();
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

std::shared_ptr<const LinearPlant> read_linear_plant(ConfigSection& root) {
  ConfigSection section = root.section("plant");
  LinearPlantDescription plant;
  plant.state_names = read_names(section, "states");
  const auto n = static_cast<Eigen::Index>(plant.state_names.size());
  plant.A = section.matrix("A", n, n);
  plant.B = Eigen::MatrixXd::Zero(n, 0);
  if (section.has("inputs") || section.has("B")) {
    plant.input_names = read_names(section, "inputs");
    plant.B = section.matrix("B", n, static_cast<Eigen::Index>(plant.input_names.size()));
  }
  if (section.has("jump_map")) {
    ConfigSection jump_map = section.section("jump_map");
    plant.jump_map = AffineJumpMap{jump_map.matrix("A_d", n, n), Eigen::VectorXd::Zero(n)};
    if (jump_map.has("b_d")) plant.jump_map->b_d = jump_map.vector("b_d", n);
    jump_map.finish();
  }
  section.finish();

  ConfigSection sensors = root.section("sensors");
  const std::vector<std::string> names = sorted_sensor_names(sensors);
  if (names.empty()) throw root.error("sensors", "at least one sensor", "none");
  std::vector<BiasState> biases;
  for (const std::string& name : names) {
    read_sensor(sensors.section(name), name, plant, biases);
  }
  return std::make_shared<const LinearPlant>(with_bias_states(std::move(plant), biases));
}

}  // namespace sampled_data_observers
