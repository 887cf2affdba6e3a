#include "sampled_data_observers/config/topic_config.h"

namespace sampled_data_observers {
namespace {

const char kMeasurementType[] = "sampled_data_observers/Measurement";
const char kInputType[] = "sampled_data_observers/Input";
const char kJumpType[] = "sampled_data_observers/JumpEvent";

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

TopicSource read_message_source(const ConfigSection& root, ConfigSection& section,
                                const std::string& key, std::size_t size, const std::string& type) {
  TopicSource source;
  source.topic = section.text("topic", key);
  source.type = type;
  source.size = size;
  source.origin = root.origin();
  source.path = key;
  return source;
}

}  // namespace

std::vector<std::optional<TopicSource>> read_sensor_sources(ConfigSection& root,
                                                            const Plant& plant) {
  std::vector<std::optional<TopicSource>> sources;
  ConfigSection sensors = root.section("sensors");
  for (const Sensor& sensor : plant.sensors()) {
    ConfigSection section = sensors.section(sensor.name);
    for (const char* key : {"C", "h", "output", "measured", "angular", "bias", "gate"}) {
      section.has(key);
    }
    const bool in_jump_events = sensor.timing == SensorTiming::kAtJumps && !section.has("source");
    sources.push_back(in_jump_events ? std::nullopt
                                     : std::optional<TopicSource>(read_sensor_source(
                                           section.section("source"),
                                           static_cast<std::size_t>(sensor.outputs()))));
    section.finish();
  }
  return sources;
}

TopicSource read_input_source(ConfigSection& root, const Plant& plant) {
  ConfigSection section = root.section_or_empty("input");
  TopicSource source =
      read_message_source(root, section, "input", plant.input_names().size(), kInputType);
  section.finish();
  return source;
}

TopicSource read_jump_source(const ConfigSection& root, ConfigSection& section,
                             const Plant& plant) {
  TopicSource source = read_message_source(
      root, section, "jumps", static_cast<std::size_t>(plant.outputs(SensorTiming::kAtJumps)),
      kJumpType);
  source.has_mode = plant.switches();
  return source;
}

}  // namespace sampled_data_observers
