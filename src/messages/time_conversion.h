#pragma once

#include <ros/time.h>

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// Zero, which no event may have, for a time whose nanoseconds make a second or more: roscpp takes
/// such garbage from the wire as it comes.
inline Stamp to_stamp(const ros::Time& time) {
  return time.nsec < 1000000000u ? static_cast<Stamp>(time.toNSec()) : 0;
}

/// @pre 0 <= stamp < 2^32 s, the range of ros::Time
inline ros::Time to_ros_time(Stamp stamp) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(stamp));
  return time;
}

}  // namespace sampled_data_observers
