#pragma once

#include <ros/node_handle.h>
#include <ros/steady_timer.h>

#include <string>
#include <vector>

namespace sampled_data_observers {

/// Looks every few seconds whether the ROS master still knows this nodelet. roscpp registers topics
/// and services once only, so that after a restart of the master nobody would find them any more,
/// although connections stay. Then all topics of this process and the services of this nodelet are
/// registered again.
class MasterWatch {
 public:
  /// @param services  of this nodelet, at least one
  /// @param name      of the nodelet, for its log
  MasterWatch(const ros::NodeHandle& handle, std::vector<std::string> services, std::string name);

 private:
  void check() const;
  void register_again() const;

  const std::vector<std::string> services_;
  const std::string name_;
  ros::SteadyTimer timer_;
};

}  // namespace sampled_data_observers
