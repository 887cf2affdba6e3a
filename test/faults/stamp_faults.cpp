// Stamps that are no time, or the wrong one.
#include "faults/fault.h"
#include "faults/messages.h"
#include "messages/time_conversion.h"
#include "support/stamps.h"

namespace sampled_data_observers::test {
namespace {

/// For one second, each sample comes a second time, with another stamp.
std::function<void(FaultBench&)> stamped(const std::function<ros::Time(Stamp)>& stamp_instead) {
  return [stamp_instead](FaultBench& bench) {
    bench.go_on(1.0, [&](Stamp stamp) {
      bench.sample(stamp);
      Measurement message = measurement(stamp, {5.0});
      message.header.stamp = stamp_instead(stamp);
      bench.publish("position", message);
    });
  };
}

std::function<void(FaultBench&)> stamped(const ros::Time& stamp) {
  return stamped([stamp](Stamp) { return stamp; });
}

ros::Time raw_time(std::uint32_t seconds, std::uint32_t nanoseconds) {
  ros::Time time;
  time.sec = seconds;
  time.nsec = nanoseconds;
  return time;
}

/// The sensor's clock is that much ahead: what it measured now seems to be from then.
std::function<void(FaultBench&)> clock_ahead(Duration difference) {
  return [difference](FaultBench& bench) {
    bench.go_on(1.0, [&](Stamp stamp) { bench.sample(stamp + difference, bench.truth(stamp)[0]); });
  };
}

/// A predicting sensor: the values are those of the stamps.
void tolerated_future(FaultBench& bench) {
  bench.go_on(1.0, [&](Stamp stamp) { bench.sample(stamp + 4 * kSecond / 10); });
}

void before_window(FaultBench& bench) {
  bench.go_on(6.0);
  for (int i = 0; i < 10; ++i) bench.sample(bench.now() - 55 * kSecond / 10 - i, 5.0);
  bench.await_statuses();
}

void duplicates(FaultBench& bench) {
  bench.go_on(1.0, [&](Stamp stamp) {
    bench.sample(stamp);
    bench.sample(stamp);
  });
}

/// Ten samples, the newest first.
void reversed(FaultBench& bench) {
  bench.let_pass(1.0);
  for (int i = 0; i < 10; ++i) bench.sample(bench.now() - i * kSecond / 10);
  bench.await_statuses();
}

void same_stamp(FaultBench& bench) {
  bench.let_pass(0.1);
  for (int i = 0; i < 10; ++i) bench.sample(bench.now(), 0.3 * i);
  bench.await_statuses();
}

/// As many as fill the history, all of them in the tolerated future.
void flood_of_future(FaultBench& bench) {
  for (int i = 0; i < 4000; ++i) {
    bench.publish("input", input(bench.now() + 4 * kSecond / 10 + i, {0.5}));
    if (i % 500 == 0) bench.await_statuses();  // roscpp holds 2000
  }
  bench.await_statuses();
  bench.let_pass(0.5);
}

void release_in_future(FaultBench& bench) {
  JumpEvent message = jump_event(bench.now());
  message.release = raw_time(4294967295u, 0);
  bench.publish("jumps", message);
  message.release = raw_time(4294967295u, 4294967295u);
  message.header.stamp = ros::Time();
  bench.publish("jumps", message);
  bench.await_statuses();
}

void thinned_future(FaultBench& bench) {
  bench.go_on(1.0, [&](Stamp stamp) {
    bench.sample(stamp + 9 * kSecond / 10);
    bench.sample(stamp);
  });
}

}  // namespace

std::vector<Fault> stamp_faults() {
  constexpr auto kFinite = Meanwhile::kFinite;
  const auto shifted = [](Duration difference) {
    return stamped([difference](Stamp stamp) { return to_ros_time(stamp + difference); });
  };
  return {
      {"Zero",
       "oscillator",
       "1 s of samples without a stamp, beside good ones",
       stamped(ros::Time()),
       {{EventStatus::NO_STAMP, 10}}},
      {"Garbage",
       "oscillator",
       "stamps of 4294967295 s and as many ns, beside good ones",
       stamped(raw_time(4294967295u, 4294967295u)),
       {{EventStatus::NO_STAMP, 10}}},
      {"LastOfAll",
       "oscillator",
       "the last second that a stamp can hold, in the year 2106",
       stamped(raw_time(4294967295u, 999999999u)),
       {{EventStatus::IN_FUTURE, 10}}},
      {"FirstOfAll",
       "oscillator",
       "the first nanosecond after 1970",
       stamped(raw_time(0, 1)),
       {{EventStatus::TOO_OLD, 10}}},
      {"Future",
       "oscillator",
       "samples from 0.6 s ahead; 0.5 s are tolerated",
       shifted(6 * kSecond / 10),
       {{EventStatus::IN_FUTURE, 10}}},
      {"BeforeTheReset",
       "oscillator",
       "samples from before the last reset",
       shifted(-3 * kSecond),
       {{EventStatus::TOO_OLD, 10}}},
      {"BeforeTheHistory",
       "oscillator",
       "samples from before the history window of 5 s",
       before_window,
       {{EventStatus::TOO_OLD, 10}}},
      {"ToleratedFuture",
       "oscillator",
       "right values from 0.4 s ahead",
       tolerated_future,
       {{EventStatus::USED_LATE, 16}},
       Meanwhile::kRight,
       1.5},
      {"ClockAhead",
       "oscillator",
       "a sensor whose clock is 0.3 s ahead, for 1 s",
       clock_ahead(3 * kSecond / 10),
       {{EventStatus::USED_LATE, kSome}},
       kFinite,
       1.5},
      {"ClockAheadBy3s",
       "oscillator",
       "a sensor whose clock is 3.1 s ahead, for 1 s",
       clock_ahead(31 * kSecond / 10),
       {{EventStatus::IN_FUTURE, 10}}},
      {"ClockBehind",
       "oscillator",
       "a sensor whose clock is 0.25 s behind, for 1 s",
       clock_ahead(-kSecond / 4),
       {{EventStatus::USED_LATE, kSome}},
       kFinite,
       1.5},
      {"Duplicates",
       "oscillator",
       "each sample twice, for 1 s",
       duplicates,
       {{EventStatus::DUPLICATE, 10}}},
      {"Reversed",
       "oscillator",
       "ten samples at once, the newest first",
       reversed,
       {{EventStatus::USED_LATE, 9}}},
      {"SameStamp",
       "oscillator",
       "ten values at one stamp",
       same_stamp,
       {{EventStatus::USED_LATE, kSome}},
       kFinite,
       1.5},
      {"FloodOfTheFuture",
       "oscillator",
       "4000 inputs from 0.4 s ahead, more than the history holds",
       flood_of_future,
       {},
       kFinite,
       1.0},
      {"ReleaseOfAJump",
       "oscillator",
       "jumps whose release is in the year 2106, or garbage",
       release_in_future,
       {{EventStatus::IN_FUTURE, 1}, {EventStatus::NO_STAMP, 1}}},
      {"FutureBeforeThinning",
       "thinned",
       "samples from 0.9 s ahead to a source with min_interval, "
       "before good ones",
       thinned_future,
       {{EventStatus::IN_FUTURE, 10}}},
  };
}

}  // namespace sampled_data_observers::test
