#include "sampled_data_observers/ros/observer_services.h"

#include "sampled_data_observers/ros/time_conversion.h"

namespace sampled_data_observers {

ObserverServices::ObserverServices(const ros::NodeHandle& handle, SharedRuntime& runtime)
    : runtime_(runtime) {
  ros::NodeHandle advertiser(handle);
  servers_.push_back(advertiser.advertiseService("reset", &ObserverServices::reset, this));
  servers_.push_back(
      advertiser.advertiseService("get_estimate", &ObserverServices::get_estimate, this));
}

bool ObserverServices::reset(Reset::Request& request, Reset::Response& response) {
  const SharedRuntime::Access access = runtime_.access();
  if (access.now() == 0) {
    response.message = "there is no time yet: nothing came on /clock";
  } else {
    response.message = access->restart(access.now(), request.state);
  }
  response.success = response.message.empty() ? 1 : 0;
  return true;
}

bool ObserverServices::get_estimate(GetEstimate::Request& request,
                                    GetEstimate::Response& response) {
  const SharedRuntime::Access access = runtime_.access();
  const Stamp stamp = request.stamp.isZero() ? access.now() : to_stamp(request.stamp);
  const Estimate* estimate = access->estimate_at(stamp, response.message);
  response.success = estimate != nullptr ? 1 : 0;
  if (estimate != nullptr) access->write(*estimate, response.estimate);
  return true;
}

}  // namespace sampled_data_observers
