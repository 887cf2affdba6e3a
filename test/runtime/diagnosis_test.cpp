// What diagnostics say of what was recorded.
#include "sampled_data_observers/runtime/diagnosis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

using test::kSecond;

/// Names found in a finding's message, all of which must be there.
void expect(HealthLevel level, const std::vector<const char*>& parts, const Finding& finding) {
  EXPECT_EQ(level, finding.level) << finding.message;
  for (const char* part : parts) {
    EXPECT_NE(std::string::npos, finding.message.find(part)) << part << " | " << finding.message;
  }
}

std::string value(const Finding& finding, const std::string& key) {
  for (const auto& entry : finding.values) {
    if (entry.first == key) return entry.second;
  }
  return "no " + key;
}

class DiagnosisTest : public ::testing::Test {
 protected:
  static DiagnosisSubject subject() {
    DiagnosisSubject subject;
    subject.channels = {{"position", "/position", EventKind::kSample, "geometry_msgs/PoseStamped"},
                        {"input", "/input", EventKind::kInput, "geometry_msgs/TwistStamped"},
                        {"jumps", "/jumps", EventKind::kJump, "sampled_data_observers/JumpEvent"}};
    subject.history = 2 * kSecond;
    subject.period = kSecond / 100;
    subject.sampling = {kSecond / 100, kSecond / 2};
    subject.guarantee = "a theorem";
    return subject;
  }

  /// A second in which all went well.
  static RunStatistics good() {
    RunStatistics window(3);
    window.channels[0].outcomes[0] = 10;
    window.lateness = {100, 100'000, 500, 2000};
    window.newest_estimate = 99 * kSecond;
    window.error_bound = 0.5;
    return window;
  }

  static std::uint64_t& outcome(RunStatistics& window, EventOutcome outcome) {
    return window.channels[0].outcomes[static_cast<std::size_t>(outcome)];
  }

  void update(const RunStatistics& window) {
    now_ += kSecond;
    diagnosis_.update(window, now_, kSecond);
  }

  Diagnosis diagnosis_{subject()};
  Stamp now_ = 100 * kSecond;
};

TEST_F(DiagnosisTest, AllIsWell) {
  update(good());
  expect(HealthLevel::kOk, {"published"}, diagnosis_.estimates());
  EXPECT_EQ("100", value(diagnosis_.estimates(), "rate [Hz]"));
  EXPECT_EQ("0.0015 ms", value(diagnosis_.estimates(), "jitter"));
  expect(HealthLevel::kOk, {"used"}, diagnosis_.channel(0));
  expect(HealthLevel::kOk, {"nothing received on /jumps"}, diagnosis_.channel(2));
  expect(HealthLevel::kOk, {"valid"}, diagnosis_.certificate());
}

TEST_F(DiagnosisTest, SaysWhyThereIsNoEstimate) {
  diagnosis_.update(RunStatistics(3), 0, 0);
  expect(HealthLevel::kStale, {"/clock", "rosparam set /use_sim_time false"},
         diagnosis_.estimates());
  update(RunStatistics(3));
  expect(HealthLevel::kStale, {"nothing was received", "/position", "rostopic"},
         diagnosis_.estimates());
  expect(HealthLevel::kStale, {"/position", "rostopic"}, diagnosis_.channel(0));
  expect(HealthLevel::kWarn, {"/input"}, diagnosis_.channel(1));
  RunStatistics window(3);
  outcome(window, EventOutcome::kNoStamp) = 5;
  update(window);
  expect(HealthLevel::kError, {"/position", "stamp is zero", "header.stamp"},
         diagnosis_.estimates());
  expect(HealthLevel::kError, {"all rejected", "header.stamp"}, diagnosis_.channel(0));
}

TEST_F(DiagnosisTest, SaysWhatIsWrongWithTheEstimates) {
  RunStatistics window = good();
  window.lateness = Range();
  update(window);
  expect(HealthLevel::kError, {"no estimate since 99.000 s"}, diagnosis_.estimates());
  window = good();
  window.lateness.count = 60;
  update(window);
  expect(HealthLevel::kWarn, {"60 Hz instead of 100 Hz"}, diagnosis_.estimates());
  window = good();
  window.lateness.largest = 150'000'000;
  update(window);
  expect(HealthLevel::kWarn, {"150 ms late"}, diagnosis_.estimates());
  window = good();
  window.held = 3;
  update(window);
  expect(HealthLevel::kWarn, {"not finite"}, diagnosis_.estimates());
  window = good();
  window.saturated = 4;
  update(window);
  expect(HealthLevel::kWarn, {"4 of 100", "bound of saturations"}, diagnosis_.estimates());
  window = good();
  window.channels[0].trend = InnovationTrend::kGrowing;
  window.channels[0].innovation = 12.5;
  update(window);
  expect(HealthLevel::kWarn, {"innovations of position grow", "12.5", "does the estimate diverge?"},
         diagnosis_.estimates());
  EXPECT_EQ("12.5", value(diagnosis_.channel(0), "innovation, last"));
  window.channels[0].trend = InnovationTrend::kDiverging;
  window.held = 3;
  update(window);
  expect(HealthLevel::kError, {"the estimate diverges", "position", "signs of the gains"},
         diagnosis_.estimates());
  diagnosis_.update(good(), now_, 0);
  expect(HealthLevel::kStale, {"time stands still", "/use_sim_time"}, diagnosis_.estimates());
}

TEST_F(DiagnosisTest, SaysWhySamplesWereRejected) {
  RunStatistics window = good();
  outcome(window, EventOutcome::kInFuture) = 1;
  outcome(window, EventOutcome::kTooOld) = 3;
  outcome(window, EventOutcome::kDuplicate) = 9;
  update(window);
  const Finding finding = diagnosis_.channel(0);
  expect(HealthLevel::kWarn, {"4 of 23 rejected", "history window", "clocks"}, finding);
  EXPECT_EQ("3", value(finding,
                       "in all: older than the history window, the start or the last "
                       "reset"));
  EXPECT_EQ("9", value(finding, "in all: duplicate of an event taken in before"));
  update(good());
  expect(HealthLevel::kOk, {"used"}, diagnosis_.channel(0));
  EXPECT_EQ("3", value(diagnosis_.channel(0),
                       "in all: older than the history window, the start or the last reset"));
}

TEST_F(DiagnosisTest, NamesTheTransformThatIsMissing) {
  RunStatistics window(3);
  outcome(window, EventOutcome::kNoTransform) = 4;
  window.channels[0].detail = {EventOutcome::kNoTransform, "gps_origin -> mapp"};
  update(window);
  expect(HealthLevel::kError, {"in time: gps_origin -> mapp (", "tf_echo"}, diagnosis_.channel(0));
  expect(HealthLevel::kError, {"gps_origin -> mapp"}, diagnosis_.estimates());
  outcome(window, EventOutcome::kNoStamp) = 5;
  update(window);
  EXPECT_EQ(std::string::npos, diagnosis_.channel(0).message.find("mapp"));
}

TEST_F(DiagnosisTest, NamesTheWrongTypeOfATopicThatNothingComesFrom) {
  diagnosis_.set_published_type(0, "sensor_msgs/Imu");
  diagnosis_.set_published_type(1, "geometry_msgs/TwistStamped");
  update(RunStatistics(3));
  const char* wrong =
      "/position is published as sensor_msgs/Imu, expected geometry_msgs/PoseStamped";
  expect(HealthLevel::kError, {wrong}, diagnosis_.channel(0));
  expect(HealthLevel::kWarn, {"nothing received on /input"}, diagnosis_.channel(1));
  expect(HealthLevel::kStale, {wrong}, diagnosis_.estimates());
  diagnosis_.set_published_type(0, "");
  expect(HealthLevel::kStale, {"nothing received on /position"}, diagnosis_.channel(0));
  diagnosis_.set_published_type(0, "sensor_msgs/Imu");
  update(good());  // from another publisher
  expect(HealthLevel::kOk, {"used"}, diagnosis_.channel(0));
}

TEST_F(DiagnosisTest, StampsOlderThanTheHistoryAreTheCauseAndNotTheModel) {
  RunStatistics window = good();
  window.held = 50;
  window.channels[0].latency = {10, 0, 3 * kSecond, 9 * kSecond};
  update(window);
  const std::vector<const char*> cause = {"stamps on /position are 3 s older than the clock",
                                          "--clock", "/use_sim_time true"};
  expect(HealthLevel::kWarn, cause, diagnosis_.estimates());
  expect(HealthLevel::kWarn, cause, diagnosis_.channel(0));
  window.channels[0] = ChannelStatistics();  // a second without messages changes nothing
  update(window);
  expect(HealthLevel::kWarn, cause, diagnosis_.estimates());
  update(good());
  expect(HealthLevel::kOk, {"published"}, diagnosis_.estimates());
  window = good();
  window.channels[0].latency = {10, 0, kSecond, 9 * kSecond};  // one was late, but not all
  update(window);
  expect(HealthLevel::kOk, {"published"}, diagnosis_.estimates());
}

TEST_F(DiagnosisTest, DuplicatesAloneAreNoFault) {
  RunStatistics window = good();
  window.channels[0].outcomes[0] = 0;
  outcome(window, EventOutcome::kDuplicate) = 2;
  update(window);
  expect(HealthLevel::kOk, {}, diagnosis_.channel(0));
}

TEST_F(DiagnosisTest, ASensorThatFallsSilentIsStale) {
  update(good());
  RunStatistics silent = good();
  silent.channels[0] = ChannelStatistics();
  update(silent);
  expect(HealthLevel::kOk, {"nothing lately"}, diagnosis_.channel(0));
  for (int i = 0; i < 3; ++i) update(silent);
  expect(HealthLevel::kStale, {"nothing for 4 s on /position", "rostopic hz"},
         diagnosis_.channel(0));
  expect(HealthLevel::kWarn, {"suspended since 101.000 s", "no sample of position", "T2 = 0.5 s"},
         diagnosis_.certificate());
}

TEST_F(DiagnosisTest, ASensorThatNeverSpokeSuspendsTheCertificate) {
  RunStatistics silent = good();
  silent.channels[0] = ChannelStatistics();
  update(silent);
  expect(HealthLevel::kOk, {"valid"}, diagnosis_.certificate());
  for (int i = 0; i < 3; ++i) update(silent);
  expect(HealthLevel::kWarn, {"suspended since 101.000 s", "no sample of position", "T2 = 0.5 s"},
         diagnosis_.certificate());
  update(good());
  expect(HealthLevel::kOk, {"restored at 105.000 s"}, diagnosis_.certificate());
}

TEST_F(DiagnosisTest, IntervalsOutsideSuspendTheCertificateUntilTheyAreWithin) {
  RunStatistics window = good();
  window.channels[0].interval = {10, 3 * kSecond, kSecond / 10, 2 * kSecond};
  window.channels[0].long_intervals = 1;
  window.channels[0].violations = {1, 0, 100'700'000'000, 100'700'000'000};
  update(window);
  expect(HealthLevel::kWarn, {"1 times", "[0.01 s, 0.5 s]"}, diagnosis_.channel(0));
  expect(
      HealthLevel::kWarn,
      {"suspended since 100.700 s", "a time between events of position of 2 s, above T2 = 0.5 s"},
      diagnosis_.certificate());
  update(good());
  expect(HealthLevel::kOk, {"restored at 102.000 s", "suspended since 100.700 s"},
         diagnosis_.certificate());
}

TEST_F(DiagnosisTest, StampsAheadOfTheClockAreToldByHowMuch) {
  RunStatistics window = good();
  window.channels[0].outcomes[0] = 0;
  outcome(window, EventOutcome::kInFuture) = 10;
  window.channels[0].median_latency = -3'100'200'000;
  update(window);
  expect(
      HealthLevel::kError,
      {"all rejected", "3.1002 s ahead of the clock in the median", "stamp_offset: -3.1 in", "NTP"},
      diagnosis_.channel(0));
  EXPECT_EQ("-3100.2 ms", value(diagnosis_.channel(0), "latency, median"));
}

TEST_F(DiagnosisTest, TimesInAnotherUnitAreToldByTheirFactor) {
  DiagnosisSubject milliseconds = subject();
  milliseconds.sampling = {50 * kSecond, 200 * kSecond};
  diagnosis_.set_subject(milliseconds);
  RunStatistics window = good();
  window.channels[0].interval = {10, kSecond, kSecond / 20, kSecond / 5};
  window.channels[0].short_intervals = 10;
  update(window);
  expect(HealthLevel::kWarn,
         {"outside of [50 s, 200 s]", "T1 is 500 times the mean time", "in seconds?"},
         diagnosis_.channel(0));
  EXPECT_EQ("", describe_unit_of_times(0.1, 0.5, 2.0));
  EXPECT_NE(std::string::npos, describe_unit_of_times(20.0, 0.0, 0.1).find("200 times T2"));
  EXPECT_EQ("", describe_unit_of_times(20.0, 0.0, std::numeric_limits<double>::infinity()));
}

TEST_F(DiagnosisTest, InnovationsOfAllTimeAreShownForEachOutput) {
  DiagnosisSubject with_outputs = subject();
  with_outputs.channels[0].outputs = 2;
  diagnosis_.set_subject(with_outputs);
  for (const double sign : {1.0, -1.0}) {
    RunStatistics window = good();
    const double innovation[] = {3.0, 4.0 * sign};
    window.channels[0].innovations.add(innovation, 2, 2.0 + sign);
    update(window);
  }
  const Finding finding = diagnosis_.channel(0);
  EXPECT_EQ("3, 0", value(finding, "innovation, mean in all"));
  EXPECT_EQ("3, 4", value(finding, "innovation, RMS in all"));
  EXPECT_EQ("2 (2 where the model is right)",
            value(finding, "normalized innovation squared, mean in all"));
}

TEST_F(DiagnosisTest, AnInputOlderThanItsTimeoutIsTold) {
  DiagnosisSubject with_timeout = subject();
  with_timeout.channels[1].timeout = kSecond / 2;
  with_timeout.channels[1].after_timeout = "v = 0";
  diagnosis_.set_subject(with_timeout);
  RunStatistics window = good();
  window.channels[1].outcomes[0] = 1;
  window.channels[1].newest = now_ + kSecond;
  update(window);
  expect(HealthLevel::kOk, {"used"}, diagnosis_.channel(1));
  update(good());
  expect(HealthLevel::kWarn,
         {"the last input on /input is 1 s old", "timeout of 0.5 s", "taken as v = 0"},
         diagnosis_.channel(1));
  diagnosis_.set_subject(subject());
  update(good());
  update(good());
  expect(HealthLevel::kOk, {"nothing for 3 s: the last input holds"}, diagnosis_.channel(1));
}

TEST(DiagnosisOfSeveralSensorsTest, EachHasItsOwnTimes) {
  DiagnosisSubject subject;
  subject.channels = {{"gps", "/gps", EventKind::kSample, "", 0},
                      {"wheel", "/wheel", EventKind::kSample, "", 2}};
  subject.period = kSecond / 100;
  subject.history = 2 * kSecond;
  subject.guarantee = "a theorem";
  subject.sampling = SensorSampling({SamplingBounds{kSecond / 5, 8 * kSecond}, std::nullopt,
                                     SamplingBounds{kSecond / 20, 3 * kSecond}});
  Diagnosis diagnosis(subject);
  RunStatistics window(2);
  window.newest_estimate = 99 * kSecond;
  window.error_bound = 0.5;
  for (ChannelStatistics& channel : window.channels) channel.outcomes[0] = 1;
  window.channels[0].newest = 99 * kSecond;
  window.channels[1].newest = 98 * kSecond;
  diagnosis.update(window, 100 * kSecond, kSecond);
  EXPECT_EQ("0.2 s", value(diagnosis.certificate(), "T1 of gps"));
  EXPECT_EQ("3 s", value(diagnosis.certificate(), "T2 of wheel"));
  EXPECT_EQ("no T1", value(diagnosis.certificate(), "T1"));
  EXPECT_EQ("8 s", value(diagnosis.channel(0), "T2"));
  EXPECT_EQ("0.05 s", value(diagnosis.channel(1), "T1"));
  EXPECT_EQ("2 s", value(diagnosis.channel(1), "time since the last sample"));
  EXPECT_EQ("no", value(diagnosis.channel(1), "late now"));

  RunStatistics silent(2);
  silent.newest_estimate = 101 * kSecond;
  silent.error_bound = 0.5;
  diagnosis.update(silent, 102 * kSecond, kSecond);
  EXPECT_EQ("no", value(diagnosis.channel(0), "late now"));
  EXPECT_EQ("by 1 s", value(diagnosis.channel(1), "late now"));
  EXPECT_FALSE(diagnosis.is_suspended());
  diagnosis.update(silent, 104 * kSecond, kSecond);
  expect(HealthLevel::kOk, {}, diagnosis.channel(0));
  expect(HealthLevel::kStale, {"nothing for 4 s on /wheel"}, diagnosis.channel(1));
  expect(HealthLevel::kWarn, {"no sample of wheel for longer than T2 = 3 s"},
         diagnosis.certificate());

  window.channels[0].interval = {1, kSecond / 10, kSecond / 10, kSecond / 10};
  window.channels[0].short_intervals = 1;
  window.channels[0].violations = {1, 0, 104 * kSecond, 104 * kSecond};
  diagnosis.update(window, 105 * kSecond, kSecond);
  expect(HealthLevel::kWarn, {"outside of [0.2 s, 8 s]"}, diagnosis.channel(0));
  expect(HealthLevel::kOk, {}, diagnosis.channel(1));
  expect(HealthLevel::kWarn, {"wheel"}, diagnosis.certificate());
  diagnosis.update(RunStatistics(2), 106 * kSecond, kSecond);
  diagnosis.update(window, 107 * kSecond, kSecond);
  EXPECT_EQ("2", value(diagnosis.channel(0), "below T1 in all"));
  EXPECT_EQ("0", value(diagnosis.channel(1), "below T1 in all"));
}

TEST_F(DiagnosisTest, OtherGainsHaveOtherTimesAndGuarantees) {
  update(good());
  DiagnosisSubject other = subject();
  other.sampling = {kSecond / 100, 5 * kSecond};
  other.guarantee = "another theorem";
  diagnosis_.set_subject(other);
  RunStatistics silent = good();
  silent.channels[0] = ChannelStatistics();
  for (int i = 0; i < 4; ++i) update(silent);
  expect(HealthLevel::kOk, {"valid"}, diagnosis_.certificate());
  EXPECT_EQ("another theorem", value(diagnosis_.certificate(), "guarantee"));
  EXPECT_EQ("5 s", value(diagnosis_.certificate(), "T2"));
  EXPECT_EQ("10", value(diagnosis_.channel(0), "used in all"));
}

TEST_F(DiagnosisTest, WhatComesAfterABoundThatRestedOnItsAbsenceSuspendsTheCertificate) {
  RunStatistics window = good();
  window.channels[0].after_bound = 2;
  window.channels[0].latency = {3, 160'000'000, 50'000'000, 60'000'000};
  update(window);
  EXPECT_TRUE(diagnosis_.is_suspended());
  const std::string message = diagnosis_.certificate().message;
  EXPECT_NE(std::string::npos, message.find("2 events of ")) << message;
  EXPECT_NE(std::string::npos, message.find("set error_assumptions/latency")) << message;
  update(good());
  EXPECT_FALSE(diagnosis_.is_suspended());
  bool is_told = false;
  for (const auto& [key, value] : diagnosis_.channel(0).values) {
    is_told = is_told || (key == "after a published bound, in all" && value == "2");
  }
  EXPECT_TRUE(is_told);
}

TEST_F(DiagnosisTest, ALostBoundSuspendsTheCertificateUntilAReset) {
  RunStatistics lost = good();
  lost.error_bound = std::numeric_limits<double>::infinity();
  lost.bound_lost_since = 100'250'000'000;
  lost.bound_loss = BoundLoss::kUnknownInput;
  update(lost);
  expect(HealthLevel::kWarn, {"suspended since 100.250 s", "an input was rejected", "reset"},
         diagnosis_.certificate());
  EXPECT_TRUE(diagnosis_.is_suspended());
  update(lost);
  expect(HealthLevel::kWarn, {"suspended since 100.250 s", "an input was rejected", "reset"},
         diagnosis_.certificate());
  update(good());
  expect(HealthLevel::kOk, {"restored at 103.000 s"}, diagnosis_.certificate());
}

TEST(DiagnosisOfConfigurationsTest, WithoutCertificateThereIsNoneToSuspend) {
  Diagnosis without{DiagnosisSubject()};
  expect(HealthLevel::kOk, {"none configured"}, without.certificate());
  DiagnosisSubject subject;
  subject.warning = "the plant is another";
  expect(HealthLevel::kWarn, {"the plant is another"}, Diagnosis(subject).certificate());
}

}  // namespace
}  // namespace sampled_data_observers
