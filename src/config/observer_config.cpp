#include "sampled_data_observers/config/observer_config.h"

#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/config/law_registry.h"
#include "sampled_data_observers/config/plant_config.h"
#include "sampled_data_observers/config/yaml_file.h"

namespace sampled_data_observers {
namespace {

constexpr double kShortest = 1e-9;  // s: one tick of the clock
constexpr double kLongest = 1e6;    // s

const char kMeasurementType[] = "sampled_data_observers/Measurement";
const char kInputType[] = "sampled_data_observers/Input";
const char kJumpType[] = "sampled_data_observers/JumpEvent";

SamplingBounds read_sampling(ConfigSection& root) {
  ConfigSection section = root.section("sampling");
  const double T1 = section.number_in("T1", kShortest, kLongest, std::nullopt);
  const double T2 = section.number_in("T2", kShortest, kLongest, std::nullopt);
  if (T1 > T2) throw section.error("T2", "a number not less than T1", "T1 > T2");
  section.finish();
  return {from_seconds(T1), from_seconds(T2)};
}

Timeline::Limits read_history(ConfigSection& root) {
  Timeline::Limits limits;
  limits.history = from_seconds(2.0);
  limits.max_events = 2000;
  if (!root.has("history")) return limits;
  ConfigSection section = root.section("history");
  limits.history = from_seconds(section.number_in("duration", kShortest, kLongest, 2.0));
  limits.max_events = section.count("max_events", 1, 1000000, 2000);
  section.finish();
  return limits;
}

TopicSource read_sensor_source(ConfigSection section, std::size_t size) {
  TopicSource source;
  source.topic = section.text("topic");
  source.type = section.text("type", kMeasurementType);
  if (source.type == kInputType || source.type == kJumpType) {
    throw section.error("type", "a type that holds a sample", "'" + source.type + "'");
  }
  if (section.has("fields")) source.fields = section.texts("fields", size);
  source.size = size;
  source.origin = section.origin();
  source.path = section.path();
  section.finish();
  return source;
}

TopicSource read_message_source(ConfigSection& root, const std::string& key, std::size_t size,
                                const std::string& type) {
  TopicSource source;
  source.topic = key;
  source.type = type;
  source.size = size;
  source.origin = root.origin();
  source.path = key;
  if (!root.has(key)) return source;
  ConfigSection section = root.section(key);
  source.topic = section.text("topic", key);
  section.finish();
  return source;
}

Eigen::VectorXd read_named_values(ConfigSection& root, const std::string& key,
                                  const std::vector<std::string>& names) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(names.size()));
  if (!root.has(key)) return values;
  ConfigSection section = root.section(key);
  for (std::size_t i = 0; i < names.size(); ++i) {
    values(static_cast<Eigen::Index>(i)) = section.number(names[i]);
  }
  section.finish();
  return values;
}

}  // namespace

ObserverConfig read_observer_config(const ConfigNode& tree) {
  ConfigSection root(tree, "");
  ObserverConfig config;
  config.type = root.choice("observer", observer_types());
  config.plant = read_linear_plant(root);
  const LinearPlantDescription& plant = config.plant->description();

  ConfigSection sensors = root.section("sensors");
  for (const Sensor& sensor : plant.sensors) {
    ConfigSection section = sensors.section(sensor.name);
    for (const char* key : {"C", "angular", "bias"}) section.has(key);
    config.sensors.push_back(
        read_sensor_source(section.section("source"), static_cast<std::size_t>(sensor.C.rows())));
    section.finish();
  }
  if (config.plant->inputs() > 0) {
    config.input = read_message_source(root, "input", plant.input_names.size(), kInputType);
  }
  if (config.plant->jumps()) {
    config.jumps = read_message_source(root, "jumps", 0, kJumpType);
  }

  LawContext context;
  context.plant = config.plant;
  context.initial_estimate = read_named_values(root, "initial_estimate", plant.state_names);
  context.initial_input = Eigen::VectorXd::Zero(config.plant->inputs());
  ConfigSection gains = root.section("gains");
  config.law = build_law(config.type, gains, context);
  gains.finish();

  config.options.sampling = read_sampling(root);
  config.options.history = read_history(root);
  config.options.future_tolerance =
      from_seconds(root.number_in("future_tolerance", 0.0, kLongest, 0.5));
  config.period = from_seconds(1.0 / root.number_in("rate", 1e-3, 1e5, 100.0));
  config.publish_delay = from_seconds(root.number_in("publish_delay", 0.0, kLongest, 0.0));
  config.frame_id = root.text("frame_id", "");
  // Otherwise stamps would leave the window before they are due, or an event from the tolerated
  // future would push all present ones out of it.
  if (config.publish_delay >= config.options.history.history) {
    throw root.error("publish_delay", "less than history/duration", "as much or more");
  }
  if (config.options.future_tolerance >= config.options.history.history) {
    throw root.error("future_tolerance", "less than history/duration (it is 0.5 where not given)",
                     "as much or more");
  }
  root.finish();
  return config;
}

ObserverConfig read_observer_config(const std::vector<std::string>& files) {
  std::vector<ConfigNode> trees;
  for (const std::string& file : files) trees.push_back(read_yaml_file(file));
  return read_observer_config(merge(trees));
}

}  // namespace sampled_data_observers
