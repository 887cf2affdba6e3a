// Jumps of the plant that are missed, invented, or flood in.
#include <limits>

#include "faults/fault.h"
#include "faults/messages.h"
#include "support/stamps.h"

namespace sampled_data_observers::test {
namespace {

void jump(FaultBench& bench, Stamp stamp) { bench.publish("jumps", jump_event(stamp)); }

void missed(FaultBench& bench) {
  bench.jump_truth();
  bench.go_on(0.5);
}

void invented(FaultBench& bench) {
  bench.let_pass(0.05);
  jump(bench, bench.now());
  bench.await_statuses();
}

/// The event comes when it is half a second old, after five samples.
void late(FaultBench& bench) {
  bench.go_on(0.1);
  const Stamp stamp = bench.now() + 1;
  bench.set_clock(stamp);
  bench.jump_truth();
  bench.set_clock(stamp + 50 * kMillisecond);
  bench.go_on(0.5);
  jump(bench, stamp);
  bench.await_statuses();
}

void twice(FaultBench& bench) {
  bench.let_pass(0.05);
  bench.jump_truth();
  jump(bench, bench.now());
  jump(bench, bench.now());
  bench.await_statuses();
}

void take_back(FaultBench& bench, Stamp stamp) {
  JumpEvent message = jump_event(stamp);
  message.withdraw = 1;
  bench.publish("jumps", message);
}

/// The detector finds out half a second later, after five samples.
void taken_back(FaultBench& bench) {
  bench.let_pass(0.05);
  const Stamp stamp = bench.now();
  jump(bench, stamp);
  bench.go_on(0.5);
  take_back(bench, stamp);
  bench.await_statuses();
}

void taken_back_before(FaultBench& bench) {
  bench.let_pass(0.05);
  take_back(bench, bench.now());
  bench.await_statuses();
  jump(bench, bench.now());
  bench.await_statuses();
}

void flood(FaultBench& bench) {
  bench.let_pass(1.0);
  for (int i = 999; i > 0; --i) jump(bench, bench.now() - i * kMillisecond);
  bench.await_statuses();
}

void rattle(FaultBench& bench) {
  bench.let_pass(0.05);
  for (int i = 0; i < 100; ++i) jump(bench, bench.now() + i);
  bench.await_statuses();
  bench.let_pass(0.05);
}

void unknown_mode(FaultBench& bench) {
  for (const int mode : {0, 3, -1, 2147483647, -2147483647 - 1}) {
    bench.go_on(0.1);
    bench.publish("jumps", jump_event(bench.now(), mode));
  }
  bench.await_statuses();
}

void with_values(FaultBench& bench) {
  JumpEvent message = jump_event(bench.now());
  message.values.assign(1000, 1.0);
  bench.publish("jumps", message);
  bench.await_statuses();
}

/// Goes on with the plant in contact or not, and with the signal that says so.
void go_on_with_signal(FaultBench& bench, double seconds, double force) {
  bench.go_on(seconds, [&](Stamp stamp) {
    bench.publish("contact", contact(stamp, force), 0);
    bench.sample(stamp);
  });
}

/// Then the plant jumps half way between two values of the signal, and that is to be found.
void detect_jump(FaultBench& bench) {
  go_on_with_signal(bench, 0.3, 0.0);
  bench.let_pass(0.05);
  bench.jump_truth();
  bench.let_pass(0.05);
  bench.publish("contact", contact(bench.now(), 20.0));
  bench.await_statuses();
}

void signal_from_future(FaultBench& bench) {
  bench.publish("contact", contact(4'000'000'000 * kNanosecondsPerSecond, 0.0));
  bench.publish("contact", contact(bench.now() + 600 * kMillisecond, 0.0));
  bench.await_statuses();
  detect_jump(bench);
}

void bad_signal(FaultBench& bench) {
  go_on_with_signal(bench, 0.2, 0.0);
  const double not_a_number = std::numeric_limits<double>::quiet_NaN();
  bench.publish("contact", contact(bench.now() + kMillisecond, not_a_number));
  bench.publish("contact", contact(bench.now() - kMillisecond, 20.0));
  bench.publish("contact", contact(0, 20.0));
  bench.await_statuses();
  detect_jump(bench);
}

}  // namespace

std::vector<Fault> jump_faults() {
  constexpr auto kFinite = Meanwhile::kFinite;
  return {
      {"Missed", "oscillator", "the plant jumps, and nobody says so", missed, {}, kFinite, 1.5},
      {"Invented", "oscillator", "a jump that was none", invented, {}, kFinite, 1.5},
      {"Late",
       "oscillator",
       "a jump that is told 0.5 s late, after five samples",
       late,
       {{EventStatus::USED_LATE, 1}},
       kFinite},
      {"Twice", "oscillator", "a jump that is told twice", twice, {{EventStatus::DUPLICATE, 1}}},
      {"TakenBack",
       "oscillator",
       "a jump that was none, which is taken back 0.5 s later, after five samples",
       taken_back,
       {{EventStatus::TAKEN_BACK, 1}},
       kFinite},
      {"TakenBackBefore",
       "oscillator",
       "a jump that was none, which comes after it was taken back",
       taken_back_before,
       {{EventStatus::NO_SUCH_JUMP, 1}, {EventStatus::WITHDRAWN, 1}}},
      {"Flood",
       "oscillator",
       "999 jumps that were none in 1 s, where five are allowed",
       flood,
       {{EventStatus::TOO_FREQUENT, 990}},
       kFinite,
       1.5},
      {"Rattle",
       "oscillator",
       "100 jumps that were none in 100 ns",
       rattle,
       {{EventStatus::TOO_FREQUENT, 99}},
       kFinite,
       1.5},
      {"UnknownMode",
       "switched",
       "jumps into modes that the plant does not have",
       unknown_mode,
       {{EventStatus::UNKNOWN_MODE, 5}}},
      {"WithValues",
       "oscillator",
       "a jump with 1000 outputs, where none is measured",
       with_values,
       {{EventStatus::WRONG_SIZE, 1}}},
      {"SignalFromTheFuture",
       "contact",
       "the signal of a jump detector, stamped 0.6 s ahead and in "
       "2096; then a jump that it must find",
       signal_from_future,
       {{EventStatus::IN_FUTURE, 2}},
       kFinite},
      {"BadSignal",
       "contact",
       "the signal of a jump detector: NaN, out of order, without a stamp; "
       "then a jump that it must find",
       bad_signal,
       {{EventStatus::NOT_FINITE, 1}, {EventStatus::OUT_OF_ORDER, 2}},
       kFinite},
  };
}

}  // namespace sampled_data_observers::test
