#include "sampled_data_observers/config/plant_config.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "config/expression_config.h"
#include "config/fault_list.h"
#include "config/input_channels.h"
#include "config/mode_config.h"
#include "config/size_limits.h"
#include "plant/bias_states.h"

namespace sampled_data_observers {
namespace {

/// Names that are not empty and differ.
std::vector<std::string> read_names(ConfigSection& section, const std::string& key) {
  std::vector<std::string> names = section.texts(key);
  if (names.empty()) throw section.error(key, "at least one name", "an empty list");
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (name.empty()) throw section.error(key, "names that are not empty", "an empty one");
    if (!seen.insert(name).second) {
      throw section.error(key, "different names", "'" + name + "' twice");
    }
  }
  return names;
}

Integration read_integration(ConfigSection& plant) {
  Integration integration;
  if (!plant.has("integration")) return integration;
  ConfigSection section = plant.section("integration");
  const double step = section.number_in("step", 1e-9, 1e3, to_seconds(integration.step));
  integration.step = from_seconds(step);
  integration.horizon = from_seconds(section.number_in("horizon", step, 1e9, 1e5 * step));
  section.finish();
  return integration;
}

int read_label(const ConfigSection& modes, const std::string& key) {
  const bool digits =
      !key.empty() && key.size() < 10 &&
      std::all_of(key.begin(), key.end(), [](char c) { return '0' <= c && c <= '9'; });
  if (!digits) throw modes.error(key, "a whole number as label of the mode", "'" + key + "'");
  return std::stoi(key);
}

SensorTiming read_timing(ConfigSection& sensor) {
  if (!sensor.has("measured")) return SensorTiming::kSampled;
  const std::string timing = sensor.choice("measured", {"sampled", "continuous", "at_jumps"});
  if (timing == "continuous") return SensorTiming::kContinuous;
  return timing == "at_jumps" ? SensorTiming::kAtJumps : SensorTiming::kSampled;
}

std::size_t variables_of(const PlantDescription& plant) {
  std::size_t variables = plant.state_names.size() + plant.input_names.size();
  for (const Sensor& sensor : plant.sensors) {
    variables += static_cast<std::size_t>(sensor.outputs());
  }
  return variables;
}

std::vector<std::string> sorted_keys(const ConfigSection& section) {
  // The parameter server knows no order of keys, so the file's order can't count.
  std::vector<std::string> names = section.keys();
  std::sort(names.begin(), names.end());
  return names;
}

/// Which outputs of a sensor are angles, as the fields of its source say: rolls, pitches and yaws
/// of orientations, as they are. A joint may have such a name, and turn as often as it likes.
std::vector<bool> angles_among(ConfigSection& sensor, std::size_t outputs) {
  std::vector<bool> angular(outputs, false);
  if (!sensor.is_map("source")) return angular;
  ConfigSection source = sensor.section("source");
  if (!source.is_list("fields") || source.has("scale") || source.has("offset")) return angular;
  if (source.has("type") && source.text("type") == "sensor_msgs/JointState") return angular;
  const std::vector<std::string> fields = source.texts("fields");
  for (std::size_t i = 0; i < std::min(outputs, fields.size()); ++i) {
    const std::string last = fields[i].substr(fields[i].rfind('.') + 1);
    angular[i] = last == "roll" || last == "pitch" || last == "yaw";
  }
  return angular;
}

class PlantReader {
 public:
  PlantReader(ConfigSection& root, const PlantPluginLoader& load_plugin)
      : section_(root.section("plant")), sensors_(root.section("sensors")) {
    names_.constants = read_constants(section_, "parameters");
    if (section_.has("plugin")) {
      read_plugin(load_plugin);
    } else {
      names_.x = read_names(section_, "states");
      if (section_.has("inputs") || section_.has("B")) names_.u = read_names(section_, "inputs");
      require_bounded(names_.x.size() + names_.u.size(), 1, kMostVariables, section_, "states");
    }
    plant_.state_names = names_.x;
    plant_.input_names = names_.u;
    // All that takes no more than the names of states and inputs is read on.
    FaultList faults;
    if (plant_.modes.empty()) faults.attempt([&] { read_modes(); });
    faults.attempt([&] { plant_.integration = read_integration(section_); });
    const bool has_modes = !faults.any();
    faults.attempt([&] { read_unit_norms(); });
    ConfigSection units = section_.section_or_empty("units");
    if (has_modes) {
      faults.attempt([&] {
        complete_sets("jump_set", &PlantMode::jump_set);
        complete_sets("flow_set", &PlantMode::flow_set);
        section_.finish();
      });
    }
    if (sensors_.keys().empty()) faults.add(root.error("sensors", "at least one sensor", "none"));
    for (const std::string& name : sorted_keys(sensors_)) {
      faults.attempt([&] { read_sensor(name); });
    }
    faults.attempt([&] {
      plant_.input_channels = read_input_channels(root, names_.u, sorted_keys(sensors_));
    });
    faults.require_none();
    check_outputs_of_modes();
    read_units(units);
    require_bounded(variables_of(plant_) + biases_.size(), plant_.modes.size(), kMostVariables,
                    root, "plant");
  }

  PlantConfig finish() {
    PlantDescription extended = with_bias_states(std::move(plant_), biases_);
    names_.x = extended.state_names;
    return {std::make_shared<const Plant>(std::move(extended)), std::move(names_),
            std::move(units_)};
  }

 private:
  void read_plugin(const PlantPluginLoader& load_plugin) {
    const std::string type = section_.text("plugin");
    try {
      const std::map<std::string, double> parameters(names_.constants.begin(),
                                                     names_.constants.end());
      compiled_ = load_plugin(type)->build(parameters);
    } catch (const std::exception& fault) {
      throw section_.error("plugin", "a plant that can be built",
                           "'" + type + "': " + fault.what());
    }
    names_.x = compiled_.state_names;
    names_.u = compiled_.input_names;
    PlantMode mode;
    mode.flow = compiled_.flow;
    mode.jump = compiled_.jump;
    plant_.modes.push_back(std::move(mode));
  }

  void read_unit_norms() {
    const char* const key = "unit_norm";
    if (!section_.has(key)) return;
    for (const PlantMode& mode : plant_.modes) {
      if (mode.flow->affine() == nullptr) continue;
      throw section_.error(key, "none for a plant whose flow is linear: write the flow as formulas",
                           "groups of states");
    }
    std::set<std::string> taken;
    for (const std::vector<std::string>& names : section_.text_lists(key)) {
      if (names.size() < 2) {
        throw section_.error(key, "at least two states in each group",
                             std::to_string(names.size()));
      }
      std::vector<Eigen::Index>& group = plant_.unit_norms.emplace_back();
      for (const std::string& name : names) {
        const auto found = std::find(names_.x.begin(), names_.x.end(), name);
        if (found == names_.x.end()) {
          throw section_.error(key, "names of states", "'" + name + "'");
        }
        if (!taken.insert(name).second) {
          throw section_.error(key, "each state once", "'" + name + "' twice");
        }
        group.push_back(found - names_.x.begin());
      }
    }
  }

  std::shared_ptr<const VectorMap> read_set(ConfigSection& section, const std::string& key) {
    if (!section.has(key)) return nullptr;
    return ExpressionReader(names_).read_list(section, key, 0);
  }

  /// Modes without a set of their own have the plant's; either all have one, or none has.
  void complete_sets(const std::string& key, std::shared_ptr<const VectorMap> PlantMode::*set) {
    const std::shared_ptr<const VectorMap> common = read_set(section_, key);
    const VectorMap* first = nullptr;
    for (PlantMode& mode : plant_.modes) {
      if (!(mode.*set)) mode.*set = common;
      if (first == nullptr) first = (mode.*set).get();
    }
    if (first == nullptr) return;
    for (const PlantMode& mode : plant_.modes) {
      const VectorMap* own = (mode.*set).get();
      if (own != nullptr && own->size() == first->size()) continue;
      throw section_.error("modes",
                           key +
                               " in each mode, or in the plant for all others, with as many "
                               "formulas in each",
                           own == nullptr ? "none in mode " + std::to_string(mode.label)
                                          : "another number in mode " + std::to_string(mode.label));
    }
  }

  void read_modes() {
    if (!section_.has("modes")) {
      PlantMode mode;
      mode.flow = read_flow_map(section_, names_);
      mode.jump = read_jump_map(section_, names_);
      plant_.modes.push_back(std::move(mode));
      return;
    }
    ConfigSection modes = section_.section("modes");
    std::map<int, std::string> keys;
    for (const std::string& key : modes.keys()) keys.emplace(read_label(modes, key), key);
    require_at_most(kMostModes, keys.size(), "modes", section_, "modes");
    if (keys.empty()) throw section_.error("modes", "at least one mode", "none");
    for (const auto& [label, key] : keys) {
      PlantMode mode;
      mode.label = label;
      ConfigSection section = modes.section(key);
      mode.flow = read_flow_map(section, names_);
      mode.jump = read_jump_map(section, names_);
      mode.jump_set = read_set(section, "jump_set");
      mode.flow_set = read_set(section, "flow_set");
      outputs_of_modes_.push_back(section.section_or_empty("outputs"));
      section.finish();
      plant_.modes.push_back(std::move(mode));
    }
    modes.finish();
  }

  void read_sensor(const std::string& name) {
    ConfigSection section = sensors_.section(name);
    const std::shared_ptr<const VectorMap> map = read_output(section);
    Sensor sensor;
    sensor.name = name;
    sensor.timing = read_timing(section);
    const auto outputs = static_cast<std::size_t>(map->size());
    sensor.angular =
        section.has("angular") ? section.flags("angular", outputs) : angles_among(section, outputs);
    read_biases(section, outputs);
    for (std::size_t mode = 0; mode < plant_.modes.size(); ++mode) {
      plant_.modes[mode].outputs.push_back(output_in_mode(mode, name, map));
    }
    plant_.sensors.push_back(std::move(sensor));
  }

  std::shared_ptr<const VectorMap> read_output(ConfigSection& section) {
    if (section.has("d") && !section.has("C")) {
      throw section.error("d", "the key C beside it: y = C x + d", "none");
    }
    if (!section.has("output") || compiled_.flow == nullptr) {
      return read_output_map(section, names_);
    }
    std::vector<std::string> known;
    for (const auto& output : compiled_.outputs) known.push_back(output.first);
    return compiled_.outputs.at(section.choice("output", known));
  }

  std::shared_ptr<const VectorMap> output_in_mode(std::size_t mode, const std::string& name,
                                                  const std::shared_ptr<const VectorMap>& map) {
    if (outputs_of_modes_.empty() || !outputs_of_modes_[mode].has(name)) return map;
    ConfigSection section = outputs_of_modes_[mode].section(name);
    std::shared_ptr<const VectorMap> own = read_output_map(section, names_);
    section.finish();
    if (own->size() != map->size()) {
      throw outputs_of_modes_[mode].error(name, std::to_string(map->size()) + " outputs",
                                          std::to_string(own->size()));
    }
    return own;
  }

  void read_biases(ConfigSection& section, std::size_t outputs) {
    if (!section.has("bias")) return;
    const std::vector<std::string> names = section.texts("bias", outputs);
    for (std::size_t output = 0; output < outputs; ++output) {
      if (names[output].empty()) continue;
      const auto is_taken = [&](const std::string& taken) { return taken == names[output]; };
      if (std::any_of(plant_.state_names.begin(), plant_.state_names.end(), is_taken) ||
          std::any_of(biases_.begin(), biases_.end(),
                      [&](const BiasState& bias) { return is_taken(bias.name); })) {
        throw section.error("bias", "names that no other state has", "'" + names[output] + "'");
      }
      biases_.push_back({names[output], plant_.sensors.size(), static_cast<Eigen::Index>(output)});
    }
  }

  void read_units(ConfigSection& section) {
    std::set<std::string> known(names_.x.begin(), names_.x.end());
    known.insert(names_.u.begin(), names_.u.end());
    for (const BiasState& bias : biases_) known.insert(bias.name);
    for (const Sensor& sensor : plant_.sensors) known.insert(sensor.name);
    for (const std::string& name : section.keys()) {
      if (known.count(name) == 0) {
        throw section.error(name, "the name of a state, an input or a sensor",
                            "none that is called '" + name + "'");
      }
      units_[name] = section.text(name);
    }
    section.finish();
  }

  void check_outputs_of_modes() const {
    for (const ConfigSection& outputs : outputs_of_modes_) outputs.finish();
  }

  ConfigSection section_;
  ConfigSection sensors_;
  ExpressionNames names_;
  PlantDescription plant_;
  CompiledPlant compiled_;
  std::vector<ConfigSection> outputs_of_modes_;
  std::vector<BiasState> biases_;
  Units units_;
};

}  // namespace

PlantConfig read_plant(ConfigSection& root, const PlantPluginLoader& load_plugin) {
  return PlantReader(root, load_plugin).finish();
}

}  // namespace sampled_data_observers
