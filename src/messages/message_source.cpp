#include "sampled_data_observers/messages/message_source.h"

#include <ros/names.h>

#include <utility>

#include "messages/decoded_source.h"
#include "messages/definition/installed_definitions.h"
#include "messages/detected_jumps.h"
#include "messages/own_source.h"
#include "messages/transform_source.h"

namespace sampled_data_observers {
namespace {

template <class M>
bool is_of(const TopicSource& source) {
  return source.type == ros::message_traits::DataType<M>::value();
}

std::shared_ptr<const MessageDefinition> definition_of(const TopicSource& source) {
  try {
    return installed_definition(source.type);
  } catch (const DefinitionError& error) {
    throw ConfigError(source.origin, source.path + "/type", "a message type that is installed",
                      "'" + source.type + "', which " + error.what());
  }
}

std::unique_ptr<MessageSource> make_plain_source(
    const TopicSource& source, std::shared_ptr<const TransformBuffer> transforms,
    std::shared_ptr<const MessageDefinition> definition) {
  if (is_of<Measurement>(source)) return std::make_unique<OwnSource<Measurement>>(source);
  if (is_of<Input>(source)) return std::make_unique<OwnSource<Input>>(source);
  if (is_of<JumpEvent>(source)) return std::make_unique<OwnSource<JumpEvent>>(source);
  if (source.frames.are_wanted_themselves()) {
    return std::make_unique<TransformSource>(source, std::move(transforms));
  }
  if (definition == nullptr) definition = definition_of(source);
  return std::make_unique<DecodedSource>(source, std::move(definition), std::move(transforms));
}

}  // namespace

EventOutcome outcome_of(Reading reading) {
  switch (reading) {
    case Reading::kNoTransform:
      return EventOutcome::kNoTransform;
    case Reading::kNoField:
      return EventOutcome::kNoField;
    case Reading::kOutOfLimits:
      return EventOutcome::kOutOfLimits;
    case Reading::kInFuture:
      return EventOutcome::kInFuture;
    case Reading::kOutOfOrder:
      return EventOutcome::kOutOfOrder;
    case Reading::kDropped:
      return EventOutcome::kDropped;
    case Reading::kNotFinite:
      return EventOutcome::kNotFinite;
    case Reading::kOtherDefinition:
      return EventOutcome::kOtherDefinition;
    case Reading::kMalformed:
      return EventOutcome::kMalformed;
    case Reading::kNoCovariance:
      return EventOutcome::kNoCovariance;
    case Reading::kBeforeDatum:
      return EventOutcome::kTooOld;
    case Reading::kEvent:
    case Reading::kPassedOver:
      break;
  }
  return EventOutcome::kUsed;
}

std::unique_ptr<MessageSource> make_message_source(
    const TopicSource& source, std::shared_ptr<const TransformBuffer> transforms,
    std::shared_ptr<const MessageDefinition> definition) {
  const bool is_live = definition == nullptr;
  std::string fault;
  if (is_live && !ros::names::validate(source.topic, fault)) {
    throw ConfigError(source.origin, source.path + "/topic", "a name of a topic",
                      "'" + source.topic + "' (" + fault + ")");
  }
  std::unique_ptr<MessageSource> messages =
      make_plain_source(source, std::move(transforms), std::move(definition));
  if (!source.detector) return messages;
  return std::make_unique<DetectedJumps>(std::move(messages), source.fields.size(),
                                         *source.detector);
}

}  // namespace sampled_data_observers
