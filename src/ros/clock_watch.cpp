#include "sampled_data_observers/ros/clock_watch.h"

#include <ros/time.h>

#include <utility>

#include "sampled_data_observers/runtime/no_clock.h"

namespace sampled_data_observers {
namespace {

constexpr double kPatience = 3.0;  // s, of wall time
/// One in so many checks is logged.
constexpr int kChecksPerWarning = 10;

}  // namespace

ClockWatch::ClockWatch(const ros::NodeHandle& handle, NodeLog log) : log_(std::move(log)) {
  if (!ros::Time::isSimTime()) return;
  timer_ = handle.createSteadyTimer(ros::WallDuration(kPatience),
                                    [this](const ros::SteadyTimerEvent&) { check(); });
}

// ROS_WARN_THROTTLE would not do: it measures ROS time, which stands still.
void ClockWatch::check() {
  if (!ros::Time::now().isZero()) {
    timer_.stop();
  } else if (checks_++ % kChecksPerWarning == 0) {
    log_.warn("%s", kNoClock);
  }
}

}  // namespace sampled_data_observers
