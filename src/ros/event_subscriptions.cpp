#include "sampled_data_observers/ros/event_subscriptions.h"

#include <memory>
#include <utility>

#include "messages/queue_length.h"
#include "messages/runtime_messages.h"
#include "messages/time_conversion.h"
#include "sampled_data_observers/config/event_channels.h"
#include "sampled_data_observers/runtime/diagnosis.h"
#include "sampled_data_observers/runtime/no_clock.h"

namespace sampled_data_observers {
namespace {

constexpr std::size_t kStatusesHeld = 16;

EventStatus status_prototype() {
  EventStatus status;
  status.source = status.reason =
      std::string(64 + kLongestPair, ' ');  // room, so that writing allocates nothing
  return status;
}

}  // namespace

EventSubscriptions::EventSubscriptions(const ros::NodeHandle& handle, const ObserverConfig& config,
                                       SharedRuntime& runtime, EstimatePublication& publication,
                                       NodeLog log)
    : handle_(handle),
      runtime_(runtime),
      publication_(publication),
      log_(std::move(log)),
      history_(config.options.history.history),
      statuses_(status_prototype(), kStatusesHeld),
      transforms_(std::make_shared<TransformBuffer>(config.static_transforms)),
      clock_(config.jump_back_tolerance) {
  for (const EventChannel& channel : event_channels(config)) add(channel);
  throttles_.resize(intakes_.size() * kEventOutcomes);
  if (has_frames(config)) subscribe_.push_back([this] { listen_to_transforms(); });
  status_publisher_ = handle_.advertise<EventStatus>("events", kQueueLength);
}

void EventSubscriptions::start() {
  for (const std::function<void()>& subscribe : subscribe_) subscribe();
  if (!ros::Time::isSimTime()) return;
  const bool once = true;
  clock_timer_ = handle_.createTimer(
      ros::Duration(1e-3), [this](const ros::TimerEvent&) { run_deferred(); }, once);
}

void EventSubscriptions::add(const EventChannel& channel) {
  const std::shared_ptr<MessageSource> source = make_message_source(channel.source, transforms_);
  const auto intake = std::make_shared<EventIntake>(
      channel, source,
      [this](const EventChannel& from, const Event& event, Reading reading,
             const std::string& missing) { handle(from, event, reading, missing); });
  const auto deliver = [this, intake](const MessagePointer& message, Stamp receipt) {
    const Stamp now = to_stamp(ros::Time::now());
    if (now == 0) {
      defer([intake, message] {
        const Stamp first = to_stamp(ros::Time::now());
        intake->take(message, first, first);
      });
      return;
    }
    run_deferred();
    watch_clock(now);
    intake->take(message, receipt, now);
  };
  subscribe_.push_back([this, source, deliver, channel] {
    subscribers_.push_back(source->subscribe(handle_, kQueueLength, deliver));
    log_.info("%s from %s (%s)", channel.name.c_str(), subscribers_.back().getTopic().c_str(),
              channel.source.type.c_str());
  });
  intakes_.push_back(intake);
}

/// On the same callback queue as everything else: what waits is tried again as transforms come, and
/// nothing needs a lock.
void EventSubscriptions::listen_to_transforms() {
  for (const bool is_static : {false, true}) {
    const boost::function<void(const tf2_msgs::TFMessageConstPtr&)> take =
        [this, is_static](const tf2_msgs::TFMessageConstPtr& message) {
          const Stamp now = to_stamp(ros::Time::now());
          watch_clock(now);
          transforms_->take(*message, is_static, now);
          retry_waiting();
        };
    subscribers_.push_back(handle_.subscribe<tf2_msgs::TFMessage>(
        is_static ? "/tf_static" : "/tf", kQueueLength, take, ros::VoidConstPtr(),
        ros::TransportHints().tcpNoDelay()));
  }
  retry_timer_ = handle_.createWallTimer(ros::WallDuration(0.1),
                                         [this](const ros::WallTimerEvent&) { retry_waiting(); });
}

/// Forgets the transforms of a time that is yet to come again.
void EventSubscriptions::watch_clock(Stamp now) {
  if (clock_.note(now) == 0) return;
  transforms_->clear();
  for (const auto& intake : intakes_) intake->give_up();
}

void EventSubscriptions::retry_waiting() {
  const Stamp now = to_stamp(ros::Time::now());
  if (now == 0) return;
  watch_clock(now);
  for (const auto& intake : intakes_) intake->retry(now);
}

/// Keeps a task until the first message of a simulated clock: before, nobody can tell the past from
/// the future.
void EventSubscriptions::defer(std::function<void()> task) {
  if (deferred_.size() < kQueueLength) {
    deferred_.push_back(std::move(task));
  } else if (!has_lost_events_) {  // throttled by ROS time, the warning would never come
    has_lost_events_ = true;
    log_.warn("events are lost: %s", kNoClock);
  }
}

void EventSubscriptions::run_deferred() {
  if (deferred_.empty()) return;
  for (const std::function<void()>& task : deferred_) task();
  deferred_.clear();
}

LogThrottle& EventSubscriptions::throttle_of(const EventChannel& channel,
                                             const EventReport& report) {
  return throttles_[channel.index * kEventOutcomes + static_cast<std::size_t>(report.outcome)];
}

void EventSubscriptions::handle(const EventChannel& channel, const Event& event, Reading reading,
                                const std::string& missing) {
  EventReport report;
  Stamp now = 0;
  {
    const SharedRuntime::Access access = runtime_.access();
    report = reading == Reading::kEvent ? access->receive(event, access.now())
                                        : access->reject(event, outcome_of(reading), access.now());
    if (!missing.empty()) runtime_.statistics().record_missing_transform(channel.index, missing);
    now = access.now();
    runtime_.statistics().record_event(channel.index, event, report, now - event.stamp);
  }
  const Duration latency = now - event.stamp;
  const boost::shared_ptr<EventStatus> status = statuses_.take();
  write(channel, event, report, missing, now, *status);
  if (!report.used() && throttle_of(channel, report).admits()) {
    log_.warn("event from %s rejected: %s (stamp %.9f s, latency %.9f s)", channel.name.c_str(),
              status->reason.c_str(), to_seconds(event.stamp), status->latency);
  }
  if (report.used() && latency > history_ && !has_told_of_old_stamps_) {
    has_told_of_old_stamps_ = true;
    log_.warn("%s", describe_old_stamps(channel.source.topic, latency).c_str());
  }
  if (report.recovers() && throttle_of(channel, report).admits()) {
    log_.warn("sample of %s %s (stamp %.9f s)", channel.name.c_str(), describe(report),
              to_seconds(event.stamp));
  }
  status_publisher_.publish(status);
  publication_.notice_event();
}

}  // namespace sampled_data_observers
