#include "sampled_data_observers/messages/transform_buffer.h"

#include <array>
#include <cstdio>

#include "messages/local_plane.h"
#include "messages/time_conversion.h"

namespace sampled_data_observers {
namespace {

/// As messages of the first tf have it.
std::string without_slash(const std::string& frame) {
  return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}

Eigen::Quaterniond from_roll_pitch_yaw(const Eigen::Vector3d& angles) {
  return Eigen::AngleAxisd(angles.z(), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(angles.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(angles.x(), Eigen::Vector3d::UnitX());
}

geometry_msgs::TransformStamped to_message(const StaticTransform& from) {
  geometry_msgs::TransformStamped message;
  message.header.frame_id = from.frame;
  message.child_frame_id = from.child_frame;
  message.transform.translation.x = from.translation.x();
  message.transform.translation.y = from.translation.y();
  message.transform.translation.z = from.translation.z();
  const Eigen::Quaterniond rotation = from_roll_pitch_yaw(from.rotation);
  message.transform.rotation.w = rotation.w();
  message.transform.rotation.x = rotation.x();
  message.transform.rotation.y = rotation.y();
  message.transform.rotation.z = rotation.z();
  return message;
}

std::optional<Eigen::Isometry3d> look_up(const tf2::BufferCore& buffer, const std::string& target,
                                         const std::string& source, ros::Time time) {
  if (source.empty() || target.empty() || !buffer.canTransform(target, source, time)) {
    return std::nullopt;
  }
  const geometry_msgs::Transform transform = buffer.lookupTransform(target, source, time).transform;
  const geometry_msgs::Quaternion& q = transform.rotation;
  const geometry_msgs::Vector3& t = transform.translation;
  Eigen::Isometry3d result(Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized());
  result.translation() << t.x, t.y, t.z;
  return result;
}

void append_name(const std::string& frame, std::string& text) {
  constexpr std::size_t kLongest = 70;
  if (frame.empty()) {
    text.append("(no frame)");
  } else {
    text.append(frame, 0, kLongest);
  }
}

}  // namespace

void write_pair(const std::string& from, const std::string& to, std::string& text) {
  text.clear();
  append_name(from, text);
  text.append(" -> ");
  append_name(to, text);
}

TransformBuffer::TransformBuffer(const std::vector<StaticTransform>& transforms,
                                 const std::optional<NavSatDatum>& datum)
    : plane_(datum ? std::make_shared<LocalPlane>(*datum) : nullptr) {
  const bool is_static = true;
  for (const StaticTransform& transform : transforms) {
    buffer_.setTransform(to_message(transform), "configuration", is_static);
    static_buffer_.setTransform(to_message(transform), "configuration", is_static);
    configured_children_.insert(transform.child_frame);
  }
}

void TransformBuffer::take(const tf2_msgs::TFMessage& message, bool is_static, Stamp now) {
  const Stamp latest = now + static_cast<Duration>(buffer_.getCacheLength().toNSec());
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    if (configured_children_.count(without_slash(transform.child_frame_id)) != 0) continue;
    const bool is_far_ahead = now > 0 && to_stamp(transform.header.stamp) > latest;
    if (!is_static && is_far_ahead) continue;
    buffer_.setTransform(transform, "tf", is_static);
    if (is_static) static_buffer_.setTransform(transform, "tf", is_static);
  }
}

void TransformBuffer::clear() {
  buffer_.clear();
  if (plane_ != nullptr) plane_->forget_stamp();
}

std::string TransformBuffer::datum_text() const {
  const std::optional<GeodeticPosition> datum = plane_ == nullptr ? std::nullopt : plane_->datum();
  if (!datum) return "";
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "[%.9f, %.9f, %.4f]", datum->latitude, datum->longitude,
                datum->altitude);
  return text.data();
}

std::optional<Eigen::Isometry3d> TransformBuffer::find(const std::string& target,
                                                       const std::string& source,
                                                       Stamp stamp) const {
  const std::string from = without_slash(source);
  if (from == target) return Eigen::Isometry3d::Identity();
  return look_up(buffer_, target, from, to_ros_time(stamp));
}

std::optional<Eigen::Isometry3d> TransformBuffer::find_static(const std::string& target,
                                                              const std::string& source) const {
  const std::string from = without_slash(source);
  const std::string to = without_slash(target);
  if (from == to) return Eigen::Isometry3d::Identity();
  return look_up(static_buffer_, to, from, ros::Time(0));
}

}  // namespace sampled_data_observers
