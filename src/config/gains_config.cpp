#include "sampled_data_observers/config/gains_config.h"

#include <algorithm>

namespace sampled_data_observers {
namespace {

/// @param read  of a section, a key of it and a sensor: the sensor's matrix
template <class Read>
std::vector<Eigen::MatrixXd> read_per_sensor(ConfigSection& gains, const std::string& key,
                                             const Plant& plant,
                                             const std::vector<SensorTiming>& timings, Read read) {
  const std::vector<Sensor>& sensors = plant.sensors();
  std::vector<Eigen::MatrixXd> result(sensors.size());
  const auto fits = [&timings](const Sensor& sensor) {
    return std::find(timings.begin(), timings.end(), sensor.timing) != timings.end();
  };
  const auto count = std::count_if(sensors.begin(), sensors.end(), fits);
  if (count == 0) {
    std::string expected;
    for (const SensorTiming timing : timings) {
      expected += (expected.empty() ? "" : " or ") + std::string(to_string(timing));
    }
    throw gains.error(key, "a sensor with measured: " + expected, "none");
  }
  if (count == 1 && !gains.is_map(key)) {
    const auto only = std::find_if(sensors.begin(), sensors.end(), fits);
    result[static_cast<std::size_t>(only - sensors.begin())] = read(gains, key, *only);
    return result;
  }
  ConfigSection section = gains.section(key);
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (fits(sensors[i])) result[i] = read(section, sensors[i].name, sensors[i]);
  }
  section.finish();
  return result;
}

}  // namespace

std::vector<Eigen::MatrixXd> read_gain_per_sensor(ConfigSection& gains, const std::string& key,
                                                  const Plant& plant, SensorTiming timing,
                                                  Eigen::Index rows) {
  return read_per_sensor(
      gains, key, plant, {timing},
      [rows](ConfigSection& section, const std::string& of, const Sensor& sensor) {
        return section.matrix(of, rows, sensor.outputs());
      });
}

std::vector<Eigen::MatrixXd> read_square_per_sensor(ConfigSection& gains, const std::string& key,
                                                    const Plant& plant,
                                                    const std::vector<SensorTiming>& timings) {
  return read_per_sensor(gains, key, plant, timings,
                         [](ConfigSection& section, const std::string& of, const Sensor& sensor) {
                           return section.square_matrix(of, sensor.outputs());
                         });
}

std::vector<OutputInjection> read_output_injections(ConfigSection& gains, const Plant& plant) {
  std::vector<OutputInjection> result;
  ConfigSection section = gains.section_or_empty("output_injection");
  for (std::size_t state = 0; state < plant.state_names().size(); ++state) {
    const std::string& name = plant.state_names()[state];
    if (!section.has(name)) continue;
    const std::string sensor = section.text(name);
    const auto found = std::find_if(plant.sensors().begin(), plant.sensors().end(),
                                    [&](const Sensor& other) { return other.name == sensor; });
    if (found == plant.sensors().end()) {
      throw section.error(name, "the name of a sensor", "'" + sensor + "'");
    }
    result.push_back({static_cast<Eigen::Index>(state),
                      static_cast<std::size_t>(found - plant.sensors().begin())});
  }
  section.finish();
  return result;
}

}  // namespace sampled_data_observers
