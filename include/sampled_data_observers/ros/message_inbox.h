#pragma once

#include <ros/callback_queue_interface.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "sampled_data_observers/messages/message_queue.h"
#include "sampled_data_observers/ros/log_throttle.h"
#include "sampled_data_observers/ros/node_log.h"

namespace sampled_data_observers {

/// In the place of a queue: each callback is called by whoever adds it. A message is so received at
/// once, by roscpp's thread that got it.
class AtOnce : public ros::CallbackQueueInterface {
 public:
  /// Calls it, when another thread that calls one of the same subscriber is done: roscpp allows one
  /// at a time, and what is put off would wait for the next message.
  void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t) override {
    while (callback->call() == ros::CallbackInterface::TryAgain) std::this_thread::yield();
  }
  /// Nothing waits here.
  void removeByID(std::uint64_t) override {}
};

/// Messages of some topics between roscpp's threads and a callback queue, in the order of their
/// arrival. Those that have to make room for later ones are counted, and the log says so; roscpp's
/// own queue drops them unseen.
class MessageInbox {
 public:
  /// Takes a message whose channel is the number of its topic.
  using Use = std::function<void(const MessageQueue::Message&)>;

  /// @param topics    their names, resolved
  /// @param capacity  messages kept of each, > 0
  /// @param queue     where they are used; of one thread
  /// @param log       of the nodelet
  /// @param use       called on `queue`
  MessageInbox(std::vector<std::string> topics, std::size_t capacity,
               ros::CallbackQueueInterface& queue, NodeLog log, Use use);

  /// For subscribers that push(); to be gone before this is.
  ros::CallbackQueueInterface& at_once() { return at_once_; }

  /// Uses what waits now, before `queue` would have its turn; on the thread of that.
  void use_waiting();

  /// Takes in a message; for any thread.
  void push(const MessageQueue::Message& message);

 private:
  /// What was dropped of a topic.
  struct Loss {
    std::uint64_t count = 0;  ///< since the log told of it
    Stamp last = 0;
    LogThrottle throttle;
  };

  bool use_next();
  void tell_losses();

  const std::vector<std::string> topics_;
  const std::size_t capacity_;
  ros::CallbackQueueInterface& queue_;
  const NodeLog log_;
  const Use use_;
  MessageQueue messages_;
  std::vector<Loss> losses_;  ///< one for each topic
  AtOnce at_once_;
  /// A callback that uses the next message.
  const ros::CallbackInterfacePtr turn_;
};

}  // namespace sampled_data_observers
