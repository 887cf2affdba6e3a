#pragma once

#include <ros/callback_queue_interface.h>

#include <functional>
#include <utility>

namespace sampled_data_observers {

/// An action, as a callback for a queue.
class ActionCallback : public ros::CallbackInterface {
 public:
  explicit ActionCallback(std::function<void()> action) : action_(std::move(action)) {}

  CallResult call() override {
    action_();
    return Success;
  }

 private:
  const std::function<void()> action_;
};

}  // namespace sampled_data_observers
