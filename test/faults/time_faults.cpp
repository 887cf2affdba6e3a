// What a simulated clock does: it stops, leaps, goes back, or says nonsense.
#include "faults/fault.h"
#include "faults/messages.h"
#include "messages/time_conversion.h"
#include "support/stamps.h"

namespace sampled_data_observers::test {
namespace {

void stop(FaultBench& bench) {
  bench.await_estimates();
  const std::size_t before = bench.estimates.size();
  ros::WallDuration(0.3).sleep();
  FaultBench::require([&] { return bench.estimates.size() == before; }, "estimates go on");
}

/// It ticks once a second, with the stamps in between: those of more than 0.5 s ahead are rejected.
void coarse(FaultBench& bench) {
  for (int i = 0; i < 30; ++i) {
    if (i % 10 == 0) bench.set_clock(bench.now() + kSecond);
    bench.sample(bench.now() + i % 10 * kSecond / 10);
    bench.await_statuses();
  }
  bench.set_clock(bench.now() + kSecond);
}

void fine(FaultBench& bench) {
  for (int i = 0; i < 100; ++i) bench.set_clock(bench.now() + 100'000);
}

void jumps_ahead(FaultBench& bench) { bench.set_clock(bench.now() + 1000 * kSecond); }

/// By less than the tolerance: no stamp comes twice.
void set_back_a_little(FaultBench& bench) {
  bench.go_on(1.0);
  bench.set_clock(bench.now() - 4 * kSecond / 10);
  bench.sample(bench.now() + 1);
  bench.await_statuses();
  bench.let_pass(0.4);
}

/// Only a reset helps: the samples until then are before the history window.
void set_back(FaultBench& bench) {
  bench.go_on(6.0);
  bench.set_clock(bench.now() - 60 * kSecond);
  bench.go_on(1.0);
  bench.observer().reset(bench.truth(bench.now()));
}

void set_back_and_start_anew(FaultBench& bench) {
  bench.go_on(0.5);
  bench.await_estimates();
  bench.set_clock(bench.now() - 60 * kSecond);
}

void loop(FaultBench& bench) {
  for (int i = 0; i < 3; ++i) {
    bench.go_on(2.0);
    bench.await_estimates();
    bench.set_clock(bench.now() - 2 * kSecond);
    bench.go_on(0.1);
  }
}

/// For a moment it shows a time of long ago, or of the far future.
std::function<void(FaultBench&)> glitch(const ros::Time& time) {
  return [time](FaultBench& bench) {
    bench.go_on(0.5);
    bench.await_estimates();
    bench.show_wrong_time(time);
    bench.set_clock(bench.now() + kSecond / 10);
  };
}

/// As long as it takes for estimates of that time.
void far_ahead(FaultBench& bench) {
  const ros::Time last_of_all(4294967000, 0);
  bench.go_on(0.5);
  bench.await_estimates();
  bench.show_wrong_time(last_of_all);
  FaultBench::require([&] { return bench.estimates.back().header.stamp == last_of_all; },
                      "no estimate of the far future");
  bench.set_clock(bench.now() + kSecond / 10);
}

/// Samples that come while it shows zero wait until it goes on.
void zero(FaultBench& bench) {
  bench.go_on(0.5);
  bench.await_estimates();
  bench.show_wrong_time(ros::Time());
  bench.sample(bench.now() + kSecond / 20);
  ros::WallDuration(0.05).sleep();
  bench.set_clock(bench.now() + kSecond / 10);
  bench.go_on(0.1);
}

ros::Time garbage() {
  ros::Time time;
  time.sec = 5;
  time.nsec = 4294967295u;
  return time;
}

}  // namespace

std::vector<Fault> time_faults() {
  constexpr auto kFinite = Meanwhile::kFinite;
  return {
      {"Stops", "oscillator", "the clock stops: estimates, too", stop, {}},
      {"Coarse",
       "oscillator",
       "a clock that ticks once a second; samples in between come ahead of "
       "it, and 0.5 s are tolerated",
       coarse,
       {{EventStatus::IN_FUTURE, 12}},
       kFinite,
       1.5},
      {"Fine", "oscillator", "a clock that ticks 10000 times a second", fine, {}},
      {"JumpsAhead", "oscillator", "the clock jumps 1000 s ahead", jumps_ahead, {}},
      {"SetBackALittle",
       "oscillator",
       "the clock goes back by 0.4 s, less than is tolerated",
       set_back_a_little,
       {{EventStatus::USED_LATE, 1}}},
      {"SetBack",
       "oscillator",
       "the clock goes back by 60 s; after 1 s the service reset is called",
       set_back,
       {{EventStatus::TOO_OLD, 20}},
       kFinite,
       1.5,
       1},
      {"SetBackAndStartsAnew",
       "looping",
       "the same with reset_on_time_jump_back, and nobody calls",
       set_back_and_start_anew,
       {},
       kFinite,
       1.5,
       1},
      {"Loop", "looping", "a bag of 2 s that loops three times", loop, {}, kFinite, 1.5, 3},
      {"Zero",
       "looping",
       "the clock shows zero for a moment, and a sample comes then",
       zero,
       {},
       kFinite,
       1.5},
      {"FarAhead",
       "looping",
       "the clock shows the year 2106 for a moment",
       far_ahead,
       {},
       kFinite,
       1.5,
       1},
      {"LongAgo",
       "looping",
       "the clock shows the first second of 1970 for a moment",
       glitch(ros::Time(1, 0)),
       {},
       kFinite,
       1.5},
      {"Garbage",
       "looping",
       "the clock shows a time of 4294967295 ns after its second",
       glitch(garbage()),
       {},
       kFinite,
       1.5},
  };
}

}  // namespace sampled_data_observers::test
