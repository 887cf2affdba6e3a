#include "observer/switched_observer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "sampled_data_observers/plant/expression_map.h"
#include "sampled_data_observers/plant/linear_flow.h"
#include "sampled_data_observers/runtime/estimator.h"
#include "support/allocation_counter.h"
#include "support/random_events.h"
#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

using test::kStart;
using test::OwnedEvent;

/// Two oscillators about the same rest x = (1, 0), which has the output 1: ẋ = A_q (x − (1, 0)).
Eigen::Matrix2d A(int mode) {
  Eigen::Matrix2d result;
  result << 0.0, 1.0, mode == 1 ? -1.0 : -4.0, mode == 1 ? 0.0 : -0.1;
  return result;
}
const Eigen::Vector2d kRest(1.0, 0.0);

std::shared_ptr<const AffineMap> output(double c1, double c2) {
  Eigen::MatrixXd C(1, 2);
  C << c1, c2;
  return std::make_shared<const AffineMap>(C);
}

/// Modes 1 and 2 with y = x1; `timings`: one sensor each.
PlantDescription oscillators(const std::vector<SensorTiming>& timings) {
  PlantDescription plant;
  plant.state_names = {"x1", "x2"};
  for (int mode : {1, 2}) {
    PlantMode maps;
    maps.label = mode;
    maps.flow = std::make_shared<const AffineMap>(A(mode), Eigen::MatrixXd(2, 0), -A(mode) * kRest);
    maps.outputs.assign(timings.size(), output(1.0, 0.0));
    plant.modes.push_back(maps);
  }
  for (const SensorTiming timing : timings) {
    plant.sensors.push_back({"s" + std::to_string(plant.sensors.size()), timing, {false}});
  }
  return plant;
}

ObserverContext context(const PlantDescription& plant) {
  return {std::make_shared<const Plant>(plant), Eigen::Vector2d(-0.5, 2.0), Eigen::VectorXd(0)};
}

Eigen::MatrixXd gain(double first, double second) { return Eigen::Vector2d(first, second); }

std::shared_ptr<const VectorMap> formulas(const std::vector<std::string>& texts) {
  std::vector<NamedExpression> expressions;
  for (const std::string& text : texts) expressions.push_back({"formula", text});
  return std::make_shared<const ExpressionMap>(ExpressionNames{{"tau"}, {}, {}},
                                               std::vector<NamedExpression>{}, expressions);
}

struct ModalBody {
  explicit ModalBody(std::shared_ptr<const ObserverLaw> of)
      : law(std::move(of)), state(law->state_size()), workspace(law->workspace_size()) {
    law->initialize(state.data());
  }
  void take(EventKind kind, int sensor, std::vector<double> values,
            std::optional<double> mode = std::nullopt) {
    const OwnedEvent event{kStart, kind, sensor, std::move(values), mode};
    EXPECT_EQ(Effect::kApplied, law->reset(event.view(), state.data(), workspace.data()));
  }
  void flow(double seconds) { law->flow(from_seconds(seconds), state.data(), workspace.data()); }
  Eigen::Vector2d x() const { return state.head(2); }
  std::shared_ptr<const ObserverLaw> law;
  Eigen::VectorXd state;
  Eigen::VectorXd workspace;
};

constexpr auto kContinuous = SensorTiming::kContinuous;
constexpr auto kAtJumps = SensorTiming::kAtJumps;

TEST(SwitchedFlowBasedTest, TheErrorFollowsTheModesMatrices) {
  // The plant rests, so holding y_c is exact: ė = (A_q − L_q H) e.
  SwitchedGains gains;
  gains.L_c = {{gain(2.0, 0.5)}, {gain(3.0, -1.0)}};
  ModalBody body(
      std::make_shared<const SwitchedObserver>(context(oscillators({kContinuous})), gains));
  Eigen::Vector2d e = body.x() - kRest;
  const double initial = e.norm();
  const Eigen::RowVector2d H(1.0, 0.0);
  body.take(EventKind::kOutput, 0, {1.0});
  std::mt19937_64 generator(11);
  std::uniform_real_distribution<double> interval(0.5, 2.0);
  for (int k = 0; k < 30; ++k) {
    const int mode = k % 2 + 1;
    const double tau = interval(generator);
    const LinearFlow flow(A(mode) - gains.L_c[static_cast<std::size_t>(mode - 1)][0] * H,
                          Eigen::MatrixXd(2, 0));
    Eigen::Vector2d scratch;
    flow.apply(from_seconds(tau), e.data(), nullptr, scratch.data());
    body.flow(tau);
    EXPECT_LT((body.x() - kRest - e).norm(), 1e-13);
    body.take(EventKind::kJump, 0, {}, mode == 1 ? 2.0 : 1.0);
    body.take(EventKind::kOutput, 0, {1.0});  // what it said before the jump is forgotten
  }
  EXPECT_LT((body.x() - kRest).norm(), 1e-9 * initial);
}

TEST(SwitchedFlowBasedTest, FlowsAsThePlantBeforeTheFirstOutput) {
  SwitchedGains gains;
  gains.L_c = {{gain(2.0, 0.5)}, {gain(3.0, -1.0)}};
  ModalBody body(
      std::make_shared<const SwitchedObserver>(context(oscillators({kContinuous})), gains));
  body.flow(0.75);
  const double c = std::cos(0.75);
  const double s = std::sin(0.75);
  EXPECT_LT((Eigen::Vector2d(1.0 - 1.5 * c + 2.0 * s, 1.5 * s + 2.0 * c) - body.x()).norm(), 1e-14);
}

TEST(SwitchedJumpBasedTest, TheGainIsThatOfTheModeLeftAndOfTheTimeInIt) {
  PlantDescription plant = oscillators({kAtJumps, kAtJumps});
  plant.modes[1].outputs[1] = output(0.0, 2.0);
  Eigen::MatrixXd A_d(2, 2);
  A_d << 0.0, 1.0, 3.0, 0.0;
  plant.modes[1].jump = std::make_shared<const AffineMap>(A_d, Eigen::MatrixXd(2, 0), kRest);
  SwitchedGains gains;
  gains.L_d = {{formulas({"1", "0"}), formulas({"0", "0"})},
               {formulas({"tau", "tau^2"}), formulas({"exp(tau)", "-1"})}};
  ModalBody body(std::make_shared<const SwitchedObserver>(context(plant), gains));
  body.flow(0.3);
  body.take(EventKind::kJump, 0, {7.0, 7.0}, 2.0);
  EXPECT_NEAR(7.0, body.x()(0), 1e-14);
  body.flow(0.5);
  const Eigen::Vector2d x = body.x();
  body.take(EventKind::kJump, 0, {4.0, 5.0}, 1.0);
  const double first = 4.0 - x(0);
  const double second = 5.0 - 2.0 * x(1);
  const Eigen::Vector2d expected = A_d * x + kRest + Eigen::Vector2d(0.5, 0.25) * first +
                                   Eigen::Vector2d(std::exp(0.5), -1.0) * second;
  EXPECT_LT((expected - body.x()).norm(), 1e-13);
}

TEST(SwitchedJumpBasedTest, OutputsAsSamplesOfEqualStampCountAsThoseInTheEvent) {
  SwitchedGains gains;
  gains.L_d = {{formulas({"tau", "1"}), formulas({"0", "tau"})},
               {formulas({"1", "1"}), formulas({"1", "1"})}};
  const auto law =
      std::make_shared<const SwitchedObserver>(context(oscillators({kAtJumps, kAtJumps})), gains);
  ModalBody together(law);
  ModalBody apart(law);
  ModalBody half(law);
  for (ModalBody* body : {&together, &apart, &half}) body->flow(0.4);
  together.take(EventKind::kJump, 0, {0.3, -0.6}, 2.0);
  apart.take(EventKind::kJump, 0, {}, 2.0);
  half.take(EventKind::kJump, 0, {}, 2.0);
  apart.take(EventKind::kJumpOutput, 0, {0.3});
  half.take(EventKind::kJumpOutput, 0, {0.3});
  apart.take(EventKind::kJumpOutput, 1, {-0.6});
  EXPECT_EQ(together.x(), apart.x());
  EXPECT_NE(together.x(), half.x());
}

class SwitchedProjectionTest : public ::testing::TestWithParam<bool> {
 protected:
  static Eigen::MatrixXd metric() {
    Eigen::MatrixXd P(2, 2);
    P << 2.0, -0.7, -0.7, 1.0;
    return P;
  }
};

TEST_P(SwitchedProjectionTest, MeetsTheOutputAndDoesNotIncreaseTheMetric) {
  const bool at_jumps = GetParam();
  PlantDescription plant = oscillators({at_jumps ? kAtJumps : kContinuous});
  plant.modes[0].outputs[0] = output(0.6, -1.7);
  SwitchedGains gains;
  gains.P = {metric(), std::nullopt};
  ModalBody body(std::make_shared<const SwitchedObserver>(context(plant), gains));
  const Eigen::RowVector2d H(0.6, -1.7);
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> value(-5.0, 5.0);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Vector2d truth(value(generator), value(generator));
    const double y = H * truth;
    body.flow(0.37);
    const Eigen::Vector2d before = truth - body.x();
    if (!at_jumps) body.take(EventKind::kOutput, 0, {y});
    if (at_jumps) {
      body.take(EventKind::kJump, 0, {y}, 2.0);
    } else {
      body.take(EventKind::kJump, 0, {}, 2.0);
    }
    const Eigen::Vector2d after = truth - body.x();
    EXPECT_NEAR(0.0, H * after, 1e-12);
    const double V_before = before.dot(metric() * before);
    const double V_after = after.dot(metric() * after);
    EXPECT_LE(V_after, V_before * (1.0 + 1e-12));
    // An oblique projection: what it takes away is orthogonal to what stays.
    const Eigen::Vector2d taken = before - after;
    EXPECT_NEAR(V_before, V_after + taken.dot(metric() * taken), 1e-11 * V_before);
    // Mode 2 has no metric.
    const Eigen::Vector2d x = body.x();
    body.take(EventKind::kJump, 0, {}, 1.0);
    EXPECT_EQ(x, body.x());
  }
}

INSTANTIATE_TEST_SUITE_P(OutputsAtJumpsOrContinuous, SwitchedProjectionTest, ::testing::Bool());

TEST(SwitchedObserverTest, ASwitchWithoutTheOutputAtJumpsProjectsOnNoOther) {
  for (const bool at_jumps : {true, false}) {
    PlantDescription plant =
        at_jumps ? oscillators({kContinuous, kAtJumps}) : oscillators({kContinuous});
    SwitchedGains gains;
    gains.P = {Eigen::MatrixXd(Eigen::Matrix2d::Identity()), std::nullopt};
    ModalBody body(std::make_shared<const SwitchedObserver>(context(plant), gains));
    body.take(EventKind::kOutput, 0, {3.0});
    const Eigen::Vector2d before = body.x();
    body.take(EventKind::kJump, 0, {}, 2.0);
    EXPECT_EQ(before == body.x(), at_jumps);
  }
}

std::shared_ptr<const SwitchedObserver> everything() {
  SwitchedGains gains;
  gains.L_c = {{gain(2.0, 0.5), {}}, {gain(3.0, -1.0), {}}};
  gains.L_d = {{nullptr, formulas({"0", "0.1*sin(tau)"})}, {nullptr, formulas({"0.2", "0"})}};
  gains.P = {Eigen::MatrixXd(Eigen::Matrix2d::Identity()), std::nullopt};
  return std::make_shared<const SwitchedObserver>(context(oscillators({kContinuous, kAtJumps})),
                                                  gains);
}

Estimator::Options options_of_modes() {
  Estimator::Options result;
  result.history = {10 * kNanosecondsPerSecond, 1000};
  result.sampling = {1, 1};
  return result;
}

TEST(SwitchedObserverTest, AnUnknownModeIsRejected) {
  Estimator estimator(everything(), options_of_modes());
  const auto jump = [&](Stamp stamp, double label) {
    return estimator.submit({stamp, EventKind::kJump, 0, nullptr, 0, 0, label}, stamp).outcome;
  };
  EXPECT_EQ(EventOutcome::kUsed, jump(kStart, 2.0));
  EXPECT_EQ(EventOutcome::kUnknownMode, jump(kStart + 1, 3.0));
  EXPECT_EQ(EventOutcome::kUnknownMode, jump(kStart + 1, 1.5));
  EXPECT_EQ(EventOutcome::kUsed, jump(kStart + 1, 1.0));
}

TEST(SwitchedObserverTest, TheEstimateDependsOnEventsNotOnTheirArrival) {
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> value(-2.0, 2.0);
  std::vector<OwnedEvent> events;
  for (int i = 0; i < 80; ++i) {
    const Stamp stamp = kStart + i * 7654321;
    events.push_back({stamp, EventKind::kOutput, 0, {value(generator)}});
    const double label = i % 3 == 0 ? 2.0 : 1.0;
    if (i % 4 == 0) {
      events.push_back({stamp, EventKind::kJump, 0, {value(generator)}, label});
    } else if (i % 4 == 1) {
      events.push_back({stamp, EventKind::kJump, 0, {}, label});
      events.push_back({stamp, EventKind::kJumpOutput, 1, {value(generator)}});
    }
  }
  const Stamp end = kStart + kNanosecondsPerSecond;
  Eigen::VectorXd first;
  for (int order = 0; order < 6; ++order) {
    Estimator estimator(everything(), options_of_modes());
    Estimate estimate = estimator.make_estimate();
    const std::size_t before = test::allocations();
    for (const OwnedEvent& event : events) {
      EXPECT_TRUE(estimator.submit(event.view(), end).used());
      estimator.estimate_at(event.stamp, estimate);
    }
    estimator.estimate_at(end, estimate);
    if (test::allocations_are_counted()) {
      EXPECT_EQ(before, test::allocations());
    }
    if (order == 0) first = estimate.state;
    EXPECT_EQ(first, estimate.state);
    std::shuffle(events.begin(), events.end(), generator);
  }
  EXPECT_GT(first.head(2).norm(), 1e-3);
}

struct BadGains {
  const char* part;
  std::vector<SensorTiming> timings;
  SwitchedGains gains;
};

TEST(SwitchedObserverTest, RefusesGainsThatDoNotFit) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(2, 2);
  Eigen::MatrixXd skew = one;
  skew(0, 1) = 0.5;
  const std::vector<std::shared_ptr<const VectorMap>> map = {formulas({"1", "tau"})};
  const std::vector<std::shared_ptr<const VectorMap>> short_map = {formulas({"1"})};
  const std::vector<BadGains> all = {
      {"at least one of", {kContinuous}, {}},
      {"one gain per mode", {kContinuous}, {{{gain(1, 1)}}, {}, {}, {}}},
      {"L_c of sensor 's0'", {kContinuous}, {{{gain(1, 1)}, {one}}, {}, {}, {}}},
      {"L_c needs", {kAtJumps}, {{{gain(1, 1)}, {gain(1, 1)}}, {}, {}, {}}},
      {"L_d needs", {kContinuous}, {{}, {map, map}, {}, {}}},
      {"L_d of sensor 's0'", {kAtJumps}, {{}, {map, short_map}, {}, {}}},
      {"need L_c or projection",
       {kContinuous, kAtJumps},
       {{}, {{nullptr, map[0]}, {nullptr, map[0]}}, {}, {}}},
      {"need L_d, metric or projection",
       {kAtJumps, kContinuous},
       {{{{}, gain(1, 1)}, {{}, gain(1, 1)}}, {}, {}, {}}},
      {"of mode 1: the metric must be symmetric", {kContinuous}, {{}, {}, {}, {skew, one}}},
      {"of mode 2: the metric must be symmetric", {kContinuous}, {{}, {}, {}, {one, -one}}},
      {"one row and one column per state", {kContinuous}, {{}, {}, {}, {gain(1, 1), one}}},
      {"the outputs of the mode are dependent",
       {kContinuous, kContinuous},
       {{}, {}, {}, {one, one}}},
      {"takes no sensor", {SensorTiming::kSampled}, {{}, {}, {}, {one, one}}},
  };
  for (const BadGains& bad : all) {
    try {
      SwitchedObserver(context(oscillators(bad.timings)), bad.gains);
      ADD_FAILURE() << bad.part;
    } catch (const std::invalid_argument& fault) {
      EXPECT_NE(std::string::npos, std::string(fault.what()).find(bad.part)) << fault.what();
    }
  }
}

TEST(SwitchedObserverTest, ProjectsOnlyWhereTheJumpMapIsTheIdentity) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(2, 2);
  PlantDescription plant = oscillators({kContinuous});
  plant.modes[0].jump = std::make_shared<const AffineMap>(one);
  plant.modes[1].jump = std::make_shared<const AffineMap>(2.0 * one);
  SwitchedGains gains;
  gains.P = {one, std::nullopt};
  EXPECT_NO_THROW(SwitchedObserver(context(plant), gains));
  gains.P = {one, one};
  EXPECT_THROW(SwitchedObserver(context(plant), gains), std::invalid_argument);
}

TEST(SwitchedObserverTest, RefusesAPlantOfOneMode) {
  PlantDescription plant = oscillators({kContinuous});
  plant.modes.pop_back();
  SwitchedGains gains;
  gains.L_c = {{gain(1.0, 1.0)}};
  EXPECT_THROW(SwitchedObserver(context(plant), gains), std::invalid_argument);
}

}  // namespace
}  // namespace sampled_data_observers
