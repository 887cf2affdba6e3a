#include "sampled_data_observers/ros/transform_publisher.h"

#include <algorithm>
#include <utility>

#include "messages/time_conversion.h"
#include "sampled_data_observers/messages/body_messages.h"

namespace sampled_data_observers {
namespace {

constexpr std::size_t kTransformPoolSize = 16;
constexpr std::uint32_t kTransformQueueLength = 100;
constexpr Duration kMostWaiting = 4096;

tf2_msgs::TFMessage prototype(const OutputsConfig& outputs) {
  tf2_msgs::TFMessage message;
  message.transforms.resize(1);
  message.transforms[0].header.frame_id = outputs.world_frame;
  const std::string& odom_frame = outputs.transform->odom_frame;
  message.transforms[0].child_frame_id = odom_frame.empty() ? outputs.base_frame : odom_frame;
  return message;
}

}  // namespace

TransformPublisher::TransformPublisher(ros::NodeHandle& handle, const OutputsConfig& outputs,
                                       Duration period, NodeLog log, OdomFrame::Odometry odometry)
    : log_(std::move(log)),
      config_(*outputs.transform),
      odometry_(std::move(odometry)),
      odom_frame_(config_.timeout,
                  static_cast<std::size_t>(std::min(config_.timeout / period + 1, kMostWaiting))),
      missing_(config_.odom_frame + " -> " + outputs.base_frame),
      messages_(prototype(outputs), kTransformPoolSize),
      publisher_(handle.advertise<tf2_msgs::TFMessage>("/tf", kTransformQueueLength)) {}

void TransformPublisher::publish(Stamp stamp, const BodyEstimate& body) {
  StampedTransform world_to_base;
  world_to_base.stamp = stamp;
  world_to_base.transform.linear() = body.orientation.toRotationMatrix();
  world_to_base.transform.translation() = body.position;
  if (config_.odom_frame.empty()) {
    send(world_to_base);
    return;
  }
  const std::size_t dropped = odom_frame_.dropped();
  odom_frame_.add(world_to_base);
  if (odom_frame_.dropped() > dropped && throttle_.admits()) {
    log_.warn(
        "no transform %s at the stamps of the estimates within the timeout (%.6g s): "
        "is it published, and by the same clock?",
        missing_.c_str(), to_seconds(config_.timeout));
  }
  while (const std::optional<StampedTransform> world_to_odom = odom_frame_.next(odometry_)) {
    send(*world_to_odom);
  }
}

void TransformPublisher::send(const StampedTransform& transform) {
  const boost::shared_ptr<tf2_msgs::TFMessage> message = messages_.take();
  geometry_msgs::TransformStamped& stamped = message->transforms[0];
  stamped.header.stamp = to_ros_time(std::max<Stamp>(0, transform.stamp + config_.time_offset));
  write(transform.transform, stamped.transform);
  publisher_.publish(message);
}

}  // namespace sampled_data_observers
