#include "sampled_data_observers/config/event_channels.h"

#include <algorithm>

namespace sampled_data_observers {

EventKind kind_of(SensorTiming timing) {
  switch (timing) {
    case SensorTiming::kSampled:
      return EventKind::kSample;
    case SensorTiming::kContinuous:
      return EventKind::kOutput;
    case SensorTiming::kAtJumps:
      break;
  }
  return EventKind::kJumpOutput;
}

std::vector<EventChannel> event_channels(const ObserverConfig& config) {
  std::vector<EventChannel> channels;
  const auto add = [&](EventKind kind, int sensor, const std::string& name,
                       const TopicSource& source) {
    channels.push_back({kind, sensor, name, source, channels.size()});
  };
  for (std::size_t i = 0; i < config.sensors.size(); ++i) {
    if (!config.sensors[i]) continue;
    const Sensor& sensor = config.plant->sensors()[i];
    add(kind_of(sensor.timing), static_cast<int>(i), sensor.name, *config.sensors[i]);
  }
  for (std::size_t i = 0; i < config.inputs.size(); ++i) {
    const std::string& name = config.plant->input_channels()[i].name;
    add(EventKind::kInput, static_cast<int>(i), name, config.inputs[i]);
  }
  if (config.jumps) add(EventKind::kJump, 0, "jumps", *config.jumps);
  return channels;
}

bool has_frames(const ObserverConfig& config) {
  const std::vector<EventChannel> channels = event_channels(config);
  return std::any_of(channels.begin(), channels.end(),
                     [](const EventChannel& channel) { return channel.source.frames.any(); });
}

}  // namespace sampled_data_observers
