#include "faults/fault_bench.h"

#include <algorithm>

#include "faults/messages.h"
#include "messages/time_conversion.h"

namespace sampled_data_observers::test {
namespace {

/// The period of the estimates in all configurations [ns].
constexpr Duration kEstimatePeriod = 20'000'000;
constexpr Duration kClockStep = 100'000'000;
/// How long the plant and the observer run before a fault.
constexpr double kSettling = 0.5;  // s
constexpr double kInput = 0.5;

}  // namespace

FaultBench::FaultBench() {
  clock_ = handle_.advertise<rosgraph_msgs::Clock>("/clock", 100);
  status_subscriber_ = handle_.subscribe<EventStatus>(
      "events", 10000, [this](const EventStatusConstPtr& status) { statuses.push_back(*status); });
  estimate_subscriber_ = handle_.subscribe<StateEstimate>(
      "estimate", 10000, [this](const StateEstimateConstPtr& estimate) {
        estimates.push_back(*estimate);
        newest_estimate_ = to_stamp(estimate->header.stamp);
      });
  diagnostics_subscriber_ = handle_.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 10,
      [this](const diagnostic_msgs::DiagnosticArrayConstPtr& all) { diagnostics_ = *all; });
}

void FaultBench::use(const Configuration& configuration) {
  if (configuration_ == &configuration) return;
  unload();
  observer_.set_parameters(configuration.files);
  if (!observer_.load(configuration.type)) throw std::runtime_error("it does not start");
  configuration_ = &configuration;
  require(
      [this] {
        return status_subscriber_.getNumPublishers() > 0 &&
               estimate_subscriber_.getNumPublishers() > 0 && clock_.getNumSubscribers() >= 2;
      },
      "no connections");
}

void FaultBench::unload() {
  if (configuration_ == nullptr) return;
  configuration_ = nullptr;
  get_estimate_.shutdown();
  observer_.unload();
  require([this] { return status_subscriber_.getNumPublishers() == 0; }, "it stays");
}

void FaultBench::settle() {
  statuses.clear();
  sent_ = 0;
  now_ = first_multiple_from(now_ + 1, kClockStep);
  publish_clock(to_ros_time(now_));
  const State& start = configuration_->start;
  truth_.begin(configuration_->flow, now_, start, configuration_->has_input ? kInput : 0.0);
  // Until the observer has heard the clock, it starts at another time, and flows from there: the
  // clock may come between the two calls.
  require(
      [&] {
        publish_clock(to_ros_time(now_));
        if (!observer_.reset(start)) return false;  // it has no time yet
        const GetEstimate::Response found = get_estimate();
        return found.success != 0 && to_stamp(found.estimate.header.stamp) == now_ &&
               found.estimate.state == start;
      },
      "it does not start anew");
  go_on(kSettling);
  await_estimates();
  statuses.clear();
  estimates.clear();
  sent_ = 0;
}

void FaultBench::publish_clock(const ros::Time& time) {
  rosgraph_msgs::Clock message;
  message.clock = time;
  clock_.publish(message);
}

void FaultBench::set_clock(Stamp stamp) {
  if (stamp < now_) truth_.forget_after(stamp);
  now_ = stamp;
  await_clock(to_ros_time(now_));
}

void FaultBench::show_wrong_time(const ros::Time& time) { await_clock(time); }

void FaultBench::let_pass(double seconds) {
  const Stamp end = now_ + from_seconds(seconds);
  while (now_ < end) set_clock(std::min(end, now_ + kClockStep));
}

void FaultBench::let_pass_until_answered() {
  constexpr int kMostSteps = 200;
  const auto is_answered = [this] { return statuses.size() >= sent_; };
  for (int i = 0; !spin_until(is_answered, 0.05); ++i) {
    if (i == kMostSteps) throw std::runtime_error("messages without a status");
    let_pass(0.1);
  }
}

void FaultBench::go_on(double seconds) {
  go_on(seconds, [this](Stamp stamp) { sample(stamp); });
}

void FaultBench::go_on(double seconds, const std::function<void(Stamp)>& instead) {
  const Stamp end = now_ + from_seconds(seconds);
  while (now_ < end) {
    set_clock(now_ + configuration_->period);
    if (configuration_->has_input) {
      publish("input", input(now_, {kInput}));
      await_statuses();  // so that it is before the sample
    }
    instead(now_);
    await_statuses();
  }
}

void FaultBench::jump_truth() {
  State state = truth(now_);
  state[1] = -state[1];
  truth_.change(now_, state);
}

void FaultBench::push() {
  State state = truth(now_);
  for (std::size_t i = 0; i < state.size(); ++i) state[i] += configuration_->push[i];
  truth_.change(now_, state);
}

void FaultBench::require(const std::function<bool()>& done, const std::string& complaint) {
  if (!spin_until(done)) throw std::runtime_error(complaint);
}

void FaultBench::await_statuses() {
  require([this] { return statuses.size() >= sent_; }, "messages without a status");
}

void FaultBench::await_estimates() {
  const Stamp last = now_ - now_ % kEstimatePeriod;
  require([&] { return newest_estimate_ == last; }, "no estimate of the present time");
}

GetEstimate::Response FaultBench::get_estimate(const ros::Time& stamp) {
  if (!get_estimate_.isValid()) {
    const bool persistent = true;
    get_estimate_ = handle_.serviceClient<GetEstimate>("get_estimate", persistent);
  }
  GetEstimate call;
  call.request.stamp = stamp;
  if (!get_estimate_.call(call)) throw std::runtime_error("no answer: get_estimate");
  return call.response;
}

/// An observer without an estimate at the present time does not say what time it has; its next
/// events do not depend on that by less than the tolerated future.
void FaultBench::await_clock(const ros::Time& time) {
  publish_clock(time);
  require(
      [&] {
        const GetEstimate::Response found = get_estimate();
        return found.success == 0 || found.estimate.header.stamp == time;
      },
      "the clock is not heard");
}

std::string FaultBench::diagnosis(const std::string& name) const {
  for (const auto& status : diagnostics_.status) {
    if (status.name.find(name) != std::string::npos) return status.message;
  }
  return "";
}

}  // namespace sampled_data_observers::test
