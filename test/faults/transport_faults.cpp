// Messages that come late, in bursts, too fast, not at all, or from the wrong publisher.
#include <std_msgs/String.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "faults/fault.h"
#include "faults/malformed_message.h"
#include "faults/messages.h"
#include "support/stamps.h"

namespace sampled_data_observers::test {
namespace {

/// All samples of four seconds, a thousand, at once and in any order.
void late_burst(FaultBench& bench) {
  bench.let_pass(4.0);
  std::vector<Stamp> stamps;
  for (int i = 0; i < 1000; ++i) stamps.push_back(bench.now() - 4 * i * kMillisecond);
  std::shuffle(stamps.begin(), stamps.end(), std::mt19937(7));
  for (const Stamp stamp : stamps) bench.sample(stamp);
  bench.await_statuses();
}

void equal_burst(FaultBench& bench) {
  for (int i = 0; i < 1000; ++i) bench.sample(bench.now() - 50 * kMillisecond);
  bench.await_statuses();
}

void too_fast(FaultBench& bench) {
  for (int i = 0; i < 500; ++i) {
    bench.set_clock(bench.now() + kMillisecond);
    bench.sample(bench.now());
  }
  bench.await_statuses();
}

/// Each sample arrives up to 0.5 s late.
void random_delays(FaultBench& bench) {
  std::mt19937 random(3);
  std::uniform_int_distribution<Stamp> delay(0, 500 * kMillisecond);
  std::multimap<Stamp, Stamp> on_its_way;  // from arrivals to stamps
  for (int i = 0; i < 150; ++i) {
    bench.set_clock(bench.now() + 20 * kMillisecond);
    if (i % 5 == 0) on_its_way.emplace(bench.now() + delay(random), bench.now());
    while (!on_its_way.empty() && on_its_way.begin()->first <= bench.now()) {
      bench.sample(on_its_way.begin()->second);
      on_its_way.erase(on_its_way.begin());
    }
    bench.await_statuses();
  }
}

void half_is_lost(FaultBench& bench) {
  std::mt19937 random(5);
  bench.go_on(3.0, [&](Stamp stamp) {
    if (random() % 2 == 0) bench.sample(stamp);
  });
}

void publisher_dies(FaultBench& bench) {
  bench.end_publisher("joint_states");
  bench.let_pass(2.0);
}

/// From a publisher that roscpp refuses to connect with, until the diagnostics name it and both
/// definitions; so do the reasons.
template <class M>
void publish_refused(FaultBench& bench, const M& message) {
  const std::string sum = ros::message_traits::MD5Sum<M>::value();
  const std::string sender = ros::this_node::getName() + " on /joint_states has " +
                             ros::message_traits::DataType<M>::value() + ", MD5 sum " + sum +
                             "; expected sensor_msgs/JointState, " +
                             ros::message_traits::MD5Sum<sensor_msgs::JointState>::value();
  const auto is_named = [&] {
    return bench.diagnosis("events from encoder").find(sender) != std::string::npos;
  };
  bench.end_publisher("joint_states");
  for (int i = 0; !spin_until(is_named, 0.02); ++i) {
    if (i == 1500) throw std::runtime_error(bench.diagnosis("events from encoder"));
    bench.let_pass(0.1);
    bench.publish("joint_states", message);
    bench.await_statuses();
    const std::string& reason = bench.statuses.back().reason;
    if (reason.find(sender) == std::string::npos) throw std::runtime_error("it is told: " + reason);
  }
  bench.end_publisher("joint_states");
}

void wrong_type(FaultBench& bench) { publish_refused(bench, std_msgs::String()); }

void wrong_definition(FaultBench& bench) { publish_refused(bench, OutdatedMessage()); }

void malformed(FaultBench& bench) {
  bench.end_publisher("joint_states");
  for (int i = 0; i < 10; ++i) {
    bench.let_pass(0.1);
    bench.publish("joint_states", MalformedMessage());
    bench.await_statuses();
  }
  bench.end_publisher("joint_states");
}

void long_header(FaultBench& bench) {
  bench.go_on(1.0, [&](Stamp stamp) {
    Measurement message = measurement(stamp, {bench.truth(stamp)[0]});
    message.header.frame_id.assign(1000000, 'x');
    bench.publish("position", message);
  });
}

void input_is_silent(FaultBench& bench) {
  bench.end_publisher("input");
  for (int i = 0; i < 20; ++i) {
    bench.let_pass(0.1);
    bench.sample(bench.now());
    bench.await_statuses();
  }
}

/// The last input is wrong; from its timeout on it is taken as what it really is.
void input_times_out(FaultBench& bench) {
  bench.go_on(0.1);
  bench.publish("input", input(bench.now(), {0.9}));
  bench.await_statuses();
  bench.end_publisher("input");
  for (int i = 0; i < 40; ++i) {
    bench.let_pass(0.1);
    bench.sample(bench.now());
    bench.await_statuses();
  }
  bench.await_estimates();
  const StateEstimate& last = bench.estimates.back();
  if (last.input_stale == 0) throw std::runtime_error("a stale input is not told");
  const double error = std::abs(last.state[0] - bench.truth(bench.now())[0]);
  if (error > bench.configuration().tolerance) throw std::runtime_error("the input holds");
}

}  // namespace

std::vector<Fault> transport_faults() {
  return {
      {"LateBurst",
       "oscillator",
       "1000 samples of the last 4 s at once, in any order",
       late_burst,
       {{EventStatus::USED_LATE, kSome}},
       Meanwhile::kFinite},
      {"EqualBurst",
       "oscillator",
       "1000 times the same sample",
       equal_burst,
       {{EventStatus::USED_LATE, 1}, {EventStatus::DUPLICATE, 999}}},
      {"TooFast", "oscillator", "samples 1 ms apart, where T1 is 50 ms", too_fast, {}},
      {"RandomDelays",
       "oscillator",
       "3 s of samples that come up to 0.5 s late, in another order",
       random_delays,
       {{EventStatus::USED_LATE, kSome}}},
      {"HalfIsLost", "oscillator", "3 s in which every other sample is lost", half_is_lost, {}},
      {"Silence",
       "oscillator",
       "10 s without samples, where T2 is 0.3 s",
       [](FaultBench& bench) { bench.let_pass(10.0); },
       {}},
      {"PublisherDies",
       "joint",
       "a publisher that dies and comes back after 2 s",
       publisher_dies,
       {}},
      {"InputIsSilent",
       "oscillator",
       "the publisher of the input dies: it holds",
       input_is_silent,
       {}},
      {"InputTimesOut",
       "guarded",
       "the publisher of the input dies after a wrong one, whose timeout is 0.25 s",
       input_times_out,
       {{EventStatus::USED_LATE, 1}},
       Meanwhile::kFinite},
      {"WrongType",
       "joint",
       "a publisher of another type on the topic of a sensor",
       wrong_type,
       {{EventStatus::OTHER_DEFINITION, kSome}}},
      {"OtherDefinition",
       "joint",
       "the definition changes between publishers: for a while there is one of the right type that "
       "was built with another definition of it",
       wrong_definition,
       {{EventStatus::OTHER_DEFINITION, kSome}}},
      {"Malformed",
       "joint",
       "messages of the right type that end too early",
       malformed,
       {{EventStatus::MALFORMED, 10}}},
      {"LongHeader", "oscillator", "samples with a frame_id of 1 MB", long_header, {}},
  };
}

}  // namespace sampled_data_observers::test
