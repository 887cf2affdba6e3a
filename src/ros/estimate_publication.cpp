#include "sampled_data_observers/ros/estimate_publication.h"

#include <boost/make_shared.hpp>
#include <utility>

#include "messages/queue_length.h"
#include "messages/runtime_messages.h"
#include "real_time/memory_lock.h"
#include "real_time/steady_deadline.h"
#include "real_time/thread_cpu_time.h"
#include "ros/action_callback.h"

namespace sampled_data_observers {
namespace {

constexpr std::size_t kEstimatesHeld = 16;
constexpr double kShortestWait = 1e-3;  // s
constexpr bool kFromNow = true;
/// So many estimates are published at most before the events that wait have their turn.
constexpr int kEstimatesPerTurn = 10;

void apply(const RealTimeOptions& options, DeadlineThread& thread, const NodeLog& log) {
  if (options.lock_memory) {
    const std::string objection = lock_memory();
    if (!objection.empty()) {
      log.warn("real_time/lock_memory: not possible, going on without: %s", objection.c_str());
    }
  }
  if (options.priority) {
    const std::string objection = thread.set_real_time_priority(*options.priority);
    if (!objection.empty()) {
      log.warn(
          "real_time/priority: not possible, going on without: %s (is there a line "
          "'rtprio' for this user in /etc/security/limits.conf?)",
          objection.c_str());
    }
  }
}

}  // namespace

EstimatePublication::EstimatePublication(const ros::NodeHandle& handle, SharedRuntime& runtime,
                                         std::unique_ptr<EstimateOutputs> outputs)
    : handle_(handle), runtime_(runtime), outputs_(std::move(outputs)) {
  StateEstimate prototype;
  {
    const SharedRuntime::Access access = runtime_.access();
    write(*access, access->estimator().make_estimate(), prototype);
  }
  messages_ = std::make_unique<MessagePool<StateEstimate>>(prototype, kEstimatesHeld);
  publisher_ = handle_.advertise<StateEstimate>("estimate", kQueueLength);
  if (!ros::Time::isSimTime()) return;
  const bool once = false;
  const bool started = false;
  timer_ = handle_.createTimer(
      ros::Duration(kShortestWait), [this](const ros::TimerEvent&) { publish_by_queue(); }, once,
      started);
  // Otherwise roscpp would have the timer wait until time is where it was.
  runtime_.when_time_goes_back(
      [this] { timer_.setPeriod(ros::Duration(kShortestWait), kFromNow); });
}

void EstimatePublication::start(const ObserverConfig& config, const NodeLog& log) {
  publish_on_event_ = config.publish_on_event;
  if (ros::Time::isSimTime()) {
    timer_.start();
  } else {
    thread_ = std::make_unique<DeadlineThread>([this] { return publish_by_thread(); }, "estimates");
    apply(config.real_time, *thread_, log);
  }
}

void EstimatePublication::notice_event() {
  if (!thread_) {
    if (!waits_for_turn_) publish_by_queue();
  } else if (publish_on_event_) {
    thread_->wake();
  }
}

DeadlineThread::Clock::time_point EstimatePublication::publish_by_thread() {
  while (true) {
    const DeadlineThread::Clock::time_point steady_now = DeadlineThread::Clock::now();
    const std::optional<Duration> wait = publish_next();
    if (wait) return steady_deadline(*wait, steady_now);
  }
}

void EstimatePublication::publish_by_queue() {
  for (int published = 0; published < kEstimatesPerTurn; ++published) {
    const ros::Time now = ros::Time::now();
    const std::optional<Duration> wait = publish_next();
    if (!wait) continue;
    timer_.setPeriod(ros::Duration().fromNSec(*wait), kFromNow);
    // Where the clock went on before the timer was set, it would fire too late, or never if the
    // clock now stops.
    if (ros::Time::now() == now) return;
  }
  wait_for_turn();
}

/// Goes on behind all that is in the queue now.
void EstimatePublication::wait_for_turn() {
  if (waits_for_turn_) return;
  waits_for_turn_ = true;
  handle_.getCallbackQueue()->addCallback(boost::make_shared<ActionCallback>([this] {
    waits_for_turn_ = false;
    publish_by_queue();
  }));
}

/// Publishes the next estimate that is due; where there is none, returns how long until then.
std::optional<Duration> EstimatePublication::publish_next() {
  const Duration cpu_time = thread_cpu_time();
  const boost::shared_ptr<StateEstimate> message = messages_->take();
  SharedRuntime::Parts parts;
  while (true) {
    const SharedRuntime::Access access = runtime_.access();
    if (!parts.are_enough(access->approach_next_due(access.now(), SharedRuntime::kSteps))) continue;
    const Estimate* estimate = access->next_due(access.now());
    if (estimate == nullptr) return access->next_due_time(access.now()) - access.now();
    write(*access, *estimate, *message);
    if (outputs_) outputs_->take(*access, *estimate);
    runtime_.statistics().record_estimate(*estimate->law, *estimate, access->bound(*estimate),
                                          access->lateness(estimate->stamp, access.now()));
    break;
  }
  publisher_.publish(message);
  if (outputs_) outputs_->publish();
  runtime_.statistics().record_tick(thread_cpu_time() - cpu_time);
  return std::nullopt;
}

}  // namespace sampled_data_observers
