#include "sampled_data_observers/ros/ellipsoid_output.h"

#include "messages/time_conversion.h"

namespace sampled_data_observers {
namespace {

ErrorEllipsoid with_room(ErrorEllipsoid ellipsoid) {
  ellipsoid.matrix.resize(ellipsoid.names.size() * ellipsoid.names.size());
  return ellipsoid;
}

}  // namespace

EllipsoidOutput::EllipsoidOutput(ros::NodeHandle& handle, const ErrorEllipsoid& prototype)
    : messages_(with_room(prototype), kPoolSize),
      publisher_(handle.advertise<ErrorEllipsoid>("error_ellipsoid", kQueueLength)) {}

void EllipsoidOutput::take(ObserverRuntime& runtime, const Estimate& estimate) {
  taken_.reset();
  if (publisher_.getNumSubscribers() == 0 || !estimate.law->has_bound()) return;
  taken_ = messages_.take();
  taken_->header.stamp = to_ros_time(estimate.stamp);
  const Eigen::Index n = estimate.law->estimate_size();
  Eigen::Map<Eigen::MatrixXd> Q(taken_->matrix.data(), n, n);
  runtime.error_ellipsoid(estimate, Q);
}

void EllipsoidOutput::publish() {
  if (taken_) publisher_.publish(taken_);
  taken_.reset();
}

}  // namespace sampled_data_observers
