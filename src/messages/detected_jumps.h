#pragma once

#include <memory>
#include <vector>

#include "sampled_data_observers/config/detector_config.h"
#include "sampled_data_observers/messages/message_source.h"
#include "sampled_data_observers/runtime/clock_jumps.h"

namespace sampled_data_observers {

/// Jumps that show in a signal: reads its messages from another source, and makes an event of each
/// jump found. When the time of receipt goes back by more than the tolerance, the clock was set:
/// the detector starts again.
class DetectedJumps : public MessageSource {
 public:
  /// @param signal  its values are those that the formulas take
  /// @param fields  how many they are
  DetectedJumps(std::unique_ptr<MessageSource> signal, std::size_t fields, DetectorConfig config);

  ros::Subscriber subscribe(ros::NodeHandle& handle, std::uint32_t queue_length,
                            const Receiver& receive) const override;
  MessagePointer deserialize(std::uint8_t* data, std::uint32_t size,
                             const Connection& connection) const override;
  Stamp stamp_of(const MessagePointer& message, Stamp receipt) const override;
  Reading read(const MessagePointer& message, Stamp receipt, Event& event) override;
  std::string md5sum() const override { return signal_->md5sum(); }
  std::string describe_sender(const MessagePointer& message) const override {
    return signal_->describe_sender(message);
  }
  void name_missing_transform(const MessagePointer& message, Stamp stamp,
                              std::string& text) const override {
    signal_->name_missing_transform(message, stamp, text);
  }

 private:
  JumpDetector::Finding take(const Event& sample);
  /// The fields of a sample before the newest one.
  const double* fields(std::size_t samples_ago) const;
  void tell(Event& event);

  std::unique_ptr<MessageSource> signal_;
  DetectorConfig config_;
  JumpDetector detector_;
  /// Of the samples that the detector may look back at, round about; the newest before next_.
  std::vector<std::vector<double>> fields_;
  std::size_t next_ = 0;
  std::vector<double> values_;
  ClockJumps clock_;
};

}  // namespace sampled_data_observers
