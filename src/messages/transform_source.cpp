#include "messages/transform_source.h"

#include <ros/message_event.h>
#include <ros/subscribe_options.h>

#include <array>
#include <boost/make_shared.hpp>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "messages/definition/installed_definitions.h"
#include "messages/time_conversion.h"
#include "sampled_data_observers/runtime/estimator.h"

namespace sampled_data_observers {
namespace {

using geometry_msgs::TransformStamped;

const tf2_msgs::TFMessage& transforms_in(const MessagePointer& message) {
  return *static_cast<const tf2_msgs::TFMessage*>(message.get());
}

Stamp stamp_in(const TransformStamped& transform) { return to_stamp(transform.header.stamp); }

}  // namespace

TransformSource::TransformSource(const TopicSource& source,
                                 std::shared_ptr<const TransformBuffer> transforms)
    : topic_(source.topic),
      frames_(source.frames),
      by_receipt_(source.stamped_on_receipt),
      stamp_offset_(source.stamp_offset),
      corrected_(source),
      thinned_(source.min_interval),
      transforms_(std::move(transforms)),
      parts_(compile(source, *transforms_)),
      decoded_(parts_.plan.counts()),
      values_(parts_.fields.size()) {}

TransformSource::Parts TransformSource::compile(TopicSource source,
                                                const TransformBuffer& transforms) {
  source.type = "geometry_msgs/Transform";
  const std::shared_ptr<const MessageDefinition> definition = installed_definition(source.type);
  PlanCompiler compiler(definition);
  DecodedFields fields(source, *definition, compiler, transforms.plane());
  return {std::move(fields), compiler.compile()};
}

ros::Subscriber TransformSource::subscribe(ros::NodeHandle& handle, std::uint32_t queue_length,
                                           const Receiver& receive) const {
  using Message = const ros::MessageEvent<const tf2_msgs::TFMessage>&;
  ros::SubscribeOptions options;
  options.initByFullCallbackType<Message>(topic_, queue_length, [receive](Message message) {
    receive(message.getConstMessage(), to_stamp(message.getReceiptTime()));
  });
  options.transport_hints.tcpNoDelay();
  return handle.subscribe(options);
}

MessagePointer TransformSource::deserialize(std::uint8_t* data, std::uint32_t size,
                                            const Connection& connection) const {
  const std::string expected = ros::message_traits::MD5Sum<tf2_msgs::TFMessage>::value();
  if (connection != nullptr && (*connection)["md5sum"] != expected) {
    throw std::runtime_error("it is no tf2_msgs/TFMessage");
  }
  const auto message = boost::make_shared<tf2_msgs::TFMessage>();
  ros::serialization::IStream stream(data, size);
  ros::serialization::deserialize(stream, *message);
  return message;
}

/// Where the message holds what it is of; 0 in one of others only.
Stamp TransformSource::stamp_of(const MessagePointer& message, Stamp receipt) const {
  const TransformStamped* moving = newest_of(transforms_in(message));
  if (moving == nullptr) return 0;
  const Stamp stamp = by_receipt_ ? receipt : stamp_in(*moving);
  return stamp > 0 ? stamp + stamp_offset_ : stamp;
}

/// Of the transforms whose child is the frame or attached to it.
const TransformStamped* TransformSource::newest_of(const tf2_msgs::TFMessage& message) const {
  const TransformStamped* newest = nullptr;
  for (const TransformStamped& transform : message.transforms) {
    const bool is_older = newest != nullptr && stamp_in(transform) < stamp_in(*newest);
    if (is_older || !transforms_->find_static(transform.child_frame_id, frames_.child_frame)) {
      continue;
    }
    newest = &transform;
  }
  return newest;
}

Reading TransformSource::read(const MessagePointer& message, Stamp receipt, Event& event) {
  const TransformStamped* moving = newest_of(transforms_in(message));
  event.stamp = 0;
  if (moving == nullptr) return Reading::kPassedOver;
  event.stamp = by_receipt_ ? receipt : stamp_in(*moving);
  const bool has_stamp = event.stamp > 0;
  if (has_stamp) event.stamp += stamp_offset_;
  const auto before = transforms_->find_static(frames_.frame, moving->header.frame_id);
  if (!before) return has_stamp ? Reading::kNoTransform : Reading::kEvent;
  const auto behind = transforms_->find_static(moving->child_frame_id, frames_.child_frame);
  decode(*before, moving->transform, *behind);
  const Reading fields = parts_.fields.read(decoded_, event.stamp, values_.data());
  if (fields != Reading::kEvent) return fields;
  event.values = values_.data();
  event.size = static_cast<Eigen::Index>(values_.size());
  if (!corrected_.apply(event)) return Reading::kOutOfLimits;
  // What will be rejected does not take the place of the next message.
  const bool counts = has_stamp && is_admissible(event.vector());
  return !counts || thinned_.keep(event.stamp) ? Reading::kEvent : Reading::kPassedOver;
}

/// The transform between the frames, as its message would have it. A quaternion that is no rotation
/// stays none.
void TransformSource::decode(const Eigen::Isometry3d& before,
                             const geometry_msgs::Transform& moving,
                             const Eigen::Isometry3d& behind) {
  const Eigen::Quaterniond q(moving.rotation.w, moving.rotation.x, moving.rotation.y,
                             moving.rotation.z);
  Eigen::Quaterniond unit = q;
  unit.coeffs() /= q.norm();  // normalize() would take zero for a rotation
  const Eigen::Vector3d t(moving.translation.x, moving.translation.y, moving.translation.z);
  const Eigen::Vector3d translation = before * (t + unit * behind.translation());
  const Eigen::Quaterniond rotation =
      Eigen::Quaterniond(before.linear()) * q * Eigen::Quaterniond(behind.linear());
  const std::array<double, 7> numbers = {translation.x(), translation.y(), translation.z(),
                                         rotation.x(),    rotation.y(),    rotation.z(),
                                         rotation.w()};
  std::array<std::uint8_t, sizeof numbers> bytes{};
  std::memcpy(bytes.data(), numbers.data(), sizeof numbers);
  parts_.plan.run(bytes.data(), bytes.size(), decoded_.slots());
}

void TransformSource::name_missing_transform(const MessagePointer& message, Stamp,
                                             std::string& text) const {
  const TransformStamped* moving = newest_of(transforms_in(message));
  write_pair(moving == nullptr ? "" : moving->header.frame_id, frames_.frame, text);
}

}  // namespace sampled_data_observers
