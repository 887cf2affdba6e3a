#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "linear_algebra/ordered_solve.h"
#include "observer/linear_high_gain_observer.h"
#include "observer/observable_form.h"
#include "observer/original_high_gain_observer.h"
#include "observer/transformed_high_gain_observer.h"
#include "sampled_data_observers/plant/expression_map.h"
#include "sampled_data_observers/runtime/estimator.h"
#include "support/allocation_counter.h"
#include "support/random_events.h"
#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

using test::kStart;
using test::OwnedEvent;

/// Position and velocity with a measured position, which bounces: x⁺ = (x1, −2 x2).
std::shared_ptr<const Plant> cart(bool angular) {
  PlantDescription plant;
  plant.state_names = {"p", "v"};
  plant.sensors = {{"position", SensorTiming::kContinuous, {angular}}};
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2, 2);
  A(0, 1) = 1.0;
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(1, 2);
  C(0, 0) = 1.0;
  Eigen::MatrixXd A_d = Eigen::MatrixXd::Identity(2, 2);
  A_d(1, 1) = -2.0;
  PlantMode mode;
  mode.flow = std::make_shared<const AffineMap>(A);
  mode.jump = std::make_shared<const AffineMap>(A_d);
  mode.outputs = {std::make_shared<const AffineMap>(C)};
  plant.modes = {mode};
  return std::make_shared<const Plant>(plant);
}

Saturation no_bounds() { return Saturation(2); }

/// Of a plant with one mode.
HighGainSettings settings(const Saturation& saturation, double ell,
                          const std::vector<Eigen::VectorXd>& K) {
  return {saturation, ell, {K}};
}

/// Eigenvalues −ℓ and −2 ℓ.
std::shared_ptr<const LinearHighGainObserver> cart_observer(
    double ell, const Saturation& saturation = no_bounds(), bool angular = false) {
  const ObserverContext context{cart(angular), Eigen::Vector2d(1.0, -2.0), Eigen::VectorXd(0)};
  return std::make_shared<const LinearHighGainObserver>(
      context, settings(saturation, ell, {Eigen::Vector2d(2.0, 3.0)}));
}

/// A law with its state.
struct Body {
  explicit Body(std::shared_ptr<const ObserverLaw> of)
      : law(std::move(of)), state(law->state_size()), workspace(law->workspace_size()) {
    law->initialize(state.data());
  }
  void take(EventKind kind, std::vector<double> values, int sensor = 0) {
    const OwnedEvent event{kStart, kind, sensor, std::move(values)};
    law->reset(event.view(), state.data(), workspace.data());
  }
  void flow(double seconds) { law->flow(from_seconds(seconds), state.data(), workspace.data()); }
  std::shared_ptr<const ObserverLaw> law;
  Eigen::VectorXd state;
  Eigen::VectorXd workspace;
};

TEST(LinearHighGainTest, TheErrorDecaysExactlyAsTheEigenvaluesSay) {
  // The plant rests at p = 3, so that holding y_c is exact. With L_c = (3 ℓ, 2 ℓ²) the error is
  // e1 = c1 e^{-ℓt} + c2 e^{-2ℓt}, e2 = 2ℓ c1 e^{-ℓt} + ℓ c2 e^{-2ℓt}.
  for (const double ell : {0.5, 3.0, 20.0}) {
    const auto law = cart_observer(ell);
    EXPECT_NEAR(3.0 * ell, law->L_c()[0][0](0, 0), 1e-12 * ell);
    EXPECT_NEAR(2.0 * ell * ell, law->L_c()[0][0](1, 0), 1e-12 * ell * ell);
    Body body(law);
    body.take(EventKind::kOutput, {3.0});
    const Eigen::Vector2d e(3.0 - 1.0, 0.0 + 2.0);
    const double c1 = e(1) / ell - e(0);
    const double c2 = e(0) - c1;
    double t = 0.0;
    for (const double step : {0.01, 0.123456789, 0.4, 1.0}) {
      body.flow(step);
      t += step;
      const double slow = c1 * std::exp(-ell * t);
      const double fast = c2 * std::exp(-2.0 * ell * t);
      EXPECT_NEAR(3.0 - slow - fast, body.state(0), 1e-13 * (1.0 + std::abs(c2)));
      EXPECT_NEAR(-2.0 * ell * slow - ell * fast, body.state(1),
                  1e-12 * ell * (1.0 + std::abs(c2)));
    }
  }
}

TEST(LinearHighGainTest, FlowsAsThePlantBeforeTheFirstOutput) {
  Body body(cart_observer(5.0));
  body.flow(0.5);
  EXPECT_NEAR(0.0, body.state(0), 1e-15);
  EXPECT_EQ(-2.0, body.state(1));
}

TEST(LinearHighGainTest, AJumpIsThePlantsWithinTheBounds) {
  Saturation bounds(2);
  bounds.bound(1, -3.0, 3.0);
  Body body(cart_observer(5.0, bounds));
  body.take(EventKind::kJump, {});
  EXPECT_EQ(1.0, body.state(0));
  EXPECT_EQ(3.0, body.state(1));
  EXPECT_TRUE(body.law->observer().is_saturated(body.state.data()));
  body.flow(1.0);  // the flow knows no bounds
  EXPECT_NEAR(4.0, body.state(0), 1e-15);
}

TEST(LinearHighGainTest, AnAngularOutputIsWrapped) {
  // The angle 3.0 + 2 pi is 3.0: the estimate must go there the short way.
  const double turn = 2.0 * 3.14159265358979323846;
  Body body(cart_observer(3.0, no_bounds(), true));
  body.take(EventKind::kOutput, {3.0 + turn});
  EXPECT_EQ(from_seconds(0.001), body.law->flow_step());
  for (int i = 0; i < 10; ++i) body.flow(1.0);
  EXPECT_NEAR(3.0, body.state(0), 1e-9);
}

TEST(LinearHighGainTest, SensorsCorrectTogether) {
  Eigen::Matrix3d A;
  A << -1.0, 0.4, 0.2, 0.0, 0.0, 1.0, 0.7, -2.0, -0.3;
  const Eigen::MatrixXd H = Eigen::MatrixXd::Identity(2, 3);
  PlantDescription plant;
  plant.state_names = {"x1", "x2", "x3"};
  plant.sensors = {{"a", SensorTiming::kContinuous, {false}},
                   {"b", SensorTiming::kContinuous, {false}}};
  PlantMode mode;
  mode.flow = std::make_shared<const AffineMap>(A);
  for (Eigen::Index i = 0; i < 2; ++i) {
    mode.outputs.push_back(std::make_shared<const AffineMap>(H.row(i)));
  }
  plant.modes = {mode};
  const Eigen::Vector3d x(1.0, -2.0, 0.5);
  const std::vector<Eigen::VectorXd> K = {Eigen::Vector2d(2.0, 3.0),
                                          Eigen::VectorXd::Constant(1, 1.5)};
  const auto law = std::make_shared<const LinearHighGainObserver>(
      ObserverContext{std::make_shared<const Plant>(plant), x, Eigen::VectorXd(0)},
      settings(Saturation(3), 4.0, K));

  Body body(law);
  Eigen::Vector3d slope;
  const auto expect_slope = [&](const Eigen::Vector3d& expected) {
    law->flow_derivative(body.state.data(), slope.data(), body.workspace.data());
    EXPECT_LT((slope - expected).norm(), 1e-12 * expected.norm());
  };
  const Eigen::Vector2d y(3.0, -1.0);
  body.take(EventKind::kOutput, {y(0)});
  expect_slope(A * x);
  body.take(EventKind::kOutput, {y(1)}, 1);
  const Eigen::MatrixXd L_c = high_gain(A, H, observable_form(A, H), 4.0, K);
  expect_slope(A * x + L_c * (y - H * x));
}

using Formulas = std::vector<std::shared_ptr<const VectorMap>>;

std::shared_ptr<const VectorMap> formulas(std::vector<std::string> names,
                                          const std::vector<std::string>& texts) {
  std::vector<NamedExpression> expressions;
  for (const std::string& text : texts) expressions.push_back({"formula", text});
  return std::make_shared<const ExpressionMap>(ExpressionNames{std::move(names), {}, {}},
                                               std::vector<NamedExpression>{}, expressions);
}

/// An oscillator: ẋ1 = x2 + 0.5 sin x1, ẋ2 = −x1 − 0.1 x2, y = x1; x2⁺ = −0.9 x2 at jumps.
/// T(x) = (x1, x2 + 0.5 sin x1) is invertible everywhere.
ObserverContext oscillator(const Eigen::Vector2d& start) {
  PlantDescription plant;
  plant.state_names = {"x1", "x2"};
  plant.sensors = {{"y", SensorTiming::kContinuous, {false}}};
  PlantMode mode;
  mode.flow = formulas({"x1", "x2"}, {"x2 + 0.5*sin(x1)", "-x1 - 0.1*x2"});
  mode.jump = formulas({"x1", "x2"}, {"x1", "-0.9*x2"});
  mode.outputs = {formulas({"x1", "x2"}, {"x1"})};
  plant.modes = {mode};
  return {std::make_shared<const Plant>(plant), start, Eigen::VectorXd(0)};
}

std::shared_ptr<const VectorMap> oscillator_T() {
  return formulas({"x1", "x2"}, {"x1", "x2 + 0.5*sin(x1)"});
}

TransformedHighGainObserver::Maps oscillator_maps() {
  return {oscillator_T(), formulas({"z1", "z2", "x1", "x2"}, {"-x1 - 0.1*x2 + 0.5*cos(x1)*z2"}),
          formulas({"z1", "z2"}, {"z1", "z2 - 0.5*sin(z1)"})};
}

const Eigen::Vector2d kK(2.0, 1.0);  // (s + 1)²

std::shared_ptr<const ObserverLaw> transformed(const Eigen::Vector2d& start,
                                               const Saturation& bounds = no_bounds()) {
  return std::make_shared<const TransformedHighGainObserver>(
      oscillator(start), settings(bounds, 5.0, {kK}),
      std::vector<TransformedHighGainObserver::Maps>{oscillator_maps()});
}

std::shared_ptr<const ObserverLaw> original(const Eigen::Vector2d& start,
                                            const Saturation& bounds = no_bounds(),
                                            double damping = 0.0) {
  return std::make_shared<const OriginalHighGainObserver>(
      oscillator(start), settings(bounds, 5.0, {kK}), Formulas{oscillator_T()}, damping);
}

TEST(NonlinearHighGainTest, BothFormsAreOneObserverWhereNothingSaturates) {
  const Eigen::Vector2d start(0.7, -1.2);
  Body in_z(transformed(start));
  Body in_x(original(start));
  for (int i = 0; i < 200; ++i) {
    for (Body* body : {&in_z, &in_x}) {
      if (i > 10) body->take(EventKind::kOutput, {std::sin(0.03 * i)});
      body->flow(0.0173);
      if (i % 60 == 59) body->take(EventKind::kJump, {});
    }
    ASSERT_LT((in_z.state.head(2) - in_x.state.head(2)).norm(), 1e-7) << i;
  }
  EXPECT_GT((in_z.state.head(2) - start).norm(), 0.1);
}

TEST(NonlinearHighGainTest, BothFormsConvergeThroughJumps) {
  // Copied jumps, y_c every millisecond: what the hold leaves is in proportion to ẏ times 1 ms.
  const auto bound = [](double low, double high) {
    Saturation result(2);
    result.bound(0, low, high);
    result.bound(1, low, high);
    return result;
  };
  const Eigen::Vector2d start(-1.5, 2.0);
  for (const auto& law :
       {transformed(start, bound(-3.0, 3.0)), original(start, bound(-3.0, 3.0))}) {
    Body body(law);
    Body plant(original(Eigen::Vector2d(1.0, 0.5)));  // without outputs it is the plant
    for (int i = 0; i < 8000; ++i) {
      body.take(EventKind::kOutput, {plant.state(0)});
      body.flow(0.001);
      plant.flow(0.001);
      if (i % 1700 == 1699) {
        body.take(EventKind::kJump, {});
        plant.take(EventKind::kJump, {});
      }
    }
    EXPECT_LT((body.state.head(2) - plant.state.head(2)).norm(), 0.02);
    EXPECT_GT(plant.state.head(2).norm(), 0.3);
  }
}

TEST(OriginalHighGainTest, StaysWithinTheBounds) {
  Saturation bounds(2);
  bounds.bound(0, -3.0, 3.0);
  bounds.bound(1, -0.25, 0.25);
  Body body(original(Eigen::Vector2d(0.0, 0.0), bounds));
  body.take(EventKind::kOutput, {10.0});
  body.flow(2.0);
  EXPECT_EQ(3.0, body.state(0));
  EXPECT_EQ(0.25, body.state(1));
}

TEST(OriginalHighGainTest, AFlowWithoutAValueIsNoStateAtTheBounds) {
  PlantDescription plant;
  plant.state_names = {"x1", "x2"};
  plant.sensors = {{"y", SensorTiming::kContinuous, {false}}};
  PlantMode mode;
  mode.flow = formulas({"x1", "x2"}, {"x2", "sqrt(x1 - 2)"});
  mode.outputs = {formulas({"x1", "x2"}, {"x1"})};
  plant.modes = {mode};
  Saturation bounds(2);
  for (int i = 0; i < 2; ++i) bounds.bound(i, -3.0, 3.0);
  const ObserverContext context{std::make_shared<const Plant>(plant), Eigen::Vector2d(2.0, -1.0),
                                Eigen::VectorXd(0)};
  Body body(std::make_shared<const OriginalHighGainObserver>(
      context, settings(bounds, 5.0, {kK}), Formulas{formulas({"x1", "x2"}, {"x1", "x2"})}, 0.01));
  body.flow(0.01);
  EXPECT_FALSE(body.state.head(2).allFinite());  // for which the timeline holds what was before
}

TEST(OriginalHighGainTest, DampingTakesItThroughSingularJacobians) {
  // y = x1, ẋ1 = x2²/2: ∂T/∂x = diag(1, x2) is singular at x2 = 0, where the estimate starts.
  PlantDescription plant;
  plant.state_names = {"x1", "x2"};
  plant.sensors = {{"y", SensorTiming::kContinuous, {false}}};
  PlantMode mode;
  mode.flow = formulas({"x1", "x2"}, {"0.5*x2^2", "1 - 0.2*x2"});
  mode.outputs = {formulas({"x1", "x2"}, {"x1"})};
  plant.modes = {mode};
  Saturation bounds(2);
  bounds.bound(1, -10.0, 10.0);
  const ObserverContext context{std::make_shared<const Plant>(plant), Eigen::Vector2d(0.0, 0.0),
                                Eigen::VectorXd(0)};
  const auto make = [&](double damping) {
    return std::make_shared<const OriginalHighGainObserver>(
        context, settings(bounds, 5.0, {kK}), Formulas{formulas({"x1", "x2"}, {"x1", "0.5*x2^2"})},
        damping);
  };
  EXPECT_THROW(make(0.0), std::invalid_argument);
  EXPECT_THROW(make(-1.0), std::invalid_argument);
  Body body(make(0.01));
  Body truth(make(0.01));  // without outputs it is the plant
  const Eigen::Vector2d x0(1.0, 2.0);
  truth.law->observer().start_from(x0.data(), truth.state.data());
  for (int i = 0; i < 4000; ++i) {
    body.take(EventKind::kOutput, {truth.state(0)});
    body.flow(0.001);
    truth.flow(0.001);
  }
  EXPECT_LT((body.state.head(2) - truth.state.head(2)).norm(), 0.02);
}

TEST(DampedInverseTest, MinimizesWhatItSays) {
  Eigen::Matrix3d J;
  J << 2.0, -1.0, 0.5, 3.0, 0.2, 1.0, 5.0, -0.8, 1.5;  // the third row is the sum of the others
  const Eigen::Vector3d r(1.0, -2.0, 4.0);
  const Eigen::Vector3d scales(0.5, 3.0, 1.0);
  const double ell = 2.0;
  const double delta = 0.1;
  const Eigen::Vector3d powers(1.0, 1.0 / ell, 1.0 / (ell * ell));
  const DampedInverse inverse(powers, {0}, scales, delta);
  Eigen::Matrix3d destroyed = J;
  Eigen::Vector3d c = r;
  Eigen::VectorXd workspace(inverse.workspace_size());
  inverse.apply(destroyed.data(), c.data(), workspace.data());
  const Eigen::Matrix3d scaled = powers.asDiagonal() * J * scales.asDiagonal();
  const Eigen::Vector3d step = c.cwiseQuotient(scales);
  // The gradient of what is minimized.
  const Eigen::Vector3d gradient = scaled.transpose() * (scaled * step - powers.cwiseProduct(r)) +
                                   delta * delta * scaled.row(0).squaredNorm() * step;
  EXPECT_LT(gradient.norm(), 1e-12);
  EXPECT_GT(step.norm(), 0.1);

  // Where all rows count the same, |ĵ_1| is still that of the output.
  const DampedInverse unscaled(Eigen::Vector3d::Ones(), {0}, scales, delta);
  destroyed = J;
  c = r;
  unscaled.apply(destroyed.data(), c.data(), workspace.data());
  const Eigen::Matrix3d in_units = J * scales.asDiagonal();
  const Eigen::Vector3d change = c.cwiseQuotient(scales);
  EXPECT_LT((in_units.transpose() * (in_units * change - r) +
             delta * delta * in_units.row(0).squaredNorm() * change)
                .norm(),
            1e-12);

  destroyed.fill(std::numeric_limits<double>::quiet_NaN());
  inverse.apply(destroyed.data(), c.data(), workspace.data());
  EXPECT_EQ(0.0, c.norm());
}

/// A plant that switches between two oscillators, of which the second shows 2 x1 + x2.
std::shared_ptr<const Plant> two_modes() {
  PlantDescription plant;
  plant.state_names = {"x1", "x2"};
  plant.sensors = {{"y", SensorTiming::kContinuous, {false}}};
  PlantMode first;
  first.label = 1;
  first.flow = formulas({"x1", "x2"}, {"x2", "-x1"});
  first.jump = formulas({"x1", "x2"}, {"x1 + 0.1", "x2"});
  first.outputs = {formulas({"x1", "x2"}, {"x1"})};
  PlantMode second;
  second.label = 2;
  second.flow = formulas({"x1", "x2"}, {"2*x2", "-x1"});
  second.outputs = {formulas({"x1", "x2"}, {"2*x1 + x2"})};
  plant.modes = {first, second};
  return std::make_shared<const Plant>(plant);
}

TEST(SwitchedHighGainTest, TheCoordinatesAreThoseOfTheModeThatFollows) {
  const ObserverContext context{two_modes(), Eigen::Vector2d(0.5, -1.0), Eigen::VectorXd(0)};
  const std::vector<std::string> z = {"z1", "z2"};
  const std::vector<std::string> z_and_x = {"z1", "z2", "x1", "x2"};
  const TransformedHighGainObserver::Maps first{
      formulas({"x1", "x2"}, {"x1", "x2"}), formulas(z_and_x, {"-x1"}), formulas(z, {"z1", "z2"})};
  // z = (2 x1 + x2, 4 x2 − x1), ż2 = −4 x1 − 2 x2
  const TransformedHighGainObserver::Maps second{formulas({"x1", "x2"}, {"2*x1 + x2", "4*x2 - x1"}),
                                                 formulas(z_and_x, {"-4*x1 - 2*x2"}),
                                                 formulas(z, {"(4*z1 - z2)/9", "(z1 + 2*z2)/9"})};
  const HighGainSettings both{no_bounds(), 5.0, {{kK}, {Eigen::Vector2d(3.0, 2.0)}}};
  const auto law = std::make_shared<const TransformedHighGainObserver>(
      context, both, std::vector<TransformedHighGainObserver::Maps>{first, second});
  Body body(law);
  const auto expect = [&body](double x1, double x2, double z1, double z2) {
    EXPECT_NEAR(x1, body.state(0), 1e-14);
    EXPECT_NEAR(x2, body.state(1), 1e-14);
    EXPECT_NEAR(z1, body.state(2), 1e-14);
    EXPECT_NEAR(z2, body.state(3), 1e-14);
  };
  expect(0.5, -1.0, 0.5, -1.0);
  OwnedEvent jump{kStart, EventKind::kJump, 0, {}};
  jump.mode = 2.0;
  law->reset(jump.view(), body.state.data(), body.workspace.data());
  expect(0.6, -1.0, 0.2, -4.6);  // T of mode 2 at g of mode 1: (51)
  law->keep_mode(0, body.state.data());
  expect(0.6, -1.0, 0.6, -1.0);
  law->keep_mode(1, body.state.data());
  expect(0.6, -1.0, 0.2, -4.6);

  HighGainSettings unequal = both;
  unequal.K[1] = {Eigen::Vector3d(3.0, 3.0, 1.0)};
  EXPECT_THROW(TransformedHighGainObserver(context, unequal, {first, second}),
               std::invalid_argument);
  EXPECT_THROW(TransformedHighGainObserver(context, both, {first}), std::invalid_argument);
}

TEST(SwitchedHighGainTest, TheLinearFormHasTheGainsOfEachMode) {
  PlantDescription plant;
  plant.state_names = {"p", "v"};
  plant.sensors = {{"y", SensorTiming::kContinuous, {false}}};
  std::vector<Eigen::MatrixXd> A;
  std::vector<Eigen::MatrixXd> C;
  for (int q = 0; q < 2; ++q) {
    A.emplace_back((Eigen::Matrix2d() << 0.0, 1.0, -q, -0.3 * q).finished());
    C.emplace_back((Eigen::RowVector2d() << 1.0, q).finished());
    PlantMode mode;
    mode.label = q + 1;
    mode.flow = std::make_shared<const AffineMap>(A.back());
    mode.outputs = {std::make_shared<const AffineMap>(C.back())};
    plant.modes.push_back(mode);
  }
  const ObserverContext context{std::make_shared<const Plant>(plant), Eigen::Vector2d(1.0, 1.0),
                                Eigen::VectorXd(0)};
  const HighGainSettings both{no_bounds(), 2.0, {{kK}, {Eigen::Vector2d(6.0, 5.0)}}};
  const LinearHighGainObserver law(context, both);
  for (std::size_t q = 0; q < 2; ++q) {
    // s² + k_2 ℓ s + k_1 ℓ²
    const Eigen::Matrix2d closed = A[q] - law.L_c()[q][0] * C[q];
    EXPECT_NEAR(-2.0 * both.K[q][0](1), closed.trace(), 1e-9);
    EXPECT_NEAR(4.0 * both.K[q][0](0), closed(0, 0) * closed(1, 1) - closed(0, 1) * closed(1, 0),
                1e-9);
  }
  EXPECT_NE(nullptr, law.gains().find("modes/2/K"));
}

/// A body in a plane with drag, whose two positions are measured: bernard2022, section 7.1.
ObserverContext puck(const Eigen::Vector4d& start) {
  const std::vector<std::string> x = {"px", "vx", "py", "vy"};
  PlantDescription plant;
  plant.state_names = x;
  plant.sensors = {{"across", SensorTiming::kContinuous, {false}},
                   {"along", SensorTiming::kContinuous, {false}}};
  PlantMode mode;
  mode.flow = formulas(x, {"vx", "-vx*sqrt(vx^2 + vy^2)", "vy", "-vy*sqrt(vx^2 + vy^2)"});
  mode.jump = formulas(x, {"px", "-0.8*vx", "py", "vy"});
  mode.outputs = {formulas(x, {"px"}), formulas(x, {"py"})};
  plant.modes = {mode};
  return {std::make_shared<const Plant>(plant), start, Eigen::VectorXd(0)};
}

TEST(NonlinearHighGainTest, SeveralOutputsHaveAChainEach) {
  const std::vector<std::string> z = {"z1", "z2", "z3", "z4"};
  const std::vector<std::string> z_and_x = {"z1", "z2", "z3", "z4", "px", "vx", "py", "vy"};
  const auto identity = formulas({"px", "vx", "py", "vy"}, {"px", "vx", "py", "vy"});
  const TransformedHighGainObserver::Maps maps{
      identity, formulas(z_and_x, {"-vx*sqrt(vx^2 + vy^2)", "-vy*sqrt(vx^2 + vy^2)"}),
      formulas(z, z)};
  Saturation bounds(4);
  for (Eigen::Index i = 0; i < 4; ++i) bounds.bound(i, -5.0, 5.0);
  const Eigen::Vector4d start(0.0, 0.0, 0.0, 0.0);
  const HighGainSettings two{bounds, 8.0, {{kK, Eigen::Vector2d(3.0, 2.0)}}};
  Body in_z(std::make_shared<const TransformedHighGainObserver>(
      puck(start), two, std::vector<TransformedHighGainObserver::Maps>{maps}));
  Body in_x(
      std::make_shared<const OriginalHighGainObserver>(puck(start), two, Formulas{identity}, 0.0));
  // ż = (z2, Φ1, z4, Φ2) + (ℓ k_11, ℓ² k_12, 0, 0) (y_1 − z1) + (0, 0, ℓ k_21, ℓ² k_22) (y_2 − z3)
  Eigen::VectorXd slope(8);
  in_z.take(EventKind::kOutput, {0.5}, 0);
  in_z.take(EventKind::kOutput, {-1.0}, 1);
  in_z.law->observer().flow_derivative(in_z.state.data(), slope.data(), in_z.workspace.data());
  EXPECT_LT((slope.tail(4) - Eigen::Vector4d(8.0, 32.0, -24.0, -128.0)).norm(), 1e-9);

  Body truth(in_x.law);  // without outputs it is the plant
  const Eigen::Vector4d x0(1.0, 2.0, -0.5, -1.0);
  truth.law->observer().start_from(x0.data(), truth.state.data());
  for (int i = 0; i < 2500; ++i) {
    for (Body* body : {&in_z, &in_x}) {
      body->take(EventKind::kOutput, {truth.state(0)}, 0);
      body->take(EventKind::kOutput, {truth.state(2)}, 1);
      body->flow(0.001);
    }
    truth.flow(0.001);
    if (i % 900 == 899) {
      for (Body* body : {&in_z, &in_x, &truth}) body->take(EventKind::kJump, {});
    }
  }
  EXPECT_LT((in_z.state.head(4) - truth.state.head(4)).norm(), 0.01);
  EXPECT_LT((in_x.state.head(4) - in_z.state.head(4)).norm(), 1e-6);
  EXPECT_GT(std::abs(truth.state(1)), 0.1);

  EXPECT_THROW(OriginalHighGainObserver(puck(start), settings(bounds, 8.0, {kK}), {identity}, 0.0),
               std::invalid_argument);
}

TEST(TransformedHighGainTest, JumpsAndStartsInItsCoordinates) {
  Saturation bounds(2);
  bounds.bound(1, -1.0, 1.0);
  Body body(transformed(Eigen::Vector2d(0.7, -1.2), bounds));
  const auto expect_state = [&body](double x1, double x2) {
    EXPECT_NEAR(x1, body.state(0), 1e-15);
    EXPECT_NEAR(x2, body.state(1), 1e-15);
    EXPECT_NEAR(x1, body.state(2), 1e-15);
    EXPECT_NEAR(x2 + 0.5 * std::sin(x1), body.state(3), 1e-15);
  };
  expect_state(0.7, -1.2);
  body.take(EventKind::kJump, {});  // x2⁺ = 1.08
  expect_state(0.7, 1.0);
  const Eigen::Vector2d other(-0.2, 0.4);
  body.law->observer().start_from(other.data(), body.state.data());
  expect_state(-0.2, 0.4);
}

TEST(TransformedHighGainTest, KeepsTheEstimateWithinTheBounds) {
  Saturation bounds(2);
  bounds.bound(1, -0.25, 0.25);
  Body body(transformed(Eigen::Vector2d(0.0, 0.0), bounds));
  body.take(EventKind::kOutput, {10.0});
  body.flow(0.2);
  EXPECT_EQ(0.25, body.state(1));
  EXPECT_GT(body.state(3), 1.0);
}

TEST(HighGainObserverTest, TheEstimateDependsOnEventsNotOnTheirArrival) {
  Saturation bounds(2);
  bounds.bound(0, -2.0, 2.0);
  for (const auto& law : {std::shared_ptr<const ObserverLaw>(cart_observer(2.0, bounds)),
                          transformed(Eigen::Vector2d(0.3, 0.2), bounds),
                          original(Eigen::Vector2d(0.3, 0.2), bounds)}) {
    std::mt19937_64 generator(7);
    std::uniform_real_distribution<double> value(-2.0, 2.0);
    std::vector<OwnedEvent> events = {{kStart, EventKind::kOutput, 0, {0.1}}};
    for (int i = 1; i < 60; ++i) {
      const Stamp stamp = kStart + i * 7654321;
      if (i % 7 == 0) events.push_back({stamp, EventKind::kJump, 0, {}});
      events.push_back({stamp, EventKind::kOutput, 0, {value(generator)}});
    }
    Estimator::Options options;
    options.history = {10 * kNanosecondsPerSecond, 1000};
    options.sampling = {1, 1};
    const Stamp end = kStart + kNanosecondsPerSecond;
    Eigen::VectorXd first;
    for (int order = 0; order < 4; ++order) {
      Estimator estimator(law, options);
      Estimate estimate = estimator.make_estimate();
      const std::size_t before = test::allocations();
      for (const OwnedEvent& event : events) {
        EXPECT_TRUE(estimator.submit(event.view(), end).used());
        estimator.estimate_at(event.stamp + 1234567, estimate);
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
}

template <class Make>
std::string fault(Make make) {
  try {
    make();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no fault";
}

TEST(HighGainObserverTest, RefusesWhatDoesNotFit) {
  const ObserverContext linear{cart(false), Eigen::Vector2d::Zero(), Eigen::VectorXd(0)};
  const ObserverContext nonlinear = oscillator(Eigen::Vector2d::Zero());
  const auto contains = [](const std::string& text, const char* part) {
    EXPECT_NE(std::string::npos, text.find(part)) << text;
  };
  contains(fault([&] { LinearHighGainObserver(linear, settings(Saturation(3), 1.0, {kK})); }),
           "saturations");
  contains(fault([&] { LinearHighGainObserver(nonlinear, settings(no_bounds(), 1.0, {kK})); }),
           "a flow by matrices");
  const auto make_transformed = [&](double ell, const Eigen::VectorXd& K,
                                    TransformedHighGainObserver::Maps maps) {
    return fault(
        [&] { TransformedHighGainObserver(nonlinear, settings(no_bounds(), ell, {K}), {maps}); });
  };
  TransformedHighGainObserver::Maps maps = oscillator_maps();
  EXPECT_EQ("no fault", make_transformed(1.0, kK, maps));
  contains(make_transformed(-1.0, kK, maps), "ell must be positive");
  contains(make_transformed(1.0, Eigen::Vector2d(1.0, -1.0), maps), "not Hurwitz");
  contains(make_transformed(1.0, Eigen::Vector3d(3.0, 3.0, 1.0), maps), "T: as many");
  maps.Theta = formulas({"z1", "z2"}, {"z1"});
  contains(make_transformed(1.0, kK, maps), "Theta: one entry per state");
  maps = oscillator_maps();
  maps.Theta = formulas({"z1", "z2"}, {"z1", "z2/z1"});
  contains(make_transformed(1.0, kK, maps), "not defined at the initial estimate");
  contains(fault([&] {
             OriginalHighGainObserver(nonlinear, settings(no_bounds(), 1.0, {kK}),
                                      {formulas({"x1", "x2"}, {"x1", "x1"})}, 0.0);
           }),
           "not defined at the initial estimate");
}

TEST(SaturationTest, BoundsEachEntryAndGivesAValueWhereThereIsNone) {
  Saturation bounds(3);
  bounds.bound(0, -1.0, 2.0);
  bounds.bound(1, 5.0, 9.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  double x[] = {-3.0, nan, nan};
  bounds.apply(x);
  EXPECT_EQ(-1.0, x[0]);
  EXPECT_EQ(5.0, x[1]);
  EXPECT_TRUE(std::isnan(x[2]));
  x[0] = std::numeric_limits<double>::infinity();
  bounds.apply(x);
  EXPECT_EQ(2.0, x[0]);
  EXPECT_EQ(1.5, bounds.scales()(0));
  EXPECT_EQ(1.0, bounds.scales()(2));
  EXPECT_THROW(bounds.bound(2, 1.0, 1.0), std::invalid_argument);
  EXPECT_THROW(bounds.bound(3, 1.0, 2.0), std::invalid_argument);
}

TEST(OrderedSolveTest, SolvesWithPivotsAndTellsSingularMatrices) {
  Eigen::Matrix3d M;
  M << 0.0, 2.0, 1.0, 1e-20, 1.0, 3.0, 4.0, -1.0, 0.5;
  const Eigen::Vector3d x(1.0, -2.0, 3.0);
  Eigen::Matrix3d destroyed = M;
  Eigen::Vector3d b = M * x;
  solve_in_place(destroyed.data(), b.data(), 3);
  EXPECT_LT((x - b).norm(), 1e-14);
  Eigen::Matrix2d singular;
  singular << 1.0, 2.0, 2.0, 4.0;
  Eigen::Vector2d c(1.0, 1.0);
  solve_in_place(singular.data(), c.data(), 2);
  EXPECT_TRUE(c.array().isNaN().all());
}

}  // namespace
}  // namespace sampled_data_observers
