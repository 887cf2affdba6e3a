#include "config/sampling_config.h"

#include <gtest/gtest.h>

#include "support/config_faults.h"

namespace sampled_data_observers {
namespace {

using test::fault;
using test::parse;
using test::replaced;

const char kTwoSensors[] = R"(
observer: ConstantGainObserver
plant: {states: [p, v], A: [[0, 1], [0, 0]]}
sensors:
  gps: {C: [[1, 0]], source: {topic: gps}}
  lidar: {C: [[1, 0]], measured: at_jumps}
  wheel: {C: [[0, 1]], source: {topic: wheel}}
sampling: {gps: {T1: 0.2, T2: 1}, wheel: {T1: 0.05, T2: .inf}}
gains: {L: {gps: [[0.5], [0]], wheel: [[0], [0.5]]}}
)";

const char kMap[] = "sampling: {gps: {T1: 0.2, T2: 1}, wheel: {T1: 0.05, T2: .inf}}";
const char kGps[] = "gps: {C: [[1, 0]],";

/// Without the sensor that measures at jumps, which the plant has none of.
std::string two_sensors() {
  return replaced(kTwoSensors, "  lidar: {C: [[1, 0]], measured: at_jumps}\n", "");
}

SensorSampling times(const std::string& text) { return parse(text).options.sampling; }

void expect(Duration T1, Duration T2, const SamplingBounds& bounds) {
  EXPECT_EQ(T1, bounds.T1);
  EXPECT_EQ(T2, bounds.T2);
}

TEST(SamplingConfigTest, EachSensorHasTimesOfItsOwn) {
  for (const std::string& text :
       {two_sensors(), replaced(replaced(replaced(two_sensors(), kMap, ""), kGps,
                                         "gps: {C: [[1, 0]], sampling: {T1: 0.2, T2: 1},"),
                                "wheel: {", "wheel: {sampling: {T1: 0.05, T2: .inf}, ")}) {
    const SensorSampling sampling = times(text);
    expect(from_seconds(0.2), from_seconds(1.0), sampling.of_sensor(0));
    expect(from_seconds(0.05), kNoLongestTime, sampling.of_sensor(1));
    expect(from_seconds(0.05), kNoLongestTime, sampling.of_all());
  }
}

TEST(SamplingConfigTest, OneSectionIsForAllSensors) {
  const SensorSampling sampling =
      times(replaced(two_sensors(), kMap, "sampling: {T1: 0.1, T2: 0.3}"));
  expect(from_seconds(0.1), from_seconds(0.3), sampling.of_sensor(0));
  expect(from_seconds(0.1), from_seconds(0.3), sampling.of_sensor(1));
}

TEST(SamplingConfigTest, ThoseOfASensorLieInsideThoseOfTheGains) {
  const std::string own = "gps: {C: [[1, 0]], sampling: {T1: 0.3, T2: 0.5},";
  expect(from_seconds(0.3), from_seconds(0.5),
         times(replaced(two_sensors(), kGps, own)).of_sensor(0));
  const std::string found =
      fault(replaced(two_sensors(), kGps, replaced(own, "T1: 0.3", "T1: 0.1")));
  for (const char* part : {"sensors/gps/sampling", "inside [0.2, 1] s", "found [0.1, 0.5] s"}) {
    EXPECT_NE(std::string::npos, found.find(part)) << part << " | " << found;
  }
}

TEST(SamplingConfigTest, SensorsMayBeCalledAsTheTimesAre) {
  std::string text =
      replaced(two_sensors(), kMap, "sampling: {T1: {T1: 0.2, T2: 1}, T2: {T1: 0.05, T2: 0.1}}");
  text = replaced(replaced(text, "gps: {C", "T1: {C"), "wheel: {C", "T2: {C");
  text = replaced(replaced(text, "{gps: [[0.5]", "{T1: [[0.5]"), "wheel: [[0]", "T2: [[0]");
  expect(from_seconds(0.2), from_seconds(1.0), times(text).of_sensor(0));
  expect(from_seconds(0.05), from_seconds(0.1), times(text).of_sensor(1));
}

struct BadSampling {
  const char* sampling;
  std::vector<const char*> message;
};

TEST(SamplingConfigTest, WhatIsWrongIsToldOf) {
  const std::vector<BadSampling> all = {
      {"", {"sampling: expected T1 and T2", "sensors/gps/sampling", "the key is missing"}},
      {"sampling: {}", {"sampling/T1", "the key is missing"}},
      {"sampling: {gps: {T1: 0.2, T2: 1}}", {"sampling: expected", "found none of wheel"}},
      {"sampling: {gps: {T1: 0.2, T2: 1}, wheal: {T1: 1, T2: 2}}",
       {"sampling/wheal", "each sampled sensor (gps, wheel)", "is it a misspelling of 'wheel'?"}},
      {"sampling: {gps: {T1: 0.2, T2: 1}, sonar: {T1: 1, T2: 2}}", {"sampling/sonar", "'sonar'"}},
      {"sampling: {gps: {T1: 2, T2: 1}, wheel: {T1: 1, T2: 2}}",
       {"sampling/gps/T2", "not less than T1"}},
      {"sampling: {gps: 1, wheel: {T1: 1, T2: 2}}", {"sampling/gps", "a map of keys"}},
      {"sampling: {gps: {T1: 1, T2: 1, T3: 1}, wheel: {T1: 1, T2: 2}}", {"sampling/gps/T3"}},
      {"sampling: {T1: 0.2, T2: 1, wheel: {T1: 1, T2: 2}}", {"sampling/wheel", "unknown key"}},
      {"sampling: {T1: {T1: 1, T2: 2}, T2: 1}", {"sampling/T1", "a finite number"}}};
  for (const BadSampling& bad : all) {
    const std::string found = fault(replaced(two_sensors(), kMap, bad.sampling));
    for (const char* part : bad.message) {
      EXPECT_NE(std::string::npos, found.find(part)) << part << " | " << found;
    }
  }
}

TEST(SamplingConfigTest, OnlySampledSensorsHaveTimes) {
  const std::string text =
      replaced(replaced(kTwoSensors, "A: [[0, 1], [0, 0]]",
                        "A: [[0, 1], [0, 0]], jump_map: {A_d: [[1, 0], [0, 1]]}"),
               "ConstantGainObserver", "HybridKalmanFilter");
  const std::string filter = replaced(
      text, "gains: {L: {gps: [[0.5], [0]], wheel: [[0], [0.5]]}}",
      "gains: {P0: [[1, 0], [0, 1]], Q: [[1, 0], [0, 1]], Q_d: [[0, 0], [0, 0]], R: {gps: [[1]], "
      "lidar: [[1]], wheel: [[1]]}}");
  expect(from_seconds(0.05), kNoLongestTime, times(filter).of_sensor(2));
  std::string found =
      fault(replaced(filter, "measured: at_jumps", "measured: at_jumps, sampling: {T1: 1, T2: 2}"));
  EXPECT_NE(std::string::npos, found.find("sensors/lidar/sampling")) << found;
  EXPECT_NE(std::string::npos, found.find("none for a sensor with measured: at_jumps")) << found;
  found = fault(replaced(filter, "gps: {T1", "lidar: {T1: 1, T2: 2}, gps: {T1"));
  EXPECT_NE(std::string::npos, found.find("sampling/lidar")) << found;
}

}  // namespace
}  // namespace sampled_data_observers
