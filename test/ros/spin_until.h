#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <functional>

namespace sampled_data_observers::test {

/// Spins until `done` or a generous time has passed; returns whether it was done.
inline bool spin_until(const std::function<bool()>& done, double seconds = 20.0) {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds);
  while (ros::ok() && ros::WallTime::now() < end) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.002));
    if (done()) return true;
  }
  return false;
}

}  // namespace sampled_data_observers::test
