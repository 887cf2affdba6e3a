#include "sampled_data_observers/messages/event_intake.h"

#include <utility>

#include "messages/queue_length.h"

namespace sampled_data_observers {

EventIntake::EventIntake(EventChannel channel, std::shared_ptr<MessageSource> source,
                         Handler handle)
    : channel_(std::move(channel)),
      source_(std::move(source)),
      handle_(std::move(handle)),
      waiting_(channel_.source.frames.any() ? kQueueLength : 0, channel_.source.frames.timeout) {
  missing_.reserve(kLongestPair);
}

void EventIntake::take(const MessagePointer& message, Stamp receipt, Stamp now) {
  Event event = make_event();
  const Reading reading = source_->read(message, receipt, event);
  if (reading == Reading::kPassedOver) return;
  if (reading == Reading::kNoTransform) {
    if (!waiting_.push({message, receipt, event.stamp}, now)) drop(message, event.stamp);
    return;
  }
  if (reading == Reading::kOtherDefinition) {
    handle_(channel_, event, reading, source_->describe_sender(message));
    return;
  }
  hand_over(event, reading);
}

void EventIntake::refuse(const std::string& sender) {
  handle_(channel_, make_event(), Reading::kOtherDefinition, sender);
}

void EventIntake::hand_over(const Event& event, Reading reading) {
  if (handle_(channel_, event, reading, {})) source_->confirm();
}

void EventIntake::lose(Stamp stamp, const std::string& note) {
  Event event = make_event();
  event.stamp = stamp;
  handle_(channel_, event, Reading::kDropped, note);
}

void EventIntake::retry(Stamp now) {
  const auto use = [this](const Waiting& waiting) {
    Event event = make_event();
    const Reading reading = source_->read(waiting.message, waiting.receipt, event);
    if (reading == Reading::kNoTransform) return false;
    if (reading != Reading::kPassedOver) hand_over(event, reading);
    return true;
  };
  waiting_.go_through(now, use, [this](const Waiting& waiting) { drop(waiting); });
}

void EventIntake::give_up() {
  waiting_.drop_all([this](const Waiting& waiting) { drop(waiting); });
}

Event EventIntake::make_event() const {
  Event event;
  event.kind = channel_.kind;
  event.sensor = channel_.sensor;
  return event;
}

void EventIntake::drop(const MessagePointer& message, Stamp stamp) {
  Event event = make_event();
  event.stamp = stamp;
  source_->name_missing_transform(message, stamp, missing_);
  handle_(channel_, event, Reading::kNoTransform, missing_);
}

}  // namespace sampled_data_observers
