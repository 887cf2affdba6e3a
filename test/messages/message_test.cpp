// What needs no roscore: parameters as configuration, messages from results.
#include <gtest/gtest.h>
#include <sampled_data_observers/Measurement.h>

#include <cmath>

#include "messages/runtime_messages.h"
#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/config/event_channels.h"
#include "sampled_data_observers/config/yaml_file.h"
#include "sampled_data_observers/messages/message_pool.h"
#include "sampled_data_observers/runtime/observer_runtime.h"
#include "support/allocation_counter.h"
#include "support/config_faults.h"

namespace sampled_data_observers {
namespace {

using test::fault_of;

class ObserverRuntimeTest : public ::testing::Test {
 protected:
  static ObserverConfig config() {
    return read_observer_config(read_yaml_text(R"(
observer: ConstantGainObserver
plant: {states: [position, velocity], A: [[0, 1], [0, 0]]}
sensors: {odometer_with_a_rather_long_name: {C: [[1, 0]], source: {topic: s}}}
sampling: {T1: 0.05, T2: 0.2}
gains: {L: [[1], [5]]}
rate: 100
frame_id: map
)",
                                               "test.yaml"),
                                no_plant_plugins);
  }
  EventReport receive(Stamp stamp, double value) {
    const Event event{stamp, EventKind::kSample, 0, &value, 1};
    const EventReport report = runtime_.receive(event, stamp);
    write(channels_[0], event, report, "", stamp, status_);
    return report;
  }

  const std::vector<EventChannel> channels_ = event_channels(config());
  ObserverRuntime runtime_{config()};
  EventStatus status_;
};

TEST(GateStatusTest, SaysWhatAGateKeptOutAndThatItRecovered) {
  const char kText[] = R"(
observer: ConstantGainObserver
plant: {states: [p], A: [[0]]}
sensors: {s: {C: [[1]], gate: {innovation: 1, recovery: {after: 2, action: accept}}, source: {topic: s}}}
sampling: {T1: 0.5, T2: 2}
gains: {L: [[1]]}
)";
  const auto replace = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  for (const std::string& text : {std::string(kText), replace(kText, "accept", "reset")}) {
    const ObserverConfig config =
        read_observer_config(read_yaml_text(text, "test.yaml"), no_plant_plugins);
    const std::vector<EventChannel> channels = event_channels(config);
    ObserverRuntime runtime(config);
    EventStatus status;
    const auto send = [&](Stamp seconds, double value) {
      const Stamp stamp = seconds * kNanosecondsPerSecond;
      const Event event{stamp, EventKind::kSample, 0, &value, 1};
      const EventReport report = runtime.receive(event, stamp);
      write(channels[0], event, report, "", stamp, status);
      return report;
    };
    send(1, 0.0);
    send(2, 9.0);
    EXPECT_EQ(EventStatus::GATED, status.outcome);
    EXPECT_EQ(std::vector<double>{9.0}, status.values);
    EXPECT_EQ(std::vector<double>{9.0}, status.innovation);
    EXPECT_EQ(9.0, status.gate_share);
    EXPECT_TRUE(std::isnan(status.nis));
    EXPECT_NE(std::string::npos, status.reason.find("outside the gate"));
    EXPECT_TRUE(std::isnan(status.interval));
    EXPECT_TRUE(send(4, 9.0).recovers());
    EXPECT_EQ(EventStatus::USED, status.outcome);
    EXPECT_NE(std::string::npos, status.reason.find("recovery/after")) << status.reason;
    EXPECT_EQ(text == kText ? std::string::npos : 5, status.reason.find("after a reset"));
    EXPECT_LE(status.reason.size(), 64u);
    EXPECT_EQ(3.0, status.interval);
  }
}

TEST(GateStatusTest, AFilterTellsItsNormalizedInnovations) {
  const ObserverConfig config = read_observer_config(read_yaml_text(R"(
observer: HybridKalmanFilter
plant: {states: [p], A: [[0]]}
sensors: {s: {C: [[1]], gate: {mahalanobis: 4, recovery: {after: 2, action: accept}}, source: {topic: s}}}
sampling: {T1: 0.5, T2: 2}
gains: {P0: [[3]], Q: [[0]], R: {s: [[1]]}}
)",
                                                                    "test.yaml"),
                                                     no_plant_plugins);
  const std::vector<EventChannel> channels = event_channels(config);
  ObserverRuntime runtime(config);
  EventStatus status;
  const auto send = [&](Stamp seconds, double value) {
    const Stamp stamp = seconds * kNanosecondsPerSecond;
    const Event event{stamp, EventKind::kSample, 0, &value, 1};
    write(channels[0], event, runtime.receive(event, stamp), "", stamp, status);
  };
  send(1, 0.0);
  EXPECT_TRUE(status.innovation.empty());  // there was no estimate
  EXPECT_TRUE(std::isnan(status.gate_share));
  EXPECT_TRUE(std::isnan(status.nis));
  send(2, 2.0);  // P = 3 / 4
  EXPECT_EQ(std::vector<double>{2.0}, status.innovation);
  EXPECT_NEAR(4.0 / 1.75, status.nis, 1e-12);
  EXPECT_NEAR(2.0 / std::sqrt(1.75) / 4.0, status.gate_share, 1e-12);
}

TEST_F(ObserverRuntimeTest, WritesStatusAndEstimate) {
  receive(1'000'000'000, 2.0);
  receive(1'100'000'000, 3.0);
  EXPECT_EQ(1.1, status_.header.stamp.toSec());
  EXPECT_EQ("odometer_with_a_rather_long_name", status_.source);
  EXPECT_EQ(EventStatus::SAMPLE, status_.kind);
  EXPECT_EQ(EventStatus::USED, status_.outcome);
  EXPECT_DOUBLE_EQ(0.1, status_.interval);
  EXPECT_EQ(EventStatus::INTERVAL_WITHIN, status_.interval_check);
  EXPECT_EQ("used", status_.reason);
  ASSERT_EQ(1u, status_.innovation.size());
  EXPECT_NEAR(0.0, status_.innovation[0], 1e-12);
  EXPECT_TRUE(std::isnan(status_.gate_share));

  std::string reason;
  const Estimate* estimate = runtime_.estimate_at(1'150'000'000, reason);
  ASSERT_NE(nullptr, estimate);
  StateEstimate message;
  write(runtime_, *estimate, message);
  EXPECT_EQ((std::vector<std::string>{"position", "velocity"}), message.names);
  EXPECT_EQ("map", message.header.frame_id);
  EXPECT_EQ(2u, message.events);
  EXPECT_EQ(2u, message.samples);
  EXPECT_EQ(0u, message.jumps);
  EXPECT_DOUBLE_EQ(0.05, message.time_since_sample);
  EXPECT_TRUE(std::isnan(message.error_bound));  // nothing is guaranteed
  EXPECT_FALSE(message.held);
  // First sample: (2, 10). Then p = 2 + 10 * 0.1 = 3, no innovation.
  EXPECT_NEAR(3.5, message.state[0], 1e-15);
  EXPECT_NEAR(10.0, message.state[1], 1e-15);
}

TEST_F(ObserverRuntimeTest, ReportsAMessageThatIsNoEvent) {
  const Event event{1'000'000'000, EventKind::kSample, 0, nullptr, 0};
  const Stamp now = 1'250'000'000;
  const EventReport report = runtime_.reject(event, EventOutcome::kNoField, now);
  write(channels_[0], event, report, "", now, status_);
  EXPECT_FALSE(report.used());
  EXPECT_EQ(EventStatus::NO_FIELD, status_.outcome);
  EXPECT_EQ("the message does not hold a configured field", status_.reason);
  EXPECT_EQ(0.25, status_.latency);
}

TEST_F(ObserverRuntimeTest, SaysWhyThereIsNoEstimate) {
  std::string reason;
  EXPECT_EQ(nullptr, runtime_.estimate_at(1'000'000'000, reason));
  EXPECT_NE(std::string::npos, reason.find("no event"));
  receive(1'000'000'000, 2.0);
  EXPECT_EQ(nullptr, runtime_.estimate_at(999'999'999, reason));
  EXPECT_NE(std::string::npos, reason.find("before the first event"));
  receive(1'000'000'001, 2.0);
  receive(9'000'000'000, 2.0);
  EXPECT_EQ(nullptr, runtime_.estimate_at(1'000'000'000, reason));
  EXPECT_NE(std::string::npos, reason.find("history window"));
}

TEST_F(ObserverRuntimeTest, RestartChecksWhatItIsGiven) {
  EXPECT_NE("", runtime_.restart(5, {1.0}));
  EXPECT_NE("", runtime_.restart(5, {1.0, std::nan("")}));
  EXPECT_EQ("", runtime_.restart(5, {1.0, 2.0}));
  EXPECT_EQ("", runtime_.restart(6, {}));
}

TEST_F(ObserverRuntimeTest, EventsFlowAndMessagesAllocateNothing) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  StateEstimate prototype;
  write(runtime_, runtime_.estimator().make_estimate(), prototype);
  MessagePool<StateEstimate> estimates(prototype, 4);
  receive(1'000'000'000, 0.0);
  receive(1'000'000'000, 0.0);  // the longest reason, too
  std::size_t published = 0;
  const std::size_t before = test::allocations();
  for (Stamp stamp = 1'100'000'000; stamp < 20'000'000'000; stamp += 100'000'000) {
    receive(stamp, 1.0);
    receive(stamp - 50'000'000, 1.0);
    receive(stamp, 1.0);
    while (const Estimate* estimate = runtime_.next_due(stamp)) {
      write(runtime_, *estimate, *estimates.take());
      ++published;
    }
  }
  EXPECT_EQ(before, test::allocations());
  EXPECT_EQ(1891u, published);  // from 1.0 s to 19.9 s
}

TEST(CovarianceMessageTest, HoldsTheCovarianceAndAllocatesNothing) {
  const ObserverConfig config = read_observer_config(read_yaml_text(R"(
observer: HybridKalmanFilter
plant: {states: [p, v], A: [[0, 1], [0, 0]], jump_map: {A_d: [[1, 0], [0, -1]]}}
sensors: {s: {C: [[1, 0]], source: {topic: s}}}
sampling: {T1: 0.05, T2: 0.2}
gains: {P0: [[3, 1], [1, 2]], R: [[1]]}
)",
                                                                    "test.yaml"),
                                                     no_plant_plugins);
  ObserverRuntime runtime(config);
  const std::vector<EventChannel> channels = event_channels(config);
  StateEstimate prototype;
  write(runtime, runtime.estimator().make_estimate(), prototype);
  MessagePool<StateEstimate> estimates(prototype, 4);
  EventStatus status;
  status.values.resize(1);  // room, as those of an observer have
  status.innovation.resize(1);
  const double y = 1.0;
  const auto receive = [&](Stamp stamp) {
    const Event event{stamp, EventKind::kSample, 0, &y, 1};
    write(channels[0], event, runtime.receive(event, stamp), "", stamp, status);
  };
  receive(1'000'000'000);
  std::string reason;
  const Estimate* first = runtime.estimate_at(1'000'000'000, reason);
  ASSERT_NE(nullptr, first);
  const boost::shared_ptr<StateEstimate> message = estimates.take();
  write(runtime, *first, *message);
  // P0 - P0 C' (C P0 C' + R)^-1 C P0
  const std::vector<double> expected = {0.75, 0.25, 0.25, 1.75};
  ASSERT_EQ(expected.size(), message->covariance.size());
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(expected[i], message->covariance[i], 1e-15);

  if (!test::allocations_are_counted()) return;
  receive(1'050'000'000);  // the status holds an innovation from then on
  const std::size_t before = test::allocations();
  for (Stamp stamp = 1'100'000'000; stamp < 3'000'000'000; stamp += 100'000'000) {
    receive(stamp);
    while (const Estimate* estimate = runtime.next_due(stamp)) {
      write(runtime, *estimate, *estimates.take());
    }
  }
  EXPECT_EQ(before, test::allocations());
}

TEST(MessagePoolTest, GivesAMessageThatNobodyHolds) {
  MessagePool<Measurement> pool(Measurement(), 2);
  const boost::shared_ptr<Measurement> first = pool.take();
  const boost::shared_ptr<Measurement> second = pool.take();
  EXPECT_NE(first, second);
  const boost::shared_ptr<Measurement> third = pool.take();
  EXPECT_NE(first, third);
  EXPECT_NE(second, third);
}

}  // namespace
}  // namespace sampled_data_observers
