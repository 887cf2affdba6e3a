#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <tf2_msgs/TFMessage.h>

#include <string>

#include "sampled_data_observers/config/outputs_config.h"
#include "sampled_data_observers/messages/message_pool.h"
#include "sampled_data_observers/ros/log_throttle.h"
#include "sampled_data_observers/ros/node_log.h"
#include "sampled_data_observers/runtime/odom_frame.h"

namespace sampled_data_observers {

/// Tells tf where the body is (REP 105), so that its frame keeps one parent: world → base, or, next
/// to an odometry that publishes odom → base, world → odom.
class TransformPublisher {
 public:
  /// @param handle    advertises /tf
  /// @param outputs   with a transform
  /// @param period    of the estimates [ns]
  /// @param log       of the nodelet
  /// @param odometry  finds odom → base; not called in odom mode
  TransformPublisher(ros::NodeHandle& handle, const OutputsConfig& outputs, Duration period,
                     NodeLog log, OdomFrame::Odometry odometry);

  /// Publishes world → base now; next to an odometry, world → odom of the oldest estimates whose
  /// odom → base is known, and drops those that waited for it too long.
  void publish(Stamp stamp, const BodyEstimate& body);

 private:
  void send(const StampedTransform& transform);

  const NodeLog log_;
  LogThrottle throttle_;
  const TransformOutput config_;
  const OdomFrame::Odometry odometry_;
  OdomFrame odom_frame_;
  std::string missing_;
  MessagePool<tf2_msgs::TFMessage> messages_;
  ros::Publisher publisher_;
};

}  // namespace sampled_data_observers
