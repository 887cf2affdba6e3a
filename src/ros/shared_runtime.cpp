#include "sampled_data_observers/ros/shared_runtime.h"

#include <ros/time.h>

#include <utility>

#include "messages/time_conversion.h"
#include "sampled_data_observers/config/event_channels.h"

namespace sampled_data_observers {

SharedRuntime::SharedRuntime(const ObserverConfig& config, NodeLog log, std::string reset_service)
    : runtime_(std::make_unique<ObserverRuntime>(config)),
      statistics_(event_channels(config).size(),
                  static_cast<std::size_t>(config.plant->max_outputs())),
      clock_(config.jump_back_tolerance),
      reset_on_jump_back_(config.reset_on_time_jump_back),
      log_(std::move(log)),
      reset_service_(std::move(reset_service)) {}

void SharedRuntime::approach_present() {
  Parts parts;
  while (true) {
    const Access present = access();
    if (parts.are_enough(present->approach(present.now(), kSteps))) return;
  }
}

void SharedRuntime::replace(std::unique_ptr<ObserverRuntime> next) {
  approach_present();
  {
    const Access present = access();
    next->take_over(*runtime_, present.now());
    runtime_.swap(next);
  }
  next.reset();  // outside of the lock: it frees much memory
}

SharedRuntime::Access::Access(SharedRuntime& shared) : shared_(shared), lock_(shared.mutex_) {
  begin();
}

SharedRuntime::Access::Access(SharedRuntime& shared, std::chrono::nanoseconds patience)
    : shared_(shared), lock_(shared.mutex_, std::defer_lock) {
  if (lock_.try_lock_for(patience)) begin();
}

// The time is read under the lock: otherwise it might seem to go back from one use to the next.
void SharedRuntime::Access::begin() {
  now_ = to_stamp(ros::Time::now());
  went_back_ = shared_.clock_.note(now_);
  if (went_back_ > 0 && shared_.reset_on_jump_back_) shared_.runtime_->start_anew(now_);
}

SharedRuntime::Access::~Access() {
  if (went_back_ == 0) return;
  lock_.unlock();
  if (shared_.time_went_back_) shared_.time_went_back_();
  if (shared_.reset_on_jump_back_) {
    shared_.log_.warn("time went back by %.6f s: starting anew with the next event",
                      to_seconds(went_back_));
  } else {
    shared_.log_.warn(
        "time went back by %.6f s: events before the history window are rejected and no "
        "stamp is published twice; call %s to start again, or set "
        "reset_on_time_jump_back",
        to_seconds(went_back_), shared_.reset_service_.c_str());
  }
}

}  // namespace sampled_data_observers
