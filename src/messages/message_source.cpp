#include "sampled_data_observers/messages/message_source.h"

#include <ros/names.h>

#include <utility>

#include "messages/detected_jumps.h"
#include "messages/types/message_types.h"

namespace sampled_data_observers {
namespace {

MessageTypes all_types() {
  MessageTypes types;
  add_own_types(types);
  add_std_types(types);
  add_geometry_types(types);
  add_stamped_geometry_types(types);
  add_nav_types(types);
  add_sensor_types(types);
  return types;
}

}  // namespace

EventOutcome outcome_of(Reading reading) {
  switch (reading) {
    case Reading::kNoTransform:
      return EventOutcome::kNoTransform;
    case Reading::kNoField:
      return EventOutcome::kNoField;
    case Reading::kInFuture:
      return EventOutcome::kInFuture;
    case Reading::kOutOfOrder:
      return EventOutcome::kOutOfOrder;
    case Reading::kDropped:
      return EventOutcome::kDropped;
    case Reading::kNotFinite:
      return EventOutcome::kNotFinite;
    case Reading::kEvent:
    case Reading::kPassedOver:
      break;
  }
  return EventOutcome::kUsed;
}

std::unique_ptr<MessageSource> make_message_source(
    const TopicSource& source, std::shared_ptr<const TransformBuffer> transforms) {
  std::string fault;
  if (!ros::names::validate(source.topic, fault)) {
    throw ConfigError(source.origin, source.path + "/topic", "a name of a topic",
                      "'" + source.topic + "' (" + fault + ")");
  }
  static const MessageTypes kTypes = all_types();
  const auto found = kTypes.find(source.type);
  if (found != kTypes.end()) {
    std::unique_ptr<MessageSource> messages = found->second(source, std::move(transforms));
    if (!source.detector) return messages;
    return std::make_unique<DetectedJumps>(std::move(messages), source.fields.size(),
                                           *source.detector);
  }
  std::string known;
  for (const auto& [name, make] : kTypes) known += (known.empty() ? "" : ", ") + name;
  throw ConfigError(source.origin, source.path + "/type", "one of " + known,
                    "'" + source.type + "'");
}

}  // namespace sampled_data_observers
