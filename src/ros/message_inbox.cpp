#include "sampled_data_observers/ros/message_inbox.h"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <utility>

#include "messages/time_conversion.h"
#include "ros/action_callback.h"

namespace sampled_data_observers {

MessageInbox::MessageInbox(std::vector<std::string> topics, std::size_t capacity,
                           ros::CallbackQueueInterface& queue, NodeLog log, Use use)
    : topics_(std::move(topics)),
      capacity_(capacity),
      queue_(queue),
      log_(std::move(log)),
      use_(std::move(use)),
      messages_(topics_.size(), capacity),
      losses_(topics_.size()),
      turn_(boost::make_shared<ActionCallback>([this] {
        if (use_next()) queue_.addCallback(turn_);
      })) {}

void MessageInbox::push(const MessageQueue::Message& message) {
  if (messages_.push(message)) queue_.addCallback(turn_);
}

void MessageInbox::use_waiting() {
  std::size_t left = topics_.size() * capacity_;  // more may come all the time
  while (left > 0 && use_next()) --left;
}

/// Returns whether more wait.
bool MessageInbox::use_next() {
  const MessageQueue::Next next = messages_.take();
  if (next.drop) {
    Loss& loss = losses_[next.drop->channel];
    loss.count += next.drop->count;
    loss.last = std::max(loss.last, next.drop->last);
  }
  tell_losses();
  if (next.message) use_(*next.message);
  return next.more;
}

/// Now and then, those of meanwhile together.
void MessageInbox::tell_losses() {
  for (std::size_t i = 0; i < losses_.size(); ++i) {
    Loss& loss = losses_[i];
    if (loss.count == 0 || !loss.throttle.admits()) continue;
    const auto count = static_cast<unsigned long long>(std::exchange(loss.count, 0));
    log_.warn("messages on %s come faster than they are used: %llu dropped (up to stamp %.9f s)",
              topics_[i].c_str(), count, to_seconds(loss.last));
  }
}

}  // namespace sampled_data_observers
