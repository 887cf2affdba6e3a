#include <algorithm>

#include "config/expression_config.h"
#include "config/gains/readers.h"
#include "sampled_data_observers/config/gains_config.h"

namespace sampled_data_observers {
namespace {

using GainMap = std::shared_ptr<const VectorMap>;

std::string label_of(const PlantMode& mode) { return std::to_string(mode.label); }

/// L_d of one mode: per sensor that measures at jumps a matrix of numbers and formulas of tau.
std::vector<GainMap> read_gain_maps(ConfigSection& modes, const std::string& label,
                                    const Plant& plant, const ExpressionReader& reader) {
  const auto n = static_cast<std::size_t>(plant.states());
  const std::vector<Sensor>& sensors = plant.sensors();
  std::vector<GainMap> result(sensors.size());
  const auto measures = [](const Sensor& sensor) {
    return sensor.timing == SensorTiming::kAtJumps;
  };
  const auto read = [&](ConfigSection& section, const std::string& key, std::size_t i) {
    result[i] = reader.read_matrix(section, key, n, static_cast<std::size_t>(sensors[i].outputs()));
  };
  if (std::count_if(sensors.begin(), sensors.end(), measures) == 1 && !modes.is_map(label)) {
    const auto only = std::find_if(sensors.begin(), sensors.end(), measures);
    read(modes, label, static_cast<std::size_t>(only - sensors.begin()));
    return result;
  }
  ConfigSection section = modes.section(label);
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (measures(sensors[i])) read(section, sensors[i].name, i);
  }
  section.finish();
  return result;
}

}  // namespace

SwitchedGains read_switched_gains(ConfigSection& gains, const LawContext& context) {
  const Plant& plant = context.plant();
  SwitchedGains result;
  if (gains.has("L_c")) {
    ConfigSection modes = gains.section("L_c");
    for (const PlantMode& mode : plant.modes()) {
      result.L_c.push_back(read_gain_per_sensor(modes, label_of(mode), plant,
                                                SensorTiming::kContinuous, plant.states()));
    }
    modes.finish();
  }
  if (gains.has("L_d")) {
    ConfigSection modes = gains.section("L_d");
    const ExpressionReader reader({{"tau"}, {}, context.names.constants});
    for (const PlantMode& mode : plant.modes()) {
      result.L_d.push_back(read_gain_maps(modes, label_of(mode), plant, reader));
    }
    modes.finish();
  }
  if (gains.has("metric")) {
    ConfigSection modes = gains.section("metric");
    for (const PlantMode& mode : plant.modes()) {
      result.metrics.push_back(modes.matrix(label_of(mode), plant.states(), plant.states()));
    }
    modes.finish();
  }
  if (gains.has("projection")) {
    ConfigSection modes = gains.section("projection");
    for (const PlantMode& mode : plant.modes()) {
      result.P.emplace_back();
      if (!modes.has(label_of(mode))) continue;
      result.P.back() = modes.matrix(label_of(mode), plant.states(), plant.states());
    }
    modes.finish();
  }
  return result;
}

}  // namespace sampled_data_observers
