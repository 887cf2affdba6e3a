#include "sampled_data_observers/ros/callback_threads.h"

namespace sampled_data_observers {

CallbackThreads::CallbackThreads(std::uint32_t threads) : spinner_(threads, &queue_) {}

CallbackThreads::~CallbackThreads() { stop(); }

ros::NodeHandle CallbackThreads::handle(const ros::NodeHandle& nodelet) {
  ros::NodeHandle own(nodelet);
  own.setCallbackQueue(&queue_);
  return own;
}

void CallbackThreads::start() { spinner_.start(); }

void CallbackThreads::stop() {
  queue_.disable();  // wakes the threads
  spinner_.stop();
}

}  // namespace sampled_data_observers
