#include "sampled_data_observers/ros/estimate_outputs.h"

#include "messages/time_conversion.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {

EstimateOutputs::EstimateOutputs(ros::NodeHandle handle, const OutputsConfig& config,
                                 Eigen::Index states, Duration period, const NodeLog& log)
    : reader_(config.body) {
  if (config.pose_is_bounded) ellipsoid_.resize(states, states);
  if (config.odometry) {
    nav_msgs::Odometry prototype;
    prototype.header.frame_id = config.world_frame;
    prototype.child_frame_id = config.base_frame;
    odometry_.emplace(handle, *config.odometry, prototype);
  }
  if (config.pose) {
    geometry_msgs::PoseWithCovarianceStamped prototype;
    prototype.header.frame_id = config.world_frame;
    pose_.emplace(handle, *config.pose, prototype);
  }
  if (config.twist) {
    geometry_msgs::TwistWithCovarianceStamped prototype;
    prototype.header.frame_id = config.base_frame;
    twist_.emplace(handle, *config.twist, prototype);
  }
  if (!config.transform) return;
  if (!config.transform->odom_frame.empty()) {
    listener_ = std::make_unique<OdometryListener>(config.transform->odom_frame, config.base_frame);
  }
  transform_.emplace(handle, config, period, log,
                     [this](Stamp stamp) { return listener_->find(stamp); });
}

void EstimateOutputs::take(ObserverRuntime& runtime, const Estimate& estimate) {
  const double* state = estimate.state.data();
  stamp_ = estimate.stamp;
  const PlantObserver& observer = estimate.law->observer();
  const Eigen::Index n = estimate.law->estimate_size();
  reader_.read(state, observer.held_part(state), observer.covariance(state), n, body_);
  if (ellipsoid_.rows() == 0) return;
  runtime.error_ellipsoid(estimate, ellipsoid_);
  reader_.read_pose_ellipsoid(state, observer.held_part(state), ellipsoid_.data(), n, body_);
}

void EstimateOutputs::publish() {
  const ros::Time stamp = to_ros_time(stamp_);
  if (odometry_) odometry_->publish(stamp, body_);
  if (pose_) pose_->publish(stamp, body_);
  if (twist_) twist_->publish(stamp, body_);
  if (transform_) transform_->publish(stamp_, body_);
}

}  // namespace sampled_data_observers
