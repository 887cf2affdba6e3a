#include "sampled_data_observers/ros/event_subscriptions.h"

#include <ros/console.h>

#include <memory>
#include <utility>

#include "sampled_data_observers/ros/queue_length.h"
#include "sampled_data_observers/ros/time_conversion.h"

namespace sampled_data_observers {
namespace {

constexpr std::size_t kStatusesHeld = 16;

EventStatus status_prototype() {
  EventStatus status;
  status.source = status.reason = std::string(64, ' ');  // room, so that writing allocates nothing
  return status;
}

}  // namespace

EventSubscriptions::EventSubscriptions(const ros::NodeHandle& handle,
                                       const std::vector<EventChannel>& channels,
                                       SharedRuntime& runtime, EstimatePublication& publication,
                                       std::string name)
    : handle_(handle),
      runtime_(runtime),
      publication_(publication),
      name_(std::move(name)),
      statuses_(status_prototype(), kStatusesHeld) {
  for (const EventChannel& channel : channels) subscribe_.push_back(subscription(channel));
  status_publisher_ = handle_.advertise<EventStatus>("events", kQueueLength);
}

void EventSubscriptions::start() {
  for (const std::function<void()>& subscribe : subscribe_) subscribe();
  if (!ros::Time::isSimTime()) return;
  const bool once = true;
  clock_timer_ = handle_.createTimer(
      ros::Duration(1e-3), [this](const ros::TimerEvent&) { run_deferred(); }, once);
}

std::function<void()> EventSubscriptions::subscription(const EventChannel& channel) {
  const std::shared_ptr<MessageSource> source = make_message_source(channel.source);
  return [this, source, channel] {
    const auto deliver = [this, source, channel](const MessagePointer& message, Stamp receipt) {
      if (ros::Time::now().isZero()) {
        defer([this, source, channel, message] {
          receive(channel, *source, message, to_stamp(ros::Time::now()));
        });
        return;
      }
      run_deferred();
      receive(channel, *source, message, receipt);
    };
    subscribers_.push_back(source->subscribe(handle_, kQueueLength, deliver));
    ROS_INFO_NAMED(name_, "%s from %s (%s)", channel.name.c_str(),
                   subscribers_.back().getTopic().c_str(), channel.source.type.c_str());
  };
}

/// Keeps a task until the first message of a simulated clock: before, nobody can tell the past from
/// the future.
void EventSubscriptions::defer(std::function<void()> task) {
  if (deferred_.size() < kQueueLength) {
    deferred_.push_back(std::move(task));
  } else {
    ROS_WARN_THROTTLE_NAMED(5.0, name_,
                            "events are lost: no time on /clock, but /use_sim_time is set");
  }
}

void EventSubscriptions::run_deferred() {
  if (deferred_.empty()) return;
  for (const std::function<void()>& task : deferred_) task();
  deferred_.clear();
}

void EventSubscriptions::receive(const EventChannel& channel, MessageSource& source,
                                 const MessagePointer& message, Stamp receipt) {
  Event event;
  event.kind = channel.kind;
  event.channel = channel.channel;
  const Reading reading = source.read(message, receipt, event);
  if (reading == Reading::kPassedOver) return;
  const boost::shared_ptr<EventStatus> status = statuses_.take();
  EventReport report;
  {
    const SharedRuntime::Access access = runtime_.access();
    report = reading == Reading::kEvent
                 ? access->receive(channel, event, access.now(), *status)
                 : access->reject(channel, event, outcome_of(reading), access.now(), *status);
    runtime_.statistics().record_event(channel.index, event, report, access.now() - event.stamp);
  }
  if (!report.used()) {
    ROS_WARN_THROTTLE_NAMED(5.0, name_, "event from %s rejected: %s (stamp %.9f s, latency %.9f s)",
                            channel.name.c_str(), describe(report), to_seconds(event.stamp),
                            status->latency);
  }
  if (report.recovers()) {
    ROS_WARN_THROTTLE_NAMED(5.0, name_, "sample of %s %s (stamp %.9f s)", channel.name.c_str(),
                            describe(report), to_seconds(event.stamp));
  }
  status_publisher_.publish(status);
  publication_.notice_event();
}

}  // namespace sampled_data_observers
