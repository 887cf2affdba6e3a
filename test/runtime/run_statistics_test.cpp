#include "sampled_data_observers/runtime/run_statistics.h"

#include <gtest/gtest.h>

#include <limits>
#include <thread>

#include "plant/linear_plant.h"
#include "sampled_data_observers/observer/plant_observer.h"
#include "support/allocation_counter.h"

namespace sampled_data_observers {
namespace {

Event sample(Stamp stamp) {
  Event event;
  event.stamp = stamp;
  return event;
}

EventReport report(EventOutcome outcome) {
  EventReport result;
  result.outcome = outcome;
  return result;
}

EventReport used_after(Duration interval, IntervalCheck check) {
  EventReport result;
  result.interval = interval;
  result.interval_check = check;
  return result;
}

/// One state, which is its own error bound, and has a bound of 10.
class BoundLaw final : public PlantObserver, public StateBound {
 public:
  BoundLaw() : PlantObserver({plant_of_one_state(), Eigen::VectorXd::Zero(1), {}}, {}) {
    build_flow();
    set_bound(this);
  }
  double error_bound(const double* state) const override { return *state; }
  BoundLoss bound_loss(const double*) const override { return BoundLoss::kNone; }
  void keep_bound(const PublishedBound&, double*) const override {}
  void give_up(double*) const override {}
  bool is_saturated(const double* state) const override { return *state >= 10.0; }

 private:
  static std::shared_ptr<const Plant> plant_of_one_state() {
    LinearPlantDescription plant;
    plant.state_names = {"x"};
    plant.A = Eigen::MatrixXd::Zero(1, 1);
    plant.B = Eigen::MatrixXd::Zero(1, 0);
    return make_linear_plant(plant);
  }
};

Estimate estimate(Stamp stamp, double value) {
  Estimate result;
  result.stamp = stamp;
  result.state = Eigen::VectorXd::Constant(1, value);
  return result;
}

TEST(StatisticsRecorderTest, InnovationsAreSummedWithoutAllocation) {
  StatisticsRecorder recorder(1, 2);
  RunStatistics statistics(1);
  const double innovation[] = {1.0, -2.0};
  EventReport used = report(EventOutcome::kUsed);
  used.innovations = innovation;
  used.nis = 3.0;
  Event event = sample(1);
  event.size = 2;
  const std::size_t before = test::allocations();
  recorder.record_event(0, event, used, 0);
  used.outcome = EventOutcome::kUsedLate;
  used.nis = 5.0;
  recorder.record_event(0, event, used, 0);
  used.outcome = EventOutcome::kGated;
  used.nis = 500.0;
  recorder.record_event(0, event, used, 0);
  used.outcome = EventOutcome::kWouldOverflow;
  recorder.record_event(0, event, used, 0);
  event.size = 3;
  used.outcome = EventOutcome::kUsed;
  recorder.record_event(0, event, used, 0);  // more than there is place for
  EXPECT_EQ(before, test::allocations());
  recorder.take(statistics);
  const InnovationStatistics& found = statistics.channels[0].innovations;
  EXPECT_EQ(2u, found.count);
  EXPECT_EQ(-2.0, found.mean(1));
  EXPECT_EQ(1.0, found.rms(0));
  EXPECT_EQ(4.0, found.nis());
  recorder.take(statistics);
  EXPECT_EQ(0u, statistics.channels[0].innovations.count);
}

TEST(RangeRecorderTest, TakesWhatWasRecordedSince) {
  RangeRecorder recorder;
  EXPECT_EQ(0u, recorder.take().count);
  for (const std::int64_t value : {3, -5, 4}) recorder.record(value);
  const Range range = recorder.take();
  EXPECT_EQ(3u, range.count);
  EXPECT_EQ(2, range.sum);
  EXPECT_EQ(-5, range.smallest);
  EXPECT_EQ(4, range.largest);
  recorder.record(7);
  EXPECT_EQ(7, recorder.take().smallest);
}

TEST(RangeRecorderTest, LosesNothingThatThreadsRecordAtOnce) {
  constexpr std::int64_t kEach = 20000;
  RangeRecorder recorder;
  Range all;
  const auto record = [&] {
    for (std::int64_t i = 1; i <= kEach; ++i) recorder.record(i);
  };
  std::thread one(record);
  std::thread other(record);
  for (int i = 0; i < 100; ++i) all.add(recorder.take());
  one.join();
  other.join();
  all.add(recorder.take());
  EXPECT_EQ(2u * kEach, all.count);
  EXPECT_EQ(kEach * (kEach + 1), all.sum);
  EXPECT_EQ(1, all.smallest);
  EXPECT_EQ(kEach, all.largest);
}

TEST(StatisticsRecorderTest, CountsEventsByChannelAndOutcome) {
  StatisticsRecorder recorder(2);
  recorder.record_event(0, sample(100), used_after(30, IntervalCheck::kWithin), 5);
  recorder.record_event(0, sample(200), used_after(100, IntervalCheck::kLong), 7);
  recorder.record_event(0, sample(201), used_after(1, IntervalCheck::kShort), 6);
  EventReport late = report(EventOutcome::kUsedLate);
  late.rewound = 4;
  recorder.record_event(0, sample(150), late, 60);
  recorder.record_event(1, sample(0), report(EventOutcome::kNoStamp), 1'000'000);
  RunStatistics window(2);
  recorder.take(window);
  const ChannelStatistics& first = window.channels[0];
  EXPECT_EQ(4u, first.received());
  EXPECT_EQ(4u, first.used());
  EXPECT_EQ(1u, first.count(EventOutcome::kUsedLate));
  EXPECT_EQ(1u, first.long_intervals);
  EXPECT_EQ(1u, first.short_intervals);
  EXPECT_EQ(1, first.interval.smallest);
  EXPECT_EQ(100, first.interval.largest);
  EXPECT_EQ(200, first.violations.smallest);
  EXPECT_EQ(201, first.violations.largest);
  EXPECT_EQ(201, first.newest);
  EXPECT_EQ(std::nullopt, window.channels[1].newest);
  EXPECT_EQ(60, first.latency.largest);
  EXPECT_EQ(1u, first.rewound.count);
  EXPECT_EQ(4, first.rewound.largest);
  EXPECT_EQ(0u, window.channels[1].used());
  EXPECT_EQ(1u, window.channels[1].count(EventOutcome::kNoStamp));
  EXPECT_EQ(0u, window.channels[1].latency.count);  // no stamp, no latency

  RunStatistics totals(2);
  totals.add(window);
  recorder.record_event(1, sample(300), report(EventOutcome::kTooOld), 5);
  recorder.take(window);
  EXPECT_EQ(0u, window.channels[0].received());
  totals.add(window);
  EXPECT_EQ(4u, totals.channels[0].received());
  EXPECT_EQ(2u, totals.channels[1].received());
}

TEST(StatisticsRecorderTest, KnowsSinceWhenTheBoundIsLost) {
  const BoundLaw law;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const PublishedBound lost = {kInfinity, BoundLoss::kUnknownInput};
  StatisticsRecorder recorder(0);
  RunStatistics window(0);
  recorder.record_estimate(law, estimate(10, 0.5), {0.5, BoundLoss::kNone}, 3);
  recorder.take(window);
  EXPECT_FALSE(window.bound_lost_since);
  EXPECT_EQ(0.5, window.error_bound);
  EXPECT_EQ(0u, window.saturated);
  recorder.record_estimate(law, estimate(20, kInfinity), lost, 4);
  recorder.record_estimate(law, estimate(30, kInfinity), lost, 9);
  recorder.take(window);
  EXPECT_EQ(20, *window.bound_lost_since);
  EXPECT_EQ(BoundLoss::kUnknownInput, window.bound_loss);
  EXPECT_EQ(30, *window.newest_estimate);
  EXPECT_EQ(2u, window.saturated);
  EXPECT_EQ(9, window.lateness.largest);
  recorder.record_estimate(law, estimate(40, 0.25), {0.25, BoundLoss::kNone}, 3);
  recorder.take(window);
  EXPECT_FALSE(window.bound_lost_since);
  // Near a jump it is only not given, as at every jump whose stamp may be off.
  recorder.record_estimate(law, estimate(50, kInfinity), {kInfinity, BoundLoss::kNearJump}, 3);
  recorder.take(window);
  EXPECT_FALSE(window.bound_lost_since);
}

TEST(StatisticsRecorderTest, KeepsWhatIsSaidLastOfEachChannel) {
  StatisticsRecorder recorder(2);
  RunStatistics window(2);
  recorder.record_detail(1, EventOutcome::kOtherDefinition, "/node on /topic");
  recorder.record_detail(1, EventOutcome::kNoTransform, "lens -> odom");
  recorder.take(window);
  EXPECT_EQ("", window.channels[0].detail.text);
  EXPECT_EQ("lens -> odom", window.channels[1].detail.text);
  EXPECT_EQ(EventOutcome::kNoTransform, window.channels[1].detail.outcome);
  recorder.take(window);
  RunStatistics totals(2);
  totals.add(window);
  EXPECT_EQ("lens -> odom", totals.channels[1].detail.text);
}

TEST(StatisticsRecorderTest, AllocatesNothing) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer allocates";
  const BoundLaw law;
  const Estimate some = estimate(10, 0.5);
  StatisticsRecorder recorder(1);
  RunStatistics window(1);
  const std::string detail(100, 'x');
  window.channels[0].detail.text = detail;  // has room for the next
  const std::size_t before = test::allocations();
  recorder.record_detail(0, EventOutcome::kNoTransform, detail);
  recorder.record_event(0, sample(100), used_after(30, IntervalCheck::kLong), 5);
  recorder.record_estimate(law, some, {0.5, BoundLoss::kNone}, 3);
  recorder.record_tick(100);
  recorder.take(window);
  EXPECT_EQ(before, test::allocations());
}

}  // namespace
}  // namespace sampled_data_observers
