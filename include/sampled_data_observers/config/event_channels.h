#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/hybrid/event.h"

namespace sampled_data_observers {

/// One place where events enter: a topic, and what its messages mean.
struct EventChannel {
  /// Of the events that its messages become.
  EventKind kind = EventKind::kSample;
  int sensor = 0;  ///< index of it, for what is measured; of a channel of inputs
  /// Name in EventStatus: the sensor's, that of a channel of inputs, or "jumps".
  std::string name;
  /// The topic, and how its messages are read.
  TopicSource source;
  /// Place among all channels of the configuration.
  std::size_t index = 0;
};

/// What the values of a sensor are as events.
EventKind kind_of(SensorTiming timing);

/// All channels of a configuration: the sensors in order, then inputs and jumps where there are
/// any.
std::vector<EventChannel> event_channels(const ObserverConfig& config);

/// Whether the data of some channel are to be transformed.
bool has_frames(const ObserverConfig& config);

}  // namespace sampled_data_observers
