// The hybrid Kalman filter on a switched plant, in limiting cases, and what it refuses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "observer/hybrid_kalman_filter.h"
#include "sampled_data_observers/hybrid/timeline.h"
#include "support/matrix_functions.h"
#include "support/random_events.h"
#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

using test::kSecond;
using test::kStart;
using test::OwnedEvent;

Eigen::MatrixXd identity(Eigen::Index n) { return Eigen::MatrixXd::Identity(n, n); }
Eigen::MatrixXd zero(Eigen::Index n) { return Eigen::MatrixXd::Zero(n, n); }

Eigen::MatrixXd matrix(Eigen::Index rows, Eigen::Index cols, const std::vector<double>& values) {
  Eigen::MatrixXd M(rows, cols);
  for (Eigen::Index i = 0; i < M.size(); ++i) {
    M(i / cols, i % cols) = values[static_cast<std::size_t>(i)];
  }
  return M;
}

std::shared_ptr<const VectorMap> linear(const Eigen::MatrixXd& M) {
  return std::make_shared<const AffineMap>(M);
}

std::shared_ptr<const VectorMap> affine(const Eigen::MatrixXd& M, const Eigen::MatrixXd& N,
                                        const Eigen::VectorXd& c) {
  return std::make_shared<const AffineMap>(M, N, c);
}

/// A law with a state of its own, driven by hand.
class FilterRun {
 public:
  explicit FilterRun(const HybridKalmanFilter& law)
      : law_(law), state_(law.state_size()), workspace_(law.workspace_size()) {
    law_.initialize(state_.data());
  }
  Eigen::VectorXd x() const { return state_.head(law_.estimate_size()); }
  Eigen::MatrixXd P() const {
    const Eigen::Index n = law_.estimate_size();
    return Eigen::Map<const Eigen::MatrixXd>(law_.covariance(state_.data()), n, n);
  }
  void flow(Duration duration) { law_.flow(duration, state_.data(), workspace_.data()); }
  void reset(EventKind kind, int sensor, const std::vector<double>& values,
             std::optional<double> mode = std::nullopt) {
    const OwnedEvent event{1, kind, sensor, values, mode};
    law_.reset(event.view(), state_.data(), workspace_.data());
  }

 private:
  const HybridKalmanFilter& law_;
  Eigen::VectorXd state_;
  Eigen::VectorXd workspace_;
};

/// A switched plant with everything the filter takes: an input, constants, two modes of which one
/// has no jump map, a sampled sensor of two outputs, and two sensors at jumps.
PlantDescription example_plant() {
  PlantDescription plant;
  plant.state_names = {"a", "b", "c"};
  plant.input_names = {"u"};
  plant.sensors = {{"early", SensorTiming::kAtJumps, {false}},
                   {"late", SensorTiming::kAtJumps, {false, false}},
                   {"samples", SensorTiming::kSampled, {false, false}}};
  const Eigen::MatrixXd early = matrix(1, 3, {1.0, 0.0, 0.5});
  const Eigen::MatrixXd late = matrix(2, 3, {0.0, 1.0, 0.0, 1.0, 0.0, -1.0});
  PlantMode one;
  one.label = 1;
  one.flow = affine(matrix(3, 3, {0.0, 1.0, 0.0, -3.0, -0.2, 0.1, 0.0, 0.3, -0.1}),
                    matrix(3, 1, {0.0, 1.0, 0.2}), Eigen::Vector3d(0.0, -0.4, 0.0));
  one.jump = affine(matrix(3, 3, {1.0, 0.0, 0.0, 0.2, -0.8, 0.0, 0.0, 0.0, 0.9}),
                    Eigen::MatrixXd::Zero(3, 0), Eigen::Vector3d(0.0, 0.1, 0.2));
  one.outputs = {linear(early), linear(late), linear(matrix(2, 3, {1.0, 0.0, 0.0, 0.0, 0.5, 1.0}))};
  PlantMode two = one;
  two.label = 2;
  two.flow = affine(matrix(3, 3, {-0.1, 1.0, 0.0, 0.0, -0.3, 0.5, 0.0, -0.5, -0.3}),
                    matrix(3, 1, {0.1, 0.0, 1.0}), Eigen::Vector3d(0.1, 0.0, 0.0));
  two.jump = nullptr;
  two.outputs = {linear(early), linear(late), linear(matrix(2, 3, {0.0, 1.0, 0.0, 1.0, 0.0, 1.0}))};
  plant.modes = {one, two};
  return plant;
}

KalmanCovariances three_state_covariances() {
  KalmanCovariances result;
  result.P0 = matrix(3, 3, {1.0, 0.2, 0.0, 0.2, 2.0, -0.3, 0.0, -0.3, 0.5});
  result.R = {matrix(1, 1, {0.1}), matrix(2, 2, {0.2, 0.1, 0.1, 0.3}),
              matrix(2, 2, {0.05, -0.02, -0.02, 0.4})};
  result.Q = matrix(3, 3, {0.1, 0.0, 0.0, 0.0, 0.3, 0.1, 0.0, 0.1, 0.2});
  result.Q_d = matrix(3, 3, {0.0, 0.0, 0.0, 0.0, 0.2, 0.0, 0.0, 0.0, 0.1});
  return result;
}

ObserverContext context_of(const PlantDescription& plant) {
  const auto n = static_cast<Eigen::Index>(plant.state_names.size());
  const auto p = static_cast<Eigen::Index>(plant.input_names.size());
  return {std::make_shared<const Plant>(plant), Eigen::VectorXd::LinSpaced(n, 0.5, -0.5),
          Eigen::VectorXd::Constant(p, 0.3)};
}

std::shared_ptr<const HybridKalmanFilter> example_law() {
  return std::make_shared<const HybridKalmanFilter>(context_of(example_plant()),
                                                    three_state_covariances());
}

/// The discrete Kalman filter of the textbooks, over durations by Van Loan's block exponential.
struct TextbookFilter {
  Eigen::VectorXd x;
  Eigen::MatrixXd P;

  void flow(const VectorMap& map, const Eigen::MatrixXd& Q, const Eigen::VectorXd& u, double t) {
    const AffineMap& f = *map.affine();
    const Eigen::Index n = x.size();
    Eigen::MatrixXd whole = zero(n + 1);
    whole.topLeftCorner(n, n) = f.M();
    whole.topRightCorner(n, 1) = f.N() * u + f.c();
    const Eigen::MatrixXd transition = test::exponential(whole * t);
    const Eigen::MatrixXd Phi = transition.topLeftCorner(n, n);
    x = (Phi * x + transition.topRightCorner(n, 1)).eval();
    Eigen::MatrixXd block = zero(2 * n);
    block.topLeftCorner(n, n) = -f.M();
    block.topRightCorner(n, n) = Q;
    block.bottomRightCorner(n, n) = f.M().transpose();
    const Eigen::MatrixXd exponential = test::exponential(block * t);
    P = (Phi * P * Phi.transpose() + Phi * exponential.topRightCorner(n, n)).eval();
  }
  void correct(const VectorMap& map, const Eigen::MatrixXd& R, const Eigen::VectorXd& y) {
    const Eigen::MatrixXd& C = map.affine()->M();
    const Eigen::MatrixXd S = C * P * C.transpose() + R;
    const Eigen::MatrixXd K = P * C.transpose() * test::inverse(S);
    x += K * (y - C * x);
    P = (P - K * C * P).eval();
  }
  void jump(const VectorMap* map, const Eigen::MatrixXd& Q_d) {
    if (map == nullptr) {
      P += Q_d;
      return;
    }
    const AffineMap& g = *map->affine();
    x = (g.M() * x + g.c()).eval();
    P = (g.M() * P * g.M().transpose() + Q_d).eval();
  }
};

TEST(HybridKalmanCasesTest, ASwitchedPlantWithInputsHasTheTextbooksFilter) {
  const std::shared_ptr<const HybridKalmanFilter> law = example_law();
  const std::vector<PlantMode>& modes = law->plant().modes();
  const KalmanCovariances tuning = three_state_covariances();
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> value(-2.0, 2.0);
  std::uniform_int_distribution<Duration> duration(1, 2 * kSecond);
  std::uniform_int_distribution<int> choice(0, 3);
  FilterRun run(*law);
  TextbookFilter expected{run.x(), tuning.P0};
  Eigen::VectorXd u = Eigen::VectorXd::Constant(1, 0.3);
  std::size_t mode = 0;
  for (int i = 0; i < 300; ++i) {
    const Duration t = duration(generator);
    run.flow(t);
    expected.flow(*modes[mode].flow, tuning.Q, u, to_seconds(t));
    const std::vector<double> y = {value(generator), value(generator), value(generator)};
    switch (choice(generator)) {
      case 0:
        u(0) = y[0];
        run.reset(EventKind::kInput, 0, {y[0]});
        break;
      case 1: {
        const std::size_t next = y[0] < 0.0 ? 0 : 1;
        run.reset(EventKind::kJump, 0, {}, next == 0 ? 1.0 : 2.0);
        expected.jump(modes[mode].jump.get(), tuning.Q_d);
        mode = next;
        break;
      }
      case 2: {
        const std::size_t next = y[0] < 0.0 ? 0 : 1;
        run.reset(EventKind::kJump, 0, y, next == 0 ? 1.0 : 2.0);
        expected.correct(*modes[mode].outputs[0], tuning.R[0], Eigen::VectorXd::Constant(1, y[0]));
        expected.correct(*modes[mode].outputs[1], tuning.R[1], Eigen::Vector2d(y[1], y[2]));
        expected.jump(modes[mode].jump.get(), tuning.Q_d);
        mode = next;
        break;
      }
      default:
        run.reset(EventKind::kSample, 2, {y[0], y[1]});
        expected.correct(*modes[mode].outputs[2], tuning.R[2], Eigen::Vector2d(y[0], y[1]));
    }
    ASSERT_LT((run.x() - expected.x).norm(), 1e-10) << "event " << i;
    ASSERT_LT((run.P() - expected.P).norm(), 1e-10 * (1.0 + expected.P.norm())) << "event " << i;
  }
}

/// bernard2022, example 5.5: neither the flow nor the jumps alone are detectable.
PlantDescription example_5_5() {
  PlantDescription plant;
  plant.state_names = {"x1", "x2", "x3"};
  plant.sensors = {{"d", SensorTiming::kAtJumps, {false}}};
  PlantMode mode;
  mode.flow = linear(matrix(3, 3, {0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}));
  mode.jump = linear(matrix(3, 3, {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0}));
  mode.outputs = {linear(matrix(1, 3, {1.0, 0.0, 0.0}))};
  plant.modes = {mode};
  return plant;
}

TEST(HybridKalmanCasesTest, WithoutNoiseOfTheProcessItIsTheLeastSquaresFit) {
  // Q = Q_d = 0: the estimate of (x1, x2) minimizes the squares of all residuals, and of the
  // start's.
  KalmanCovariances tuning;
  tuning.P0 = 4.0 * identity(3);
  tuning.R = {0.25 * identity(1)};
  tuning.Q = tuning.Q_d = zero(3);
  const ObserverContext start{std::make_shared<const Plant>(example_5_5()), Eigen::Vector3d::Zero(),
                              Eigen::VectorXd::Zero(0)};
  const HybridKalmanFilter law(start, tuning);
  FilterRun run(law);
  Eigen::Matrix2d information = Eigen::Matrix2d::Identity() / 4.0;
  Eigen::Vector2d weighted = Eigen::Vector2d::Zero();
  std::mt19937_64 generator(2);
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  double t = 0.0;
  for (int jump = 0; jump < 40; ++jump) {
    run.flow((jump % 2 == 0 ? 2 : 5) * kSecond);
    t += jump % 2 == 0 ? 2.0 : 5.0;
    const double y = value(generator);
    run.reset(EventKind::kJump, 0, {y});
    const Eigen::Vector2d row(1.0, t);
    information += row * row.transpose() / 0.25;
    weighted += row * y / 0.25;
    const Eigen::Vector2d fit = test::inverse(information) * weighted;
    EXPECT_NEAR(fit(1), run.x()(1), 1e-10);
    EXPECT_NEAR(fit(0) + fit(1) * t, run.x()(0), 1e-9);
    EXPECT_EQ(run.x()(0), run.x()(2));
  }
}

TEST(HybridKalmanCasesTest, TheInnovationOfAnAngleIsWrapped) {
  PlantDescription plant;
  plant.state_names = {"yaw"};
  plant.sensors = {{"s", SensorTiming::kSampled, {true}}};
  PlantMode mode;
  mode.flow = linear(zero(1));
  mode.outputs = {linear(identity(1))};
  plant.modes = {mode};
  const ObserverContext start{std::make_shared<const Plant>(plant),
                              Eigen::VectorXd::Constant(1, 3.0), Eigen::VectorXd::Zero(0)};
  const HybridKalmanFilter law(start, {identity(1), {identity(1)}, zero(1), zero(1)});
  FilterRun run(law);
  run.reset(EventKind::kSample, 0, {-3.0});
  const double innovation = 2.0 * 3.14159265358979323846 - 6.0;
  EXPECT_NEAR(3.0 + innovation / 2.0, run.x()(0), 1e-15);
  EXPECT_NEAR(0.5, run.P()(0, 0), 1e-15);
}

TEST(HybridKalmanCasesTest, AnExtremelyCertainSampleLeavesACovariance) {
  // C P Cᵀ + R of this sensor is singular to working precision.
  PlantDescription plant;
  plant.state_names = {"p"};
  plant.sensors = {{"s", SensorTiming::kSampled, {false, false}}};
  PlantMode mode;
  mode.flow = linear(zero(1));
  mode.outputs = {linear(Eigen::MatrixXd::Ones(2, 1))};
  plant.modes = {mode};
  const ObserverContext start{std::make_shared<const Plant>(plant), Eigen::VectorXd::Zero(1),
                              Eigen::VectorXd::Zero(0)};
  const HybridKalmanFilter law(start, {1e20 * identity(1), {identity(2)}, zero(1), zero(1)});
  FilterRun run(law);
  run.reset(EventKind::kSample, 0, {1.0, 2.0});
  EXPECT_NEAR(1.5, run.x()(0), 1e-12);
  EXPECT_NEAR(0.5, run.P()(0, 0), 1e-12);
}

class HybridKalmanTimelineTest : public ::testing::Test {
 protected:
  std::vector<double> states_after(const std::vector<OwnedEvent>& events) const {
    Timeline timeline(law_, {100 * kSecond, 200});
    for (const OwnedEvent& event : events) timeline.insert(event.view());
    std::vector<double> result;
    Eigen::VectorXd state(law_->state_size());
    EventCounts counts;
    for (Stamp stamp = kStart + 3 * kSecond; stamp < kStart + 6 * kSecond; stamp += kSecond / 3) {
      EXPECT_EQ(Timeline::Query::kOk, timeline.state_at(stamp, state, counts));
      const Eigen::Index n = law_->estimate_size();
      result.insert(result.end(), state.data(), state.data() + n + n * n);
    }
    return result;
  }

  std::shared_ptr<const HybridKalmanFilter> law_ = example_law();
};

TEST_F(HybridKalmanTimelineTest, OutputsOfAJumpGiveTheSameBitsHoweverTheyArrive) {
  const Stamp at = kStart + 2 * kSecond + 7;
  const std::vector<OwnedEvent> others = {
      {kStart, EventKind::kInput, 0, {0.4}},
      {kStart + kSecond, EventKind::kSample, 2, {0.2, -0.3}},
      {at, EventKind::kSample, 2, {0.1, 0.6}},
      {kStart + 4 * kSecond, EventKind::kJump, 0, {}, 1.0},
      {kStart + 5 * kSecond, EventKind::kSample, 2, {0.7, 0.1}}};
  const OwnedEvent measured{at, EventKind::kJump, 0, {0.3, -0.4, 0.9}, 2.0};
  const OwnedEvent plain{at, EventKind::kJump, 0, {}, 2.0};
  const OwnedEvent early{at, EventKind::kJumpOutput, 0, {0.3}};
  const OwnedEvent late{at, EventKind::kJumpOutput, 1, {-0.4, 0.9}};

  std::vector<OwnedEvent> events = others;
  events.push_back(measured);
  const std::vector<double> expected = states_after(events);

  events = others;
  events.push_back(plain);
  EXPECT_NE(expected, states_after(events));  // y_d does make a difference
  events.push_back(early);
  EXPECT_NE(expected, states_after(events));
  events.push_back(late);
  std::mt19937_64 generator(5);
  for (int permutation = 0; permutation < 200; ++permutation) {
    std::shuffle(events.begin(), events.end(), generator);
    EXPECT_EQ(expected, states_after(events));
  }
}

TEST(HybridKalmanFilterFaultTest, SaysWhichCovariancesItCantUse) {
  const auto fault = [](auto&& change) -> std::string {
    KalmanCovariances tuning = three_state_covariances();
    change(tuning);
    try {
      const HybridKalmanFilter law(context_of(example_plant()), tuning);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "no fault";
  };
  using C = KalmanCovariances;
  EXPECT_EQ("no fault", fault([](C&) {}));
  EXPECT_EQ("no fault", fault([](C& c) { c.Q = c.Q_d = zero(3); }));
  EXPECT_EQ("P0 must be positive definite", fault([](C& c) { c.P0 = zero(3); }));
  EXPECT_EQ("P0 must be 3 x 3", fault([](C& c) { c.P0 = identity(2); }));
  EXPECT_EQ("P0 must be symmetric; entries (3, 1) and (1, 3) differ",
            fault([](C& c) { c.P0(0, 2) = 0.1; }));
  EXPECT_EQ("P0 must be finite", fault([](C& c) { c.P0(0, 0) = std::nan(""); }));
  EXPECT_EQ("R: one matrix per sensor", fault([](C& c) { c.R.pop_back(); }));
  EXPECT_EQ("R of sensor 'late' must be 2 x 2", fault([](C& c) { c.R[1] = identity(3); }));
  EXPECT_EQ("R of sensor 'samples' must be positive definite",
            fault([](C& c) { c.R[2] = Eigen::MatrixXd::Ones(2, 2); }));
  EXPECT_EQ("Q must be positive semidefinite", fault([](C& c) { c.Q(0, 0) = -0.01; }));
  EXPECT_EQ("Q must be positive semidefinite", fault([](C& c) { c.Q(0, 1) = c.Q(1, 0) = 1.0; }));
  EXPECT_EQ("Q_d must be positive semidefinite",
            fault([](C& c) { c.Q_d(0, 1) = c.Q_d(1, 0) = 1e-6; }));
}

TEST(HybridKalmanFilterFaultTest, SaysWhichPlantsItCantTake) {
  class Square : public VectorMap {
   public:
    Eigen::Index size() const override { return 1; }
    void evaluate(const double* x, const double*, double* out) const override {
      out[0] = x[0] * x[0];
    }
  };
  const auto fault = [](auto&& change) -> std::string {
    PlantDescription plant;
    plant.state_names = {"x"};
    plant.sensors = {{"s", SensorTiming::kSampled, {false}}};
    PlantMode mode;
    mode.flow = mode.jump = linear(identity(1));
    mode.outputs = {mode.flow};
    plant.modes = {mode};
    change(plant);
    try {
      const HybridKalmanFilter law(context_of(plant),
                                   {identity(1), {identity(1)}, zero(1), zero(1)});
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "no fault";
  };
  using D = PlantDescription;
  EXPECT_EQ("no fault", fault([](D&) {}));
  EXPECT_NE(std::string::npos, fault([](D& p) {
                                 p.sensors[0].timing = SensorTiming::kContinuous;
                               }).find("continuous"));
}

}  // namespace
}  // namespace sampled_data_observers
