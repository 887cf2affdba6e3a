#include "sampled_data_observers/ros/shared_runtime.h"

#include <ros/console.h>
#include <ros/time.h>

#include <utility>

#include "sampled_data_observers/ros/time_conversion.h"

namespace sampled_data_observers {

SharedRuntime::SharedRuntime(const ObserverConfig& config, std::string name,
                             std::string reset_service)
    : runtime_(std::make_unique<ObserverRuntime>(config)),
      statistics_(event_channels(config).size()),
      name_(std::move(name)),
      reset_service_(std::move(reset_service)) {}

// The time is read under the lock: otherwise it might seem to go back from one use to the next.
SharedRuntime::Access::Access(SharedRuntime& shared)
    : shared_(shared), lock_(shared.mutex_), now_(to_stamp(ros::Time::now())) {
  if (now_ < shared.last_now_) went_back_ = shared.last_now_ - now_;
  shared.last_now_ = now_;
}

SharedRuntime::Access::~Access() {
  if (went_back_ == 0) return;
  lock_.unlock();
  ROS_WARN_NAMED(shared_.name_,
                 "time went back by %.6f s: events before the history window are rejected and no "
                 "stamp is published twice; call %s to start again",
                 to_seconds(went_back_), shared_.reset_service_.c_str());
}

}  // namespace sampled_data_observers
