#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "messages/corrected_values.h"
#include "messages/decoded_fields.h"
#include "messages/definition/decoding_plan.h"
#include "messages/frame_blocks.h"
#include "messages/message_covariance.h"
#include "messages/raw_message.h"
#include "runtime/thinned_stamps.h"
#include "sampled_data_observers/messages/message_source.h"

namespace sampled_data_observers {

/// Messages of any type, by its definition. The first std_msgs/Header of a message gives stamp and
/// frame.
class DecodedSource : public MessageSource {
 public:
  /// @param definition  of the source's type
  /// @throws ConfigError
  DecodedSource(const TopicSource& source, std::shared_ptr<const MessageDefinition> definition,
                std::shared_ptr<const TransformBuffer> transforms);

  ros::Subscriber subscribe(ros::NodeHandle& handle, std::uint32_t queue_length,
                            const Receiver& receive) const override;
  MessagePointer deserialize(std::uint8_t* data, std::uint32_t size,
                             const Connection& connection) const override;
  Stamp stamp_of(const MessagePointer& message, Stamp receipt) const override;
  Reading read(const MessagePointer& message, Stamp receipt, Event& event) override;
  std::string md5sum() const override { return definition_->md5sum(); }
  std::string describe_sender(const MessagePointer& message) const override;
  void confirm() override { parts_.fields.confirm(); }
  void name_missing_transform(const MessagePointer& message, Stamp stamp,
                              std::string& text) const override;

 private:
  struct Parts {
    std::pair<std::size_t, std::size_t>
        stamp;  ///< slots, where messages are not stamped on receipt
    DecodedFields fields;
    std::optional<CovarianceFields> covariance;
    FrameBlocks frames;
    DecodingPlan plan;
  };
  static Parts compile(const TopicSource& source,
                       const std::shared_ptr<const MessageDefinition>& definition,
                       std::shared_ptr<LocalPlane> plane);
  bool add_covariance(Event& event);
  /// The stamp that a message carries; 0 where it is malformed.
  Stamp own_stamp(const RawMessage& message) const;

  std::string topic_;
  bool by_receipt_;
  bool has_mode_;
  Duration stamp_offset_;
  CorrectedValues corrected_;
  std::shared_ptr<const MessageDefinition> definition_;
  std::shared_ptr<const TransformBuffer> transforms_;
  ThinnedStamps thinned_;
  /// Ends with the stamp: for any thread.
  DecodingPlan stamp_plan_;
  /// Where the stamp lies at one place in all messages [bytes]: no plan is needed there.
  std::optional<std::size_t> stamp_at_;
  Parts parts_;
  mutable DecodedMessage decoded_;
  std::vector<double> values_;
};

}  // namespace sampled_data_observers
