#include "sampled_data_observers/ros/callback_threads.h"

#include <ros/init.h>

namespace sampled_data_observers {

namespace {

/// After so long a thread looks whether roscpp is there still. Those of ros::AsyncSpinner do so ten
/// times a second: of a hundred nodelets, that alone is 5000 wakings.
constexpr double kLongestSleep = 1.0;  // s

}  // namespace

CallbackThreads::CallbackThreads(std::uint32_t threads) : threads_(threads) {}

CallbackThreads::~CallbackThreads() { stop(); }

ros::NodeHandle CallbackThreads::handle(const ros::NodeHandle& nodelet) {
  ros::NodeHandle own(nodelet);
  own.setCallbackQueue(&queue_);
  return own;
}

void CallbackThreads::start() {
  for (std::thread& thread : threads_) {
    thread = std::thread([this] {
      while (!stopping_ && ros::ok()) queue_.callOne(ros::WallDuration(kLongestSleep));
    });
  }
}

void CallbackThreads::stop() {
  stopping_ = true;
  queue_.disable();  // wakes the threads
  for (std::thread& thread : threads_) {
    if (thread.joinable()) thread.join();
  }
}

}  // namespace sampled_data_observers
