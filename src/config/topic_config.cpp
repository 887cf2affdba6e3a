#include "sampled_data_observers/config/topic_config.h"

#include <utility>

#include "config/fault_list.h"
#include "config/input_channels.h"
#include "config/value_correction_config.h"

namespace sampled_data_observers {
namespace {

const char kMeasurementType[] = "sampled_data_observers/Measurement";
const char kInputType[] = "sampled_data_observers/Input";
const char kJumpType[] = "sampled_data_observers/JumpEvent";
/// In place of a message type: the pose of a frame in another, as tf has it.
const char kTransformType[] = "tf";

const char kInputs[] = "inputs";
/// Of sources of inputs: see read_input_channels().
const std::vector<const char*> kTimeoutKeys = {"timeout", "after_timeout"};

constexpr double kLongestInterval = 1e6;  // s

/// What all sources have in common.
/// @param topic  the default; empty: the key is required
/// @param type  the package's own for this use, the default; empty: the key is required
TopicSource read_source(ConfigSection& section, const std::string& topic, const std::string& type) {
  TopicSource source;
  source.type = type.empty() ? section.text("type") : section.text("type", type);
  const bool is_transform = source.type == kTransformType;
  if (is_transform) {
    if (section.has("topic")) {
      throw section.error("topic", "none: transforms come on /tf",
                          "'" + section.text("topic") + "'");
    }
    source.topic = "/tf";
    source.type = "tf2_msgs/TFMessage";
  } else {
    source.topic = topic.empty() ? section.text("topic") : section.text("topic", topic);
  }
  for (const char* own : {kMeasurementType, kInputType, kJumpType}) {
    const bool is_signal = type.empty() && source.type != kJumpType;
    if (source.type == own && source.type != type && !is_signal) {
      throw section.error("type",
                          (type.empty() ? "" : type + " or ") + "a message type of another package",
                          "'" + source.type + "'");
    }
  }
  if (section.has("stamp")) {
    source.stamped_on_receipt = section.choice("stamp", {"header", "receipt"}) == "receipt";
  }
  source.stamp_offset = read_stamp_offset(section);
  source.frames = is_transform ? read_transform_frames(section) : read_source_frames(section);
  source.origin = section.origin();
  source.path = section.path();
  return source;
}

/// The source of values that are always there.
/// @param fields  where they were read already
/// @param more_keys  that the source may have, and others read
TopicSource read_value_source(ConfigSection& section, const std::string& topic,
                              const std::string& type, std::size_t size,
                              std::vector<std::string> fields = {},
                              const std::vector<const char*>& more_keys = {}) {
  TopicSource source = read_source(section, topic, type);
  source.size = size;
  source.fields = std::move(fields);
  if (source.fields.empty() && section.has("fields")) {
    source.fields = section.texts("fields", size);
  }
  source.min_interval = from_seconds(section.number_in("min_interval", 0.0, kLongestInterval, 0.0));
  source.correction = read_value_correction(section, size);
  for (const char* key : more_keys) section.has(key);
  section.finish();
  return source;
}

/// The fields of a map that names inputs, in the order of the channel's.
std::vector<std::string> read_input_fields(ConfigSection& section, const InputChannel& channel,
                                           const Plant& plant) {
  ConfigSection map = section.section("fields");
  std::vector<std::string> fields;
  for (const Eigen::Index input : channel.inputs) {
    fields.push_back(map.text(plant.input_names()[static_cast<std::size_t>(input)]));
  }
  return fields;
}

/// Jumps that a detector finds.
TopicSource read_detected_jumps(ConfigSection& section, const Plant& plant) {
  TopicSource source = read_detector_source(section.section("detector"));
  if (plant.switches() != (source.detector->mode != nullptr)) {
    throw section.section("detector")
        .error("mode",
               plant.switches() ? "a formula of the mode that follows, for a switched plant"
                                : "none for a plant of one mode",
               plant.switches() ? "nothing (the key is missing)" : "one");
  }
  const Eigen::Index expected = plant.outputs(SensorTiming::kAtJumps);
  const VectorMap* outputs = source.detector->outputs.get();
  if (outputs != nullptr && outputs->size() != expected) {
    throw section.section("detector")
        .error("outputs",
               std::to_string(expected) +
                   " formulas, for the outputs of the sensors measured at jumps",
               std::to_string(outputs->size()));
  }
  return source;
}

}  // namespace

bool TopicSource::is_of_own_type() const {
  return type == kMeasurementType || type == kInputType || type == kJumpType;
}

std::vector<std::optional<TopicSource>> read_sensor_sources(ConfigSection& root,
                                                            const Plant& plant) {
  std::vector<std::optional<TopicSource>> sources;
  ConfigSection sensors = root.section("sensors");
  FaultList faults;
  const auto read_sensor_source = [&](const Sensor& sensor) {
    ConfigSection section = sensors.section(sensor.name);
    for (const char* key :
         {"C", "d", "h", "output", "measured", "angular", "bias", "gate", "sampling"}) {
      section.has(key);
    }
    const bool in_jump_events = sensor.timing == SensorTiming::kAtJumps && !section.has("source");
    sources.emplace_back();
    if (!in_jump_events) {
      ConfigSection source = section.section("source");
      sources.back() = read_value_source(source, "", kMeasurementType,
                                         static_cast<std::size_t>(sensor.outputs()));
    }
    section.finish();
  };
  for (const Sensor& sensor : plant.sensors()) {
    faults.attempt([&] { read_sensor_source(sensor); });
  }
  faults.require_none();
  return sources;
}

std::vector<TopicSource> read_input_sources(ConfigSection& root, const Plant& plant) {
  std::vector<TopicSource> sources;
  if (plant.inputs() == 0) return sources;
  if (!root.has(kInputs)) {
    ConfigSection section = root.section_or_empty("input");
    sources.push_back(read_value_source(section, "input", kInputType, plant.input_names().size(),
                                        {}, kTimeoutKeys));
    if (sources.back().origin.empty()) sources.back().origin = root.origin();  // no such section
    return sources;
  }
  ConfigSection sections = root.section(kInputs);
  for (const InputChannel& channel : plant.input_channels()) {
    ConfigSection section = sections.section(channel.name);
    std::vector<std::string> fields;
    if (section.is_map("fields")) fields = read_input_fields(section, channel, plant);
    const auto size = static_cast<std::size_t>(channel.size());
    sources.push_back(
        read_value_source(section, "", kInputType, size, std::move(fields), kTimeoutKeys));
  }
  sections.finish();
  return sources;
}

TopicSource read_detector_source(ConfigSection section) {
  ConfigSection messages = section.section("source");
  TopicSource source = read_source(messages, "", "");
  ConfigSection fields = messages.section("fields");
  const std::vector<std::string> names = fields.keys();
  for (const std::string& name : names) source.fields.push_back(fields.text(name));
  source.size = names.size();
  messages.finish();
  source.of_jumps = true;
  source.detector = read_detector(section, names);
  section.finish();
  return source;
}

TopicSource read_jump_source(const ConfigSection& root, ConfigSection& section,
                             const Plant& plant) {
  if (section.has("detector")) return read_detected_jumps(section, plant);
  TopicSource source = read_source(section, "jumps", kJumpType);
  if (source.origin.empty()) source.origin = root.origin();  // there is no such section
  source.of_jumps = true;
  source.size = static_cast<std::size_t>(plant.outputs(SensorTiming::kAtJumps));
  source.has_mode = plant.switches();
  if (section.has("fields")) source.fields = section.texts("fields", source.size);
  if (source.has_mode) source.mode = section.text("mode", "");
  return source;
}

}  // namespace sampled_data_observers
