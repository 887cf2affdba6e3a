#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <sampled_data_observers/EnableSensor.h>
#include <sampled_data_observers/GetEstimate.h>
#include <sampled_data_observers/ReloadGains.h>
#include <sampled_data_observers/Reset.h>
#include <std_srvs/SetBool.h>

#include <atomic>
#include <string>
#include <vector>

#include "sampled_data_observers/ros/call_pace.h"
#include "sampled_data_observers/ros/gain_reloader.h"
#include "sampled_data_observers/ros/node_log.h"
#include "sampled_data_observers/ros/one_at_a_time.h"
#include "sampled_data_observers/ros/shared_runtime.h"

namespace sampled_data_observers {

/// The services of a live observer. They may be called on any thread, several at a time. Those
/// that change how the observer works answer at the pace of a CallPace, and those that may take
/// long of another one.
class ObserverServices {
 public:
  /// Advertises them.
  /// @param control  its callback queue serves what changes how the observer works, which is done
  /// at once
  /// @param queries  its callback queue serves what may take long; callers of it hold up no others
  /// @param runtime  of the observer
  /// @param gains    changes those of `runtime`
  /// @param log      of the nodelet
  ObserverServices(const ros::NodeHandle& control, const ros::NodeHandle& queries,
                   SharedRuntime& runtime, GainReloader& gains, NodeLog log);

  /// Of all services, resolved.
  std::vector<std::string> names() const;

  /// Calls that take long end soon, without success, from now on.
  void stop() { is_stopping_ = true; }

 private:
  template <typename Request, typename Response>
  void advertise(ros::NodeHandle handle, CallPace& pace, const char* service,
                 bool (ObserverServices::*serve)(Request&, Response&));
  std::string compute_estimate(const ros::Time& at, StateEstimate& message);
  bool reset(Reset::Request& request, Reset::Response& response);
  bool get_estimate(GetEstimate::Request& request, GetEstimate::Response& response);
  bool reload_gains(ReloadGains::Request& request, ReloadGains::Response& response);
  bool set_enabled(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool enable_sensor(EnableSensor::Request& request, EnableSensor::Response& response);

  SharedRuntime& runtime_;
  GainReloader& gains_;
  const NodeLog log_;
  std::atomic<bool> is_stopping_{false};
  CallPace control_pace_;
  CallPace query_pace_;
  OneAtATime queries_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace sampled_data_observers
