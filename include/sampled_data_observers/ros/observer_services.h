#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <sampled_data_observers/GetEstimate.h>
#include <sampled_data_observers/Reset.h>

#include <vector>

#include "sampled_data_observers/ros/shared_runtime.h"

namespace sampled_data_observers {

/// The services of a live observer. They may be called on any thread, several at a time.
class ObserverServices {
 public:
  /// Advertises them.
  ObserverServices(const ros::NodeHandle& handle, SharedRuntime& runtime);

 private:
  bool reset(Reset::Request& request, Reset::Response& response);
  bool get_estimate(GetEstimate::Request& request, GetEstimate::Response& response);

  SharedRuntime& runtime_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace sampled_data_observers
