#pragma once

#include <ros/node_handle.h>
#include <ros/steady_timer.h>

#include <string>

#include "sampled_data_observers/ros/node_log.h"

namespace sampled_data_observers {

/// Says in the log, every now and then, that a simulated clock has not begun: until it does, there
/// is no estimate. /use_sim_time stays on the master when what published /clock is long gone.
class ClockWatch {
 public:
  /// @param handle  its callback queue looks, every few seconds of wall time
  /// @param log     of the nodelet
  ClockWatch(const ros::NodeHandle& handle, NodeLog log);

 private:
  void check();

  const NodeLog log_;
  int checks_ = 0;
  ros::SteadyTimer timer_;
};

}  // namespace sampled_data_observers
