#pragma once

#include <ros/node_handle.h>
#include <ros/steady_timer.h>

#include <string>

namespace sampled_data_observers {

/// Says in the log, every now and then, that a simulated clock has not begun: until it does, there
/// is no estimate. /use_sim_time stays on the master when what published /clock is long gone.
class ClockWatch {
 public:
  /// @param name  of the nodelet, for its log
  ClockWatch(const ros::NodeHandle& handle, std::string name);

 private:
  void check();

  const std::string name_;
  int checks_ = 0;
  ros::SteadyTimer timer_;
};

}  // namespace sampled_data_observers
