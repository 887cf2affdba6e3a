#include "sampled_data_observers/ros/event_subscriptions.h"

#include <boost/make_shared.hpp>
#include <memory>
#include <utility>

#include "messages/queue_length.h"
#include "messages/runtime_messages.h"
#include "messages/time_conversion.h"
#include "ros/action_callback.h"
#include "sampled_data_observers/config/event_channels.h"
#include "sampled_data_observers/runtime/diagnosis.h"

namespace sampled_data_observers {
namespace {

constexpr std::size_t kStatusesHeld = 16;

/// @param outputs  the most that a sensor has
EventStatus status_prototype(Eigen::Index outputs) {
  EventStatus status;
  status.values.resize(static_cast<std::size_t>(outputs));
  status.innovation.resize(static_cast<std::size_t>(outputs));
  status.source = status.reason =
      std::string(64 + kLongestDetail, ' ');  // room, so that writing allocates nothing
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
      statuses_(status_prototype(config.plant->max_outputs()), kStatusesHeld),
      transforms_(std::make_shared<TransformBuffer>(config.static_transforms, config.navsat)),
      messages_(2 * event_channels(config).size(), kQueueLength),
      turn_(boost::make_shared<ActionCallback>([this] { use_next(); })),
      clock_(config.jump_back_tolerance) {
  for (const EventChannel& channel : event_channels(config)) add(channel);
  throttles_.resize(intakes_.size() * kEventOutcomes);
  if (has_frames(config)) subscribe_.push_back([this] { listen_to_transforms(); });
  status_publisher_ = handle_.advertise<EventStatus>("events", kQueueLength);
}

void EventSubscriptions::start(DatumReceiver take_datum) {
  if (transforms_->plane() != nullptr) take_datum_ = std::move(take_datum);
  tell_of_datum();
  for (const std::function<void()>& subscribe : subscribe_) subscribe();
  if (!ros::Time::isSimTime()) return;
  const bool once = true;
  clock_timer_ = handle_.createTimer(
      ros::Duration(1e-3), [this](const ros::TimerEvent&) { ask_for_turn(); }, once);
}

void EventSubscriptions::add(const EventChannel& channel) {
  const std::shared_ptr<MessageSource> source = make_message_source(channel.source, transforms_);
  const auto intake = std::make_shared<EventIntake>(
      channel, source,
      [this](const EventChannel& from, const Event& event, Reading reading,
             const std::string& missing) { return handle(from, event, reading, missing); });
  const auto deliver = [this, source, index = channel.index](const MessagePointer& message,
                                                             Stamp receipt) {
    if (messages_.push({index, message, receipt, source->stamp_of(message, receipt)})) {
      ask_for_turn();
    }
  };
  subscribe_.push_back([this, source, deliver, channel] {
    ros::NodeHandle handle(handle_);
    handle.setCallbackQueue(&at_once_);
    subscribers_.push_back(source->subscribe(handle, kQueueLength, deliver));
    log_.info("%s from %s (%s)", channel.name.c_str(), subscribers_.back().getTopic().c_str(),
              channel.source.type.c_str());
  });
  intakes_.push_back(intake);
  expected_.push_back(
      {handle_.resolveName(channel.source.topic), channel.source.type, source->md5sum()});
}

std::vector<ExpectedDefinition> EventSubscriptions::expected() const { return expected_; }

void EventSubscriptions::refuse(std::size_t channel, const RefusedPublishers::Text& sender) {
  if (messages_.push({channel + intakes_.size(), sender, 0, 0})) ask_for_turn();
}

/// On the same callback queue as everything else: what waits is tried again as transforms come, and
/// nothing needs a lock.
void EventSubscriptions::listen_to_transforms() {
  const std::vector<std::string> topics = {"/tf", "/tf_static"};
  const auto use = [this](const MessageQueue::Message& message) {
    const Stamp now = to_stamp(ros::Time::now());
    watch_clock(now);
    const bool is_static = message.channel == 1;
    transforms_->take(*boost::static_pointer_cast<const tf2_msgs::TFMessage>(message.message),
                      is_static, now);
    retry_waiting();
  };
  transform_messages_.emplace(topics, kQueueLength, *handle_.getCallbackQueue(), log_, use);
  ros::NodeHandle handle(handle_);
  handle.setCallbackQueue(&transform_messages_->at_once());
  for (std::size_t i = 0; i < topics.size(); ++i) {
    const boost::function<void(const tf2_msgs::TFMessageConstPtr&)> receive =
        [this, i](const tf2_msgs::TFMessageConstPtr& message) {
          const bool is_empty = message->transforms.empty();
          const Stamp stamp = is_empty ? 0 : to_stamp(message->transforms[0].header.stamp);
          transform_messages_->push({i, message, 0, stamp});
        };
    subscribers_.push_back(handle.subscribe<tf2_msgs::TFMessage>(
        topics[i], kQueueLength, receive, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
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

void EventSubscriptions::tell_of_datum() {
  if (!take_datum_) return;
  const std::string datum = transforms_->datum_text();
  if (datum.empty()) return;
  log_.info("datum of the local plane: %s", datum.c_str());
  std::exchange(take_datum_, nullptr)(datum);
}

/// Behind all that is in the callback queue now, so that timers and transforms have their turns.
void EventSubscriptions::ask_for_turn() { handle_.getCallbackQueue()->addCallback(turn_); }

/// Before the first message of a simulated clock, nobody can tell the past from the future.
void EventSubscriptions::use_next() {
  const Stamp now = to_stamp(ros::Time::now());
  if (now == 0) {
    messages_.suspend();
    clock_timer_.stop();
    clock_timer_.start();  // as one that fired: the clock may have gone back to 0
    return;
  }
  // They may have come before the event that takes them.
  if (transform_messages_) transform_messages_->use_waiting();
  watch_clock(now);
  const MessageQueue::Next next = messages_.take();
  if (next.drop) answer(*next.drop);
  if (next.message) {
    const MessageQueue::Message& message = *next.message;
    if (message.channel >= intakes_.size()) {
      intakes_[message.channel - intakes_.size()]->refuse(
          *static_cast<const std::string*>(message.message.get()));
    } else {
      const Stamp receipt = message.receipt > 0 ? message.receipt : now;
      intakes_[message.channel]->take(message.message, receipt, now);
      tell_of_datum();
    }
  }
  if (next.more) ask_for_turn();
}

/// One status each, and two for many that were dropped together.
void EventSubscriptions::answer(const MessageQueue::Drop& drop) {
  const std::size_t channel = drop.channel % intakes_.size();
  EventIntake& intake = *intakes_[channel];
  if (drop.count == 1) {
    intake.lose(drop.first, "");
    return;
  }
  const std::string note = "one of " + std::to_string(drop.count);
  intake.lose(drop.first, note);
  intake.lose(drop.last, note);
  EventReport report;
  report.outcome = EventOutcome::kDropped;
  for (std::uint64_t i = 2; i < drop.count; ++i) {
    runtime_.statistics().record_event(channel, {}, report, 0);
  }
}

LogThrottle& EventSubscriptions::throttle_of(const EventChannel& channel,
                                             const EventReport& report) {
  return throttles_[channel.index * kEventOutcomes + static_cast<std::size_t>(report.outcome)];
}

bool EventSubscriptions::handle(const EventChannel& channel, const Event& event, Reading reading,
                                const std::string& detail) {
  EventReport report;
  Stamp now = 0;
  SharedRuntime::Parts parts;
  const boost::shared_ptr<EventStatus> status = statuses_.take();
  while (true) {
    const SharedRuntime::Access access = runtime_.access();
    if (!parts.are_enough(access->approach(event, access.now(), SharedRuntime::kSteps))) continue;
    report = reading == Reading::kEvent ? access->receive(event, access.now())
                                        : access->reject(event, outcome_of(reading), access.now());
    if (!detail.empty() && reading != Reading::kDropped) {
      runtime_.statistics().record_detail(channel.index, report.outcome, detail);
    }
    now = access.now();
    runtime_.statistics().record_event(channel.index, event, report, now - event.stamp);
    write(channel, event, report, detail, now, *status);  // the innovations are the runtime's
    break;
  }
  const Duration latency = now - event.stamp;
  if (!report.used() && throttle_of(channel, report).admits()) {
    tell_of_rejection(channel, event, *status);
  }
  if (report.used() && latency > history_ && !has_told_of_old_stamps_) {
    has_told_of_old_stamps_ = true;
    log_.warn("%s", describe_old_stamps(channel.source.topic, latency).c_str());
  }
  const bool is_alone = report.outcome == EventOutcome::kJumpAlone;
  if ((report.recovers() || is_alone) && throttle_of(channel, report).admits()) {
    log_.warn("event from %s %s (stamp %.9f s)", channel.name.c_str(), describe(report),
              to_seconds(event.stamp));
  }
  status_publisher_.publish(status);
  publication_.notice_event();
  return is_good(report.outcome);
}

/// Of one by another definition the stamp is not known.
void EventSubscriptions::tell_of_rejection(const EventChannel& channel, const Event& event,
                                           const EventStatus& status) const {
  if (status.outcome == EventStatus::OTHER_DEFINITION) {
    log_.warn("event from %s rejected: %s (%s)", channel.name.c_str(), status.reason.c_str(),
              remedy(EventOutcome::kOtherDefinition));
    return;
  }
  log_.warn("event from %s rejected: %s (stamp %.9f s, latency %.9f s)", channel.name.c_str(),
            status.reason.c_str(), to_seconds(event.stamp), status.latency);
}

}  // namespace sampled_data_observers
