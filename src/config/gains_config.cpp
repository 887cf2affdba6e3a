#include "sampled_data_observers/config/gains_config.h"

#include <algorithm>

namespace sampled_data_observers {
namespace {

/// Whether what stands there is the matrix of the only sensor, or a map that stands for one.
bool is_without_name(ConfigSection& gains, const std::string& key, const std::string& sensor) {
  if (!gains.is_map(key)) return true;
  ConfigSection map = gains.section(key);
  return !map.has(sensor) && (map.has("diagonal") || map.has("message"));
}

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
  const auto only = std::find_if(sensors.begin(), sensors.end(), fits);
  if (count == 1 && is_without_name(gains, key, only->name)) {
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

/// Nothing where the key holds a matrix.
std::optional<MessageCovariance> read_message_covariance(ConfigSection& section,
                                                         const std::string& key,
                                                         const Sensor& sensor) {
  const char* const from_message = "message";
  const bool is_text =
      section.has(key) && !section.is_map(key) && !section.is_list(key) && !section.is_number(key);
  MessageCovariance covariance;
  covariance.floor = Eigen::VectorXd::Zero(sensor.outputs());
  if (is_text) {
    const std::string text = section.text(key);
    if (text != from_message) {
      throw section.error(key, "a matrix, or " + std::string(from_message), "'" + text + "'");
    }
  } else {
    if (!section.is_map(key)) return std::nullopt;
    ConfigSection map = section.section(key);
    if (!map.has(from_message)) return std::nullopt;
    ConfigSection message = map.section(from_message);
    constexpr double kLargest = 1e100;
    covariance.scale = message.number_in("scale", 1.0 / kLargest, kLargest, 1.0);
    if (message.has("floor")) covariance.floor = message.vector("floor", sensor.outputs());
    if (covariance.floor.minCoeff() < 0.0) {
      throw message.error("floor", "variances, not negative", "a negative one");
    }
    message.finish();
    map.finish();
  }
  if (sensor.timing == SensorTiming::kSampled) return covariance;
  throw section.error(key, "a matrix, since nothing measured at jumps comes with a covariance",
                      from_message);
}

}  // namespace

std::vector<std::optional<MessageCovariance>> read_message_covariances(ConfigSection& gains,
                                                                       const Plant& plant) {
  std::vector<std::optional<MessageCovariance>> result(plant.sensors().size());
  read_per_sensor(gains, "R", plant, {SensorTiming::kSampled, SensorTiming::kAtJumps},
                  [&](ConfigSection& section, const std::string& of, const Sensor& sensor) {
                    const auto index = static_cast<std::size_t>(&sensor - plant.sensors().data());
                    result[index] = read_message_covariance(section, of, sensor);
                    return Eigen::MatrixXd();
                  });
  return result;
}

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

std::vector<Eigen::MatrixXd> read_noise_covariances(ConfigSection& gains, const Plant& plant) {
  return read_per_sensor(
      gains, "R", plant, {SensorTiming::kSampled, SensorTiming::kAtJumps},
      [](ConfigSection& section, const std::string& of, const Sensor& sensor) -> Eigen::MatrixXd {
        if (read_message_covariance(section, of, sensor)) return {};
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
