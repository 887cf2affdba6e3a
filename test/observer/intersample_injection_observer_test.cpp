#include "observer/intersample_injection_observer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "observer/sample_and_hold_observer.h"
#include "plant/linear_plant.h"
#include "plant/lipschitz_map.h"
#include "sampled_data_observers/plant/expression_map.h"
#include "support/law_runner.h"

namespace sampled_data_observers {
namespace {

using test::LawRunner;

/// The oscillator of ferrante2019, example 1, with an input.
std::shared_ptr<const Plant> oscillator() {
  LinearPlantDescription plant;
  plant.state_names = {"z1", "z2"};
  plant.input_names = {"u"};
  plant.A.resize(2, 2);
  plant.A << 0.0, 1.0, -4.0, 0.0;
  plant.B = Eigen::Vector2d(0.0, 1.0);
  plant.sensors = {{"y", Eigen::RowVector2d(1.0, 0.0), {false}}};
  return make_linear_plant(plant);
}

/// The same with −sin of the position.
std::shared_ptr<const Plant> nonlinear_oscillator() {
  PlantDescription plant;
  plant.state_names = {"z1", "z2"};
  plant.input_names = {"u"};
  plant.sensors = {{"y", SensorTiming::kSampled, {false}}};
  LipschitzDescription flow;
  flow.A = oscillator()->modes()[0].flow->affine()->M();
  flow.B = Eigen::Vector2d(0.0, 1.0);
  flow.G = Eigen::Vector2d(0.0, -1.0);
  flow.S = Eigen::RowVector2d(1.0, 0.0);
  flow.psi = std::make_shared<const ExpressionMap>(ExpressionNames{{"v1"}, {}, {}},
                                                   std::vector<NamedExpression>{},
                                                   std::vector<NamedExpression>{{"1", "sin(v1)"}});
  PlantMode mode;
  mode.flow = std::make_shared<const LipschitzMap>(flow);
  mode.outputs = {std::make_shared<const AffineMap>(Eigen::RowVector2d(1.0, 0.0))};
  plant.modes = {mode};
  return std::make_shared<const Plant>(plant);
}

ObserverContext context(const std::shared_ptr<const Plant>& plant) {
  return {plant, Eigen::Vector2d(0.4, -0.7), Eigen::VectorXd::Zero(1)};
}

std::vector<IntersampleGains> gains(const Eigen::Vector2d& L, double H, double theta0 = 0.0) {
  return {{L, Eigen::MatrixXd::Constant(1, 1, H), Eigen::VectorXd::Constant(1, theta0)}};
}

/// Samples and inputs at random times, the same for several runners.
template <class EachStep>
void drive(std::vector<LawRunner*> runners, EachStep each_step) {
  std::mt19937_64 generator(4);
  std::uniform_int_distribution<Duration> interval(1, kNanosecondsPerSecond / 3);
  std::uniform_real_distribution<double> value(-2.0, 2.0);
  for (int i = 0; i < 60; ++i) {
    const Duration duration = interval(generator);
    const double y = value(generator);
    const double u = value(generator);
    for (LawRunner* runner : runners) {
      runner->flow(duration);
      if (i % 3 == 0) runner->input({u});
      runner->sample(0, {y});
    }
    each_step(duration, y, u, i % 3 == 0);
  }
}

TEST(IntersampleInjectionTest, FlowsByThePlantAndTheInjection) {
  const Eigen::Vector2d L(2.067, -3.0);
  LawRunner runner(std::make_shared<const IntersampleInjectionObserver>(context(oscillator()),
                                                                        gains(L, -1.384)));
  runner.input({0.5});
  runner.sample(0, {1.5});  // theta = 1.5 - 0.4
  EXPECT_DOUBLE_EQ(1.1, runner.state()(2));
  runner.flow(kNanosecondsPerSecond / 4);
  // RK4 with tiny steps, from the equations.
  Eigen::Vector3d s(0.4, -0.7, 1.1);
  const auto f = [&](const Eigen::Vector3d& at) -> Eigen::Vector3d {
    return {at(1) + L(0) * at(2), -4.0 * at(0) + 0.5 + L(1) * at(2), -1.384 * at(2)};
  };
  const double h = 1e-4;
  for (int i = 0; i < 2500; ++i) {
    const Eigen::Vector3d k1 = f(s);
    const Eigen::Vector3d k2 = f(s + h / 2 * k1);
    const Eigen::Vector3d k3 = f(s + h / 2 * k2);
    s += h / 6 * (k1 + 2 * k2 + 2 * k3 + f(s + h * k3));
  }
  EXPECT_LT((s - runner.state().head(3)).norm(), 1e-12);
}

TEST(IntersampleInjectionTest, ThetaStartsWhereItIsToldAndASampleReplacesIt) {
  LawRunner runner(std::make_shared<const IntersampleInjectionObserver>(
      context(oscillator()), gains({1.0, 0.0}, 0.0, 5.0)));
  EXPECT_EQ(5.0, runner.state()(2));
  const Eigen::VectorXd before = runner.estimate();
  runner.sample(0, {0.4});
  EXPECT_EQ(0.0, runner.state()(2));
  EXPECT_EQ(before, runner.estimate());
}

TEST(IntersampleInjectionTest, ThePredictorIsTheObserverThatPredictsTheOutput) {
  // In the coordinates (x, w = theta + C x): x' = A x + B u + L (w - C x), w' = C (A x + B u),
  // w+ = y.
  const Eigen::Vector2d L(0.3648, -0.4655);
  const auto plant = oscillator();
  LawRunner runner(std::make_shared<const IntersampleInjectionObserver>(
      context(plant), gains(L, predictor_H(*plant, 0, L)(0, 0))));
  Eigen::Matrix3d A;
  A << -L(0), 1.0, L(0), -4.0 - L(1), 0.0, L(1), 0.0, 1.0, 0.0;
  const LinearFlow predicted(A, Eigen::Vector3d(0.0, 1.0, 0.0));
  Eigen::Vector3d s(0.4, -0.7, 0.4);
  Eigen::Vector3d scratch;
  double u_held = 0.0;
  drive({&runner}, [&](Duration duration, double y, double u, bool is_input) {
    predicted.apply(duration, s.data(), &u_held, scratch.data());
    if (is_input) u_held = u;
    s(2) = y;
    EXPECT_LT((s.head(2) - runner.estimate()).norm(), 1e-11);
  });
}

TEST(IntersampleInjectionTest, ThePredictorOfANonlinearPlantPredictsTheOutputToo) {
  const Eigen::Vector2d L(0.8, 0.3);
  const auto plant = nonlinear_oscillator();
  LawRunner runner(std::make_shared<const IntersampleInjectionObserver>(
      context(plant), gains(L, predictor_H(*plant, 0, L)(0, 0))));

  class Predicted : public VectorField {
   public:
    Predicted(const Plant& plant, const Eigen::Vector2d& L, const double& u)
        : plant_(plant), L_(L), u_(u) {}
    void evaluate(const double* s, double* ds) const override {
      plant_.modes()[0].flow->evaluate(s, &u_, ds);
      ds[2] = ds[0];  // C f
      const double innovation = s[2] - s[0];
      ds[0] += L_(0) * innovation;
      ds[1] += L_(1) * innovation;
    }

   private:
    const Plant& plant_;
    Eigen::Vector2d L_;
    const double& u_;
  };
  double u_held = 0.0;
  const Predicted field(*plant, L, u_held);
  const RungeKuttaFlow predicted(3, kNanosecondsPerSecond / 1000);
  Eigen::Vector3d s(0.4, -0.7, 0.4);
  drive({&runner}, [&](Duration duration, double y, double u, bool is_input) {
    predicted.apply(field, duration, s.data());
    if (is_input) u_held = u;
    s(2) = y;
    EXPECT_LT((s.head(2) - runner.estimate()).norm(), 1e-9);
  });
}

TEST(SampleAndHoldTest, IsTheIntersampleInjectionWithHZeroAndTheOtherSign) {
  for (const auto& plant : {oscillator(), nonlinear_oscillator()}) {
    LawRunner held(std::make_shared<const SampleAndHoldObserver>(
        context(plant), std::vector<Eigen::MatrixXd>{Eigen::Vector2d(-0.9, 0.2)}));
    LawRunner injected(std::make_shared<const IntersampleInjectionObserver>(
        context(plant), gains({0.9, -0.2}, 0.0)));
    drive({&held, &injected},
          [&](Duration, double, double, bool) { EXPECT_EQ(injected.estimate(), held.estimate()); });
  }
}

TEST(SampleAndHoldTest, InjectsEstimateMinusMeasurement) {
  // x' = 0 and L = -1: from the sample on x' = -(x(t_k) - y), so after 1 s x = y.
  LinearPlantDescription plant;
  plant.state_names = {"x"};
  plant.A = Eigen::MatrixXd::Zero(1, 1);
  plant.B = Eigen::MatrixXd::Zero(1, 0);
  plant.sensors = {{"s", Eigen::MatrixXd::Ones(1, 1), {false}}};
  LawRunner runner(std::make_shared<const SampleAndHoldObserver>(
      ObserverContext{make_linear_plant(plant), Eigen::VectorXd::Constant(1, 3.0),
                      Eigen::VectorXd::Zero(0)},
      std::vector<Eigen::MatrixXd>{Eigen::MatrixXd::Constant(1, 1, -1.0)}));
  runner.sample(0, {7.0});
  runner.flow(kNanosecondsPerSecond / 2);
  EXPECT_NEAR(5.0, runner.estimate()(0), 1e-14);
  runner.flow(kNanosecondsPerSecond / 2);
  EXPECT_NEAR(7.0, runner.estimate()(0), 1e-14);
}

TEST(IntersampleInjectionTest, RefusesGainsThatDoNotFit) {
  const ObserverContext good = context(oscillator());
  std::vector<IntersampleGains> fitting = gains({1.0, 1.0}, 0.0);
  EXPECT_NO_THROW(IntersampleInjectionObserver(good, fitting));
  fitting[0].H = Eigen::MatrixXd::Zero(2, 2);
  EXPECT_THROW(IntersampleInjectionObserver(good, fitting), std::invalid_argument);
  fitting = gains({1.0, 1.0}, 0.0);
  fitting[0].initial_theta.resize(2);
  EXPECT_THROW(IntersampleInjectionObserver(good, fitting), std::invalid_argument);
  EXPECT_THROW(IntersampleInjectionObserver(good, {}), std::invalid_argument);
}

}  // namespace
}  // namespace sampled_data_observers
