#include "sampled_data_observers/ros/event_subscriptions.h"

#include <ros/console.h>
#include <ros/names.h>

#include <utility>

#include "sampled_data_observers/ros/message_types.h"
#include "sampled_data_observers/ros/queue_length.h"
#include "sampled_data_observers/ros/time_conversion.h"
#include "sampled_data_observers/ros/value_reader.h"

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
  std::string fault;
  if (!ros::names::validate(channel.source.topic, fault)) {
    throw ConfigError(channel.source.origin, channel.source.path + "/topic", "a name of a topic",
                      "'" + channel.source.topic + "' (" + fault + ")");
  }
  return visit_message_type(channel.source, [&](auto tag) -> std::function<void()> {
    using M = typename decltype(tag)::type;
    auto reader = std::make_shared<ValueReader<M>>(channel.source);
    const auto deliver = [this, reader, channel](const M& message) {
      Event event;
      event.kind = channel.kind;
      event.channel = channel.channel;
      reader->read(message, event);
      receive(channel, event);
    };
    return [this, deliver, channel] {
      const boost::function<void(const boost::shared_ptr<const M>&)> callback =
          [this, deliver](const boost::shared_ptr<const M>& message) {
            if (ros::Time::now().isZero()) {
              defer([deliver, message] { deliver(*message); });
              return;
            }
            run_deferred();
            deliver(*message);
          };
      subscribers_.push_back(handle_.subscribe<M>(channel.source.topic, kQueueLength, callback,
                                                  ros::VoidConstPtr(),
                                                  ros::TransportHints().tcpNoDelay()));
      ROS_INFO_NAMED(name_, "%s from %s (%s)", channel.name.c_str(),
                     subscribers_.back().getTopic().c_str(), channel.source.type.c_str());
    };
  });
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

void EventSubscriptions::receive(const EventChannel& channel, const Event& event) {
  const boost::shared_ptr<EventStatus> status = statuses_.take();
  EventReport report;
  {
    const SharedRuntime::Access access = runtime_.access();
    report = access->receive(channel, event, access.now(), *status);
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
