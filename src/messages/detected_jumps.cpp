#include "messages/detected_jumps.h"

#include <algorithm>
#include <utility>

namespace sampled_data_observers {

DetectedJumps::DetectedJumps(std::unique_ptr<MessageSource> signal, std::size_t fields,
                             DetectorConfig config)
    : signal_(std::move(signal)),
      config_(std::move(config)),
      detector_(config_.options),
      fields_(detector_.most_samples_ago() + 1, std::vector<double>(fields)),
      values_(config_.outputs ? static_cast<std::size_t>(config_.outputs->size()) : 0),
      clock_(config_.jump_back_tolerance) {}

ros::Subscriber DetectedJumps::subscribe(ros::NodeHandle& handle, std::uint32_t queue_length,
                                         const Receiver& receive) const {
  return signal_->subscribe(handle, queue_length, receive);
}

MessagePointer DetectedJumps::deserialize(std::uint8_t* data, std::uint32_t size,
                                          const Connection& connection) const {
  return signal_->deserialize(data, size, connection);
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
  if (receipt > 0 && sample.stamp - receipt > config_.future_tolerance) return Reading::kInFuture;
  switch (take(sample)) {
    case JumpDetector::Finding::kJump:
      tell(event);
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

JumpDetector::Finding DetectedJumps::take(const Event& sample) {
  double value = 0.0;
  double energy = 0.0;
  config_.signal->evaluate(sample.values, nullptr, &value);
  if (config_.energy) config_.energy->evaluate(sample.values, nullptr, &energy);
  const JumpDetector::Finding finding = detector_.add(sample.stamp, value, energy);
  const bool is_taken =
      finding == JumpDetector::Finding::kJump || finding == JumpDetector::Finding::kNothing;
  if (is_taken) {
    std::copy_n(sample.values, fields_[next_].size(), fields_[next_].begin());
    next_ = (next_ + 1) % fields_.size();
  }
  return finding;
}

const double* DetectedJumps::fields(std::size_t samples_ago) const {
  return fields_[(next_ + fields_.size() - 1 - samples_ago) % fields_.size()].data();
}

/// Writes the jump just found.
void DetectedJumps::tell(Event& event) {
  event.stamp = detector_.crossing();
  if (config_.outputs) {
    config_.outputs->evaluate(fields(detector_.samples_ago()), nullptr, values_.data());
    event.values = values_.data();
    event.size = static_cast<Eigen::Index>(values_.size());
  }
  if (config_.mode) {
    double mode = 0.0;
    config_.mode->evaluate(fields(0), nullptr, &mode);
    event.mode = mode;
  }
}

}  // namespace sampled_data_observers
