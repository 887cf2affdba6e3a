#pragma once

#include <ros/node_handle.h>

#include <memory>
#include <optional>

#include "sampled_data_observers/config/outputs_config.h"
#include "sampled_data_observers/ros/body_output.h"
#include "sampled_data_observers/ros/node_log.h"
#include "sampled_data_observers/ros/odometry_listener.h"
#include "sampled_data_observers/ros/transform_publisher.h"
#include "sampled_data_observers/runtime/observer_runtime.h"

namespace sampled_data_observers {

/// Publishes estimates in standard messages and to tf, as the section `outputs` of the
/// configuration says. To be used by the thread that publishes the estimates.
class EstimateOutputs {
 public:
  /// Advertises all topics.
  /// @param handle  resolves their names
  /// @param config  which outputs there are, and from which numbers
  /// @param states  number of estimated states
  /// @param period  of the estimates [ns]
  /// @param log     of the nodelet
  EstimateOutputs(ros::NodeHandle handle, const OutputsConfig& config, Eigen::Index states,
                  Duration period, const NodeLog& log);

  /// Takes in an estimate of `runtime`: nothing of either is needed afterwards.
  void take(ObserverRuntime& runtime, const Estimate& estimate);

  /// Publishes what was taken in last.
  void publish();

 private:
  BodyReader reader_;
  Stamp stamp_ = 0;
  BodyEstimate body_;
  /// The ellipsoid that holds the error; no rows where the pose needs none.
  Eigen::MatrixXd ellipsoid_;
  std::optional<BodyOutput<nav_msgs::Odometry>> odometry_;
  std::optional<BodyOutput<geometry_msgs::PoseWithCovarianceStamped>> pose_;
  std::optional<BodyOutput<geometry_msgs::TwistWithCovarianceStamped>> twist_;
  /// In the map mode of tf.
  std::unique_ptr<OdometryListener> listener_;
  std::optional<TransformPublisher> transform_;
};

}  // namespace sampled_data_observers
