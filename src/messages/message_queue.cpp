#include "sampled_data_observers/messages/message_queue.h"

#include <algorithm>

namespace sampled_data_observers {

MessageQueue::MessageQueue(std::size_t channels, std::size_t capacity)
    : channels_(channels, Channel(capacity)) {}

bool MessageQueue::push(const Message& message) {
  Waiting dropped;  // freed outside of the lock
  const std::lock_guard<std::mutex> lock(mutex_);
  Channel& channel = channels_[message.channel];
  if (channel.waiting.full()) {
    dropped = channel.waiting.pop();
    --left_;
    note_drop(dropped.message);
  }
  channel.waiting.push({message, arrived_++});
  ++left_;
  return !std::exchange(is_asked_, true);
}

void MessageQueue::note_drop(const Message& message) {
  Ring<Drop>& drops = channels_[message.channel].drops;
  if (drops.full()) {
    Drop& all = drops.back();
    const bool is_first = message.stamp > 0 && (all.first <= 0 || message.stamp < all.first);
    if (is_first) all.first = message.stamp;
    all.last = std::max(all.last, message.stamp);
    ++all.count;
  } else {
    drops.push({message.channel, message.stamp, message.stamp, 1});
    ++left_;
  }
}

MessageQueue::Next MessageQueue::take() {
  Next next;
  const std::lock_guard<std::mutex> lock(mutex_);
  Channel* oldest = nullptr;
  for (Channel& channel : channels_) {
    if (!next.drop && !channel.drops.empty()) {
      next.drop = channel.drops.pop();
      --left_;
    }
    if (channel.waiting.empty()) continue;
    const bool is_older =
        oldest == nullptr || channel.waiting.front().number < oldest->waiting.front().number;
    if (is_older) oldest = &channel;
  }
  if (oldest != nullptr) {
    next.message = oldest->waiting.pop().message;
    --left_;
  }
  next.more = left_ > 0;
  is_asked_ = next.more;
  return next;
}

void MessageQueue::suspend() {
  const std::lock_guard<std::mutex> lock(mutex_);
  is_asked_ = false;
}

}  // namespace sampled_data_observers
