// Values that a broken sensor sends.
#include <cmath>
#include <limits>

#include "faults/fault.h"
#include "faults/messages.h"

namespace sampled_data_observers::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// For one second, each sample has these values instead.
std::function<void(FaultBench&)> samples_of(const std::vector<double>& values) {
  return [values](FaultBench& bench) {
    bench.go_on(1.0, [&](Stamp stamp) { bench.publish("position", measurement(stamp, values)); });
  };
}

/// One sample more, between two others, with this value.
std::function<void(FaultBench&)> one_sample_of(double value) {
  return [value](FaultBench& bench) {
    bench.let_pass(0.05);
    bench.sample(bench.now(), value);
    bench.await_statuses();
    bench.let_pass(0.05);
  };
}

/// The sensor shows for some seconds what it showed last.
std::function<void(FaultBench&)> stuck(double seconds) {
  return [seconds](FaultBench& bench) {
    const double last = bench.truth(bench.now())[0];
    bench.go_on(seconds, [&](Stamp stamp) { bench.sample(stamp, last); });
  };
}

void send_inputs(FaultBench& bench) {
  for (const std::vector<double>& values : {std::vector<double>{kNaN}, {-kInfinity}, {}, {1, 2}}) {
    bench.go_on(0.1);
    bench.publish("input", input(bench.now(), values));
  }
  bench.await_statuses();
}

/// One message of a wheel that slips, or of a bit that flipped, among good ones.
void spike_of_input(FaultBench& bench) {
  for (int i = 0; i < 5; ++i) {
    bench.go_on(0.1);
    bench.publish("input", input(bench.now(), {62.8}));
    bench.await_statuses();
  }
  bench.go_on(0.5);
}

void change_sign(FaultBench& bench) {
  bench.go_on(1.0, [&](Stamp stamp) { bench.sample(stamp, -bench.truth(stamp)[0]); });
}

void add_noise(FaultBench& bench) {
  int count = 0;
  bench.go_on(2.0, [&](Stamp stamp) {
    bench.sample(stamp, bench.truth(stamp)[0] + (++count % 2 == 0 ? 0.3 : -0.3));
  });
}

/// So that the estimate, held between samples, has no flow at all.
void reset_below_empty(FaultBench& bench) {
  bench.observer().reset({-1.0});
  bench.let_pass(0.3);
}

}  // namespace

std::vector<Fault> value_faults() {
  constexpr auto kFinite = Meanwhile::kFinite;
  return {
      {"NotANumber",
       "oscillator",
       "1 s of samples that are NaN",
       samples_of({kNaN}),
       {{EventStatus::NOT_FINITE, 10}}},
      {"Infinity",
       "oscillator",
       "1 s of samples that are infinite",
       samples_of({kInfinity}),
       {{EventStatus::NOT_FINITE, 10}}},
      {"LargestNumber",
       "oscillator",
       "1 s of samples of 1.8e308, whose square overflows",
       samples_of({std::numeric_limits<double>::max()}),
       {{EventStatus::NOT_FINITE, 10}}},
      {"NoValues",
       "oscillator",
       "1 s of samples without values",
       samples_of({}),
       {{EventStatus::WRONG_SIZE, 10}}},
      {"TooManyValues",
       "oscillator",
       "1 s of samples of 1000 values",
       samples_of(std::vector<double>(1000, 1.0)),
       {{EventStatus::WRONG_SIZE, 10}}},
      {"BadInputs",
       "oscillator",
       "inputs that are NaN, infinite, empty, and of two values",
       send_inputs,
       {{EventStatus::NOT_FINITE, 2}, {EventStatus::WRONG_SIZE, 2}}},
      {"InputSpike",
       "guarded",
       "inputs of 62.8 between good ones, where their limits are 1",
       spike_of_input,
       {{EventStatus::OUT_OF_LIMITS, 5}}},
      {"LargestAdmissible",
       "oscillator",
       "a sample of 1e100",
       one_sample_of(1e100),
       {},
       kFinite,
       25.0},
      {"Denormal",
       "oscillator",
       "a sample of 4.9e-324",
       one_sample_of(std::numeric_limits<double>::denorm_min()),
       {},
       kFinite},
      {"Outlier",
       "oscillator",
       "a sample that is off by 100, without a gate",
       one_sample_of(100.0),
       {},
       kFinite,
       2.0},
      {"OutlierAtAGate",
       "gated",
       "the same with a gate",
       one_sample_of(100.0),
       {{EventStatus::GATED, 1}}},
      {"ChangedSign",
       "oscillator",
       "1 s of samples of the wrong sign",
       change_sign,
       {},
       kFinite,
       1.5},
      {"StuckSensor", "oscillator", "3 s of the same value", stuck(3.0), {}, kFinite, 1.5},
      {"StuckSensorAtAGate",
       "gated",
       "the same with a gate that opens after 1 s",
       stuck(3.0),
       {{EventStatus::GATED, kSome}},
       kFinite,
       3.0},
      {"Noise", "oscillator", "2 s of noise of 0.3", add_noise, {}, kFinite, 1.5},
      {"HopelessWait",
       "unstable",
       "1 s of samples that are off by 1e-3, then 20 s without any: "
       "the flow of an unstable plant overflows, and the estimate is held",
       [](FaultBench& bench) {
         bench.go_on(1.0, [&](Stamp stamp) { bench.sample(stamp, 1e-3); });
         bench.let_pass(20.0);
       },
       {},
       kFinite,
       0.3},
      {"FormulaWithoutValue",
       "tank",
       "a reset to where the plant's formula has no value",
       reset_below_empty,
       {},
       kFinite,
       0.5},
      {"SampleWithoutFlow",
       "tank",
       "1 s of samples beyond which the formula has no value",
       samples_of({-100.0}),
       {},
       kFinite,
       0.5},
  };
}

}  // namespace sampled_data_observers::test
