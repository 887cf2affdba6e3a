#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <sampled_data_observers/ErrorEllipsoid.h>

#include <Eigen/Core>

#include "sampled_data_observers/messages/message_pool.h"
#include "sampled_data_observers/runtime/observer_runtime.h"

namespace sampled_data_observers {

/// Publishes the ellipsoid that holds the error of each estimate, while somebody subscribes. To be
/// used by the thread that publishes the estimates.
class EllipsoidOutput {
 public:
  /// Advertises the topic.
  /// @param handle     resolves its name
  /// @param prototype  holds the frame and the names of the states
  EllipsoidOutput(ros::NodeHandle& handle, const ErrorEllipsoid& prototype);

  /// Takes in an estimate of `runtime`: nothing of either is needed afterwards. Allocates nothing,
  /// unless subscribers hold all messages of the pool.
  void take(ObserverRuntime& runtime, const Estimate& estimate);

  /// Publishes what was taken in last, once.
  void publish();

 private:
  static constexpr std::size_t kPoolSize = 16;
  static constexpr std::uint32_t kQueueLength = 100;

  MessagePool<ErrorEllipsoid> messages_;
  ros::Publisher publisher_;
  boost::shared_ptr<ErrorEllipsoid> taken_;
};

}  // namespace sampled_data_observers
