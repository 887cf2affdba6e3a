#pragma once

#include <ros/time.h>

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

inline Stamp to_stamp(const ros::Time& time) { return static_cast<Stamp>(time.toNSec()); }

/// @pre 0 <= stamp < 2^32 s, the range of ros::Time
inline ros::Time to_ros_time(Stamp stamp) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(stamp));
  return time;
}

}  // namespace sampled_data_observers
