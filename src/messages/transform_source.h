#pragma once

#include <tf2_msgs/TFMessage.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "messages/corrected_values.h"
#include "messages/decoded_fields.h"
#include "messages/definition/decoding_plan.h"
#include "runtime/thinned_stamps.h"
#include "sampled_data_observers/messages/message_source.h"

namespace sampled_data_observers {

/// The pose of a frame in another as tf has it: each stamp of the one transform between them that
/// moves is an event. That is the one whose child is the frame, or rigidly attached to it; static
/// transforms lead on from there on either side. The values are fields of geometry_msgs/Transform.
class TransformSource : public MessageSource {
 public:
  /// @param transforms  where it finds what is static; not null
  /// @throws ConfigError
  TransformSource(const TopicSource& source, std::shared_ptr<const TransformBuffer> transforms);

  ros::Subscriber subscribe(ros::NodeHandle& handle, std::uint32_t queue_length,
                            const Receiver& receive) const override;
  MessagePointer deserialize(std::uint8_t* data, std::uint32_t size,
                             const Connection& connection) const override;
  Stamp stamp_of(const MessagePointer& message, Stamp receipt) const override;
  Reading read(const MessagePointer& message, Stamp receipt, Event& event) override;
  std::string md5sum() const override {
    return ros::message_traits::MD5Sum<tf2_msgs::TFMessage>::value();
  }
  void confirm() override { parts_.fields.confirm(); }
  void name_missing_transform(const MessagePointer& message, Stamp stamp,
                              std::string& text) const override;

 private:
  struct Parts {
    DecodedFields fields;
    DecodingPlan plan;
  };
  static Parts compile(TopicSource source, const TransformBuffer& transforms);
  const geometry_msgs::TransformStamped* newest_of(const tf2_msgs::TFMessage& message) const;
  void decode(const Eigen::Isometry3d& before, const geometry_msgs::Transform& moving,
              const Eigen::Isometry3d& behind);

  std::string topic_;
  SourceFrames frames_;
  bool by_receipt_;
  Duration stamp_offset_;
  CorrectedValues corrected_;
  ThinnedStamps thinned_;
  std::shared_ptr<const TransformBuffer> transforms_;
  Parts parts_;
  DecodedMessage decoded_;
  std::vector<double> values_;
};

}  // namespace sampled_data_observers
