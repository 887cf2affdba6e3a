#include "sampled_data_observers/ros/observer_nodelet.h"

#include <utility>

#include "sampled_data_observers/ros/message_types.h"
#include "sampled_data_observers/ros/parameter_tree.h"
#include "sampled_data_observers/ros/plant_plugins.h"
#include "sampled_data_observers/ros/time_conversion.h"
#include "sampled_data_observers/ros/value_reader.h"

namespace sampled_data_observers {
namespace {

// Long enough for a burst after a stall of seconds: a lost event changes all later estimates.
constexpr std::uint32_t kQueueLength = 2000;
constexpr std::size_t kPoolSize = 16;

}  // namespace

void ObserverNodelet::onInit() {
  try {
    const ObserverConfig config =
        read_observer_config(read_parameter_tree(getPrivateNodeHandle()), load_plant_plugin);
    if (config.type != type_) {
      throw ConfigError("parameters of " + getPrivateNodeHandle().getNamespace(), "observer",
                        type_ +
                            ", the type of this nodelet (observer.launch and example.launch take "
                            "another one by type:=)",
                        config.type);
    }
    start(config);
  } catch (const std::exception& error) {
    NODELET_FATAL("not started: %s", error.what());
    // Now, while the callback queue still lives: roscpp crashes if that happens in the destructor.
    stop();
    throw;
  }
}

void ObserverNodelet::stop() {
  timer_ = ros::Timer();
  subscribers_.clear();
  services_.clear();
  estimate_publisher_ = ros::Publisher();
  status_publisher_ = ros::Publisher();
}

void ObserverNodelet::start(const ObserverConfig& config) {
  std::vector<std::function<void()>> subscriptions;
  for (const EventChannel& channel : event_channels(config)) {
    subscriptions.push_back(subscription(channel));
  }
  runtime_ = std::make_unique<ObserverRuntime>(config);

  StateEstimate estimate;
  runtime_->write(runtime_->estimator().make_estimate(), estimate);
  estimates_ = std::make_unique<MessagePool<StateEstimate>>(estimate, kPoolSize);
  EventStatus status;
  status.source = status.reason = std::string(64, ' ');  // room, so that writing allocates nothing
  statuses_ = std::make_unique<MessagePool<EventStatus>>(status, kPoolSize);

  // Callbacks run as soon as there is something to call: what they use comes first.
  ros::NodeHandle& handle = getNodeHandle();
  estimate_publisher_ = handle.advertise<StateEstimate>("estimate", kQueueLength);
  status_publisher_ = handle.advertise<EventStatus>("events", kQueueLength);
  reset_service_name_ = handle.resolveName("reset");
  const bool one_shot = false;
  const bool started = false;
  timer_ = handle.createTimer(ros::Duration().fromNSec(config.period),
                              &ObserverNodelet::publish_due, this, one_shot, started);
  services_.push_back(handle.advertiseService("reset", &ObserverNodelet::reset, this));
  services_.push_back(
      handle.advertiseService("get_estimate", &ObserverNodelet::get_estimate, this));
  for (const std::function<void()>& subscribe : subscriptions) subscribe();
  timer_.start();
  NODELET_INFO("%s: %zu states, estimates at %.6g Hz on %s", type_.c_str(),
               config.law->estimate_names().size(), 1.0 / to_seconds(config.period),
               estimate_publisher_.getTopic().c_str());
  if (!config.guarantee.empty()) NODELET_INFO("certified by %s", config.guarantee.c_str());
  if (!config.warning.empty()) NODELET_WARN("%s", config.warning.c_str());
}

std::function<void()> ObserverNodelet::subscription(const EventChannel& channel) {
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
      subscribers_.push_back(getNodeHandle().subscribe<M>(channel.source.topic, kQueueLength,
                                                          callback, ros::VoidConstPtr(),
                                                          ros::TransportHints().tcpNoDelay()));
      NODELET_INFO("%s from %s (%s)", channel.name.c_str(), subscribers_.back().getTopic().c_str(),
                   channel.source.type.c_str());
    };
  });
}

/// Keeps a task until the first message of a simulated clock: before, nobody can tell the past from
/// the future.
void ObserverNodelet::defer(std::function<void()> task) {
  if (deferred_.size() < kQueueLength) {
    deferred_.push_back(std::move(task));
  } else {
    NODELET_WARN_THROTTLE(5.0, "events are lost: no time on /clock, but /use_sim_time is set");
  }
}

void ObserverNodelet::run_deferred() {
  if (deferred_.empty()) return;
  for (const std::function<void()>& task : deferred_) task();
  deferred_.clear();
}

void ObserverNodelet::receive(const EventChannel& channel, const Event& event) {
  const Stamp now = to_stamp(ros::Time::now());
  watch_clock(now);
  const boost::shared_ptr<EventStatus> status = statuses_->take();
  const EventReport report = runtime_->receive(channel, event, now, *status);
  if (!report.used()) {
    NODELET_WARN_THROTTLE(5.0, "event from %s rejected: %s (stamp %.9f s, now %.9f s)",
                          channel.name.c_str(), describe(report.outcome), to_seconds(event.stamp),
                          to_seconds(now));
  }
  status_publisher_.publish(status);
}

void ObserverNodelet::publish_due(const ros::TimerEvent&) {
  run_deferred();
  const Stamp now = to_stamp(ros::Time::now());
  watch_clock(now);
  while (const Estimate* estimate = runtime_->next_due(now)) {
    const boost::shared_ptr<StateEstimate> message = estimates_->take();
    runtime_->write(*estimate, *message);
    estimate_publisher_.publish(message);
  }
  aim_timer(now);
}

/// At the next stamp, so that estimates go out when they are due and not up to a period late.
void ObserverNodelet::aim_timer(Stamp now) {
  timer_.setPeriod(ros::Duration().fromNSec(runtime_->next_due_time(now) - now));
}

void ObserverNodelet::watch_clock(Stamp now) {
  if (now < last_now_) {
    NODELET_WARN(
        "time went back by %.6f s: events before the history window are rejected and no "
        "stamp is published twice; call %s to start again",
        to_seconds(last_now_ - now), reset_service_name_.c_str());
    aim_timer(now);  // roscpp would have it wait until time is again where it was
  }
  last_now_ = now;
}

bool ObserverNodelet::reset(Reset::Request& request, Reset::Response& response) {
  const Stamp now = to_stamp(ros::Time::now());
  if (now == 0) {
    response.message = "there is no time yet: nothing came on /clock";
  } else {
    watch_clock(now);
    response.message = runtime_->restart(now, request.state);
  }
  response.success = response.message.empty() ? 1 : 0;
  return true;
}

bool ObserverNodelet::get_estimate(GetEstimate::Request& request, GetEstimate::Response& response) {
  const ros::Time stamp = request.stamp.isZero() ? ros::Time::now() : request.stamp;
  const Estimate* estimate = runtime_->estimate_at(to_stamp(stamp), response.message);
  response.success = estimate != nullptr ? 1 : 0;
  if (estimate != nullptr) runtime_->write(*estimate, response.estimate);
  return true;
}

}  // namespace sampled_data_observers
