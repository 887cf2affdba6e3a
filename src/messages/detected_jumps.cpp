#include "messages/detected_jumps.h"

#include <utility>

namespace sampled_data_observers {

DetectedJumps::DetectedJumps(std::unique_ptr<MessageSource> signal, const DetectorConfig& config)
    : signal_(std::move(signal)),
      formula_(config.signal),
      outputs_(config.outputs),
      detector_(config.options),
      future_tolerance_(config.future_tolerance),
      values_(outputs_ ? static_cast<std::size_t>(outputs_->size()) : 0),
      clock_(config.jump_back_tolerance) {}

ros::Subscriber DetectedJumps::subscribe(ros::NodeHandle& handle, std::uint32_t queue_length,
                                         const Receiver& receive) const {
  return signal_->subscribe(handle, queue_length, receive);
}

MessagePointer DetectedJumps::deserialize(std::uint8_t* data, std::uint32_t size) const {
  return signal_->deserialize(data, size);
}

Stamp DetectedJumps::stamp_of(const MessagePointer& message, Stamp receipt) const {
  return signal_->stamp_of(message, receipt);
}

Reading DetectedJumps::read(const MessagePointer& message, Stamp receipt, Event& event) {
  if (clock_.note(receipt) > 0) detector_.restart();
  event.size = 0;
  Event sample;
  const Reading reading = signal_->read(message, receipt, sample);
  event.stamp = sample.stamp;
  if (reading != Reading::kEvent) return reading;
  // Behind such a stamp all others would be out of order. Before a simulated clock begins, nobody
  // can tell.
  if (receipt > 0 && sample.stamp - receipt > future_tolerance_) return Reading::kInFuture;
  double value = 0.0;
  formula_->evaluate(sample.values, nullptr, &value);
  switch (detector_.add(sample.stamp, value)) {
    case JumpDetector::Finding::kJump:
      event.stamp = detector_.crossing();
      if (outputs_) {
        outputs_->evaluate(sample.values, nullptr, values_.data());
        event.values = values_.data();
        event.size = static_cast<Eigen::Index>(values_.size());
      }
      return Reading::kEvent;
    case JumpDetector::Finding::kOutOfOrder:
      return Reading::kOutOfOrder;
    case JumpDetector::Finding::kNotFinite:
      return Reading::kNotFinite;
    case JumpDetector::Finding::kNothing:
      break;
  }
  return Reading::kPassedOver;
}

}  // namespace sampled_data_observers
