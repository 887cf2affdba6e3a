#include "sampled_data_observers/ros/estimate_publication.h"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <chrono>
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
/// How long the thread of all observers waits for one whose runtime is taken, say by an event that
/// rewinds far, and how long it then leaves it alone: the others wait no longer for it.
constexpr std::chrono::microseconds kPatienceForRuntime{200};
constexpr std::chrono::milliseconds kRestForRuntime{1};

/// The thread for estimates of observers with these options.
std::shared_ptr<DeadlineThread> thread_for(const RealTimeOptions& options, const NodeLog& log) {
  std::shared_ptr<DeadlineThread> thread = DeadlineThread::shared("estimates", options.priority);
  if (options.lock_memory) {
    const std::string objection = lock_memory();
    if (!objection.empty()) {
      log.warn("real_time/lock_memory: not possible, going on without: %s", objection.c_str());
    }
  }
  if (options.priority) {
    const std::string objection = thread->set_real_time_priority(*options.priority);
    if (!objection.empty()) {
      log.warn(
          "real_time/priority: not possible, going on without: %s (is there a line "
          "'rtprio' for this user in /etc/security/limits.conf?)",
          objection.c_str());
    }
  }
  return thread;
}

}  // namespace

/// The processor time of every so many ticks, since reading it takes a call of the system.
class EstimatePublication::MeasuredTick {
 public:
  explicit MeasuredTick(EstimatePublication& publication)
      : publication_(publication), ticks_(publication.ticks_) {
    if (ticks_ % publication.ticks_per_second_ == 0) began_ = thread_cpu_time();
  }
  ~MeasuredTick() {
    if (!began_) return;
    publication_.spent_ += thread_cpu_time() - *began_;
    if (publication_.ticks_ == ticks_) return;
    publication_.runtime_.statistics().record_tick(publication_.spent_);
    publication_.spent_ = 0;
  }
  MeasuredTick(const MeasuredTick&) = delete;
  MeasuredTick& operator=(const MeasuredTick&) = delete;

 private:
  EstimatePublication& publication_;
  const std::uint64_t ticks_;
  std::optional<Duration> began_;
};

EstimatePublication::EstimatePublication(const ros::NodeHandle& handle, SharedRuntime& runtime,
                                         std::unique_ptr<EstimateOutputs> outputs)
    : handle_(handle), runtime_(runtime), outputs_(std::move(outputs)) {
  StateEstimate prototype;
  bool is_bounded = false;
  {
    const SharedRuntime::Access access = runtime_.access();
    const Estimate estimate = access->estimator().make_estimate();
    write(*access, estimate, prototype);
    is_bounded = estimate.law->has_bound();
  }
  messages_ = std::make_unique<MessagePool<StateEstimate>>(prototype, kEstimatesHeld);
  publisher_ = handle_.advertise<StateEstimate>("estimate", kQueueLength);
  if (is_bounded) {
    ErrorEllipsoid ellipsoid;
    ellipsoid.header.frame_id = prototype.header.frame_id;
    ellipsoid.names = prototype.names;
    ellipsoid_.emplace(handle_, ellipsoid);
  }
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
  ticks_per_second_ =
      static_cast<std::uint64_t>(std::max<Duration>(1, kNanosecondsPerSecond / config.period));
  if (ros::Time::isSimTime()) {
    timer_.start();
  } else {
    task_ = std::make_unique<DeadlineTask>(thread_for(config.real_time, log),
                                           [this] { return publish_by_thread(); });
  }
}

void EstimatePublication::notice_event() {
  if (!task_) {
    if (!waits_for_turn_) publish_by_queue();
  } else if (publish_on_event_) {
    task_->wake();
  }
}

DeadlineThread::Clock::time_point EstimatePublication::publish_by_thread() {
  const DeadlineThread::Clock::time_point steady_now = DeadlineThread::Clock::now();
  const MeasuredTick measured(*this);
  const boost::shared_ptr<StateEstimate> message = messages_->take();
  Step step;
  {
    const SharedRuntime::Access access = runtime_.access_within(kPatienceForRuntime);
    if (!access.is_there()) return DeadlineThread::Clock::now() + kRestForRuntime;
    step = advance(access, *message);
  }
  if (step.is_written) publish(message);
  return steady_deadline(step.wait, steady_now);
}

void EstimatePublication::publish_by_queue() {
  for (int published = 0; published < kEstimatesPerTurn; ++published) {
    const ros::Time now = ros::Time::now();
    const MeasuredTick measured(*this);
    const boost::shared_ptr<StateEstimate> message = messages_->take();
    Step step;
    do {
      step = advance(runtime_.access(), *message);
    } while (!step.is_written && step.wait == 0);
    if (step.is_written) {
      publish(message);
      continue;
    }
    timer_.setPeriod(ros::Duration().fromNSec(step.wait), kFromNow);
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

/// Goes on to the next estimate that is due, and writes it where it is there now.
EstimatePublication::Step EstimatePublication::advance(const SharedRuntime::Access& access,
                                                       StateEstimate& message) {
  const Stamp now = access.now();
  if (!parts_.are_enough(access->approach_next_due(now, SharedRuntime::kSteps))) return {};
  parts_ = {};
  Step step;
  const Estimate* estimate = access->next_due(now);
  if (estimate != nullptr) {
    write(*access, *estimate, message);
    if (outputs_) outputs_->take(*access, *estimate);
    if (ellipsoid_) ellipsoid_->take(*access, *estimate);
    runtime_.statistics().record_estimate(*estimate->law, *estimate, access->bound(*estimate),
                                          access->lateness(estimate->stamp, now));
    step.is_written = true;
    if (access->is_due(now)) return step;
  }
  step.wait = access->next_due_time(now) - now;
  return step;
}

void EstimatePublication::publish(const boost::shared_ptr<StateEstimate>& message) {
  publisher_.publish(message);
  if (outputs_) outputs_->publish();
  if (ellipsoid_) ellipsoid_->publish();
  ++ticks_;
}

}  // namespace sampled_data_observers
