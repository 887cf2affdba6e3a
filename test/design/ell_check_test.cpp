#include "design/ell_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "design/mode_coordinates.h"
#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/config/yaml_file.h"

namespace sampled_data_observers {
namespace {

/// Owns the law that the check is about.
struct Subject {
  explicit Subject(const std::string& yaml)
      : config(read_observer_config(read_yaml_text(yaml, "test.yaml"), no_plant_plugins)),
        law(dynamic_cast<const TransformedHighGainObserver&>(config.law->observer())) {}
  ObserverConfig config;
  const TransformedHighGainObserver& law;
};

/// dx/dt = x^3 on [-2, 2], with K = 1.
std::string cubic(const std::string& ell) {
  return R"(
observer: HighGainObserver
plant: {states: [x], flow: {x: x^3}}
sensors: {y: {h: [x], measured: continuous, source: {topic: y}}}
sampling: {T1: 0.01, T2: 0.01}
gains:
  form: transformed
  K: [1]
  T: [x]
  Theta: {x: z1}
  Phi: x^3
  saturations: {x: [-2, 2]}
  ell: )" +
         ell;
}

// The slope of Phi is 12 at most, and P = 1/2: ell_0 = 12. From x on, a second equilibrium is where
// the chord of Phi from there has slope ell; near 2 that is 12, too.
TEST(EllCheck, IsExactForAScalarPlant) {
  const Subject high(cubic("20"));
  const EllCheck enough = check_ell(high.law, 0, 400);
  EXPECT_EQ(398u, enough.regular);  // all but the two bounds
  EXPECT_NEAR(12.0, enough.slopes(0), 0.2);
  EXPECT_NEAR(12.0, enough.sufficient_ell, 0.2);
  EXPECT_FALSE(enough.second);
  ASSERT_TRUE(enough.least_ell);
  EXPECT_NEAR(12.0, *enough.least_ell, 1.0);
  EXPECT_LT(enough.derivative_errors.maxCoeff(), 1e-6);
}

TEST(EllCheck, NamesTheSecondEquilibrium) {
  const Subject low(cubic("3"));
  const EllCheck check = check_ell(low.law, 0, 400);
  ASSERT_TRUE(check.second);
  EXPECT_GT(check.points_with_second, 300u);
  EXPECT_EQ(2.0, std::abs(check.second->x_hat(0)));
  // There 0 = sat(z)^3 + ell (x - z) - x^3.
  const double x = check.second->x(0);
  EXPECT_NEAR(0.0,
              std::pow(check.second->x_hat(0), 3) + 3.0 * (x - check.second->z_hat(0)) - x * x * x,
              1e-3);
  // And the observer stays there: y = x is held, and what Phi does at x is taken off.
  ASSERT_TRUE(check.least_ell);
  EXPECT_NEAR(12.0, *check.least_ell, 1.0);
  const std::string report = ell_report(low.law, {check});
  EXPECT_NE(std::string::npos, report.find("SECOND EQUILIBRIUM at")) << report;
  EXPECT_NE(std::string::npos, report.find("at its bounds: x")) << report;
}

/// Jumps of it multiply the error of v and mix it into x.
std::string kicked(const std::string& jump) {
  return R"(
observer: HighGainObserver
plant:
  states: [x, v]
  flow: {x: v, v: -v}
  jump_map: {formulas: {)" +
         jump + R"(}}
sensors: {y: {h: [x], measured: continuous, source: {topic: y}}}
sampling: {T1: 0.01, T2: 0.01}
gains:
  form: transformed
  K: [2, 1]
  T: [x, v]
  Theta: {x: z1, v: z2}
  Phi: -v
  saturations: {x: [-10, 10], v: [-10, 10]}
  ell: 5
)";
}

TEST(EllCheck, FindsTheGainOfCorollary41ForJumps) {
  const Subject linear(kicked("x: 0.5*x + 0.2*v, v: 3*v"));
  const EllCheck check = check_ell(linear.law, 0, 400, 0.5);
  // By the definition: P = [0.5, -0.5; -0.5, 1.5] of (A - K H)' P + P (A - K H) = -I, and Phi has
  // the slopes 0 and 1.
  const double of_Phi = 2.0 * std::sqrt(0.5 * 0.5 + 1.5 * 1.5);
  EXPECT_NEAR(of_Phi, check.sufficient_ell, 1e-4);
  Eigen::Matrix2d P;
  P << 0.5, -0.5, -0.5, 1.5;
  const auto worst = [&](double ell) {
    Eigen::Matrix2d J;
    J << 0.5, 0.2 * ell, 0.0, 3.0;
    double largest = 0.0;
    for (int k = 0; k < 10000; ++k) {
      const Eigen::Vector2d e(std::cos(k * 3.1416e-4), std::sin(k * 3.1416e-4));
      largest = std::max(largest, (J * e).dot(P * (J * e)) / e.dot(P * e));
    }
    return std::log(largest) - 0.5 * (ell - of_Phi) / (1.0 + std::sqrt(0.5));
  };
  EXPECT_LT(worst(check.ell_for_jumps), 0.0);
  EXPECT_GT(worst(check.ell_for_jumps / 1.06), 0.0);
  // A nonlinear map with these slopes at most needs no more, and nearly as much.
  const Subject turned(kicked("x: 0.5*x + 0.2*v, v: -3*v"));
  const double of_both =
      std::max(check.ell_for_jumps, check_ell(turned.law, 0, 400, 0.5).ell_for_jumps);
  const Subject nonlinear(kicked("x: 0.5*x + 0.2*v, v: 3*sin(v)"));
  const double of_sine = check_ell(nonlinear.law, 0, 400, 0.5).ell_for_jumps;
  EXPECT_LE(of_sine, 1.06 * of_both);
  EXPECT_GE(of_sine, 0.9 * of_both);
  const std::string report = ell_report(linear.law, {check});
  EXPECT_NE(std::string::npos, report.find("ell of corollary 4.1 for 0.5 s")) << report;
  const Subject cube(cubic("3"));
  EXPECT_THROW(check_ell(cube.law, 0, 100, 0.5), std::invalid_argument);
}

TEST(EllCheck, TellsFormulasThatAreNoDerivatives) {
  std::string text = cubic("20");
  text.replace(text.find("Phi: x^3"), 8, "Phi: x^2");
  const Subject wrong(text);
  const EllCheck check = check_ell(wrong.law, 0, 100);
  EXPECT_GT(check.derivative_errors(1), 0.1);
  EXPECT_NE(std::string::npos,
            ell_report(wrong.law, {check}).find("Phi is not the derivative of T_1"));
}

// The pendulum of doc/high_gain_observer.md: |dPhi/dz1| <= 9.81, |dPhi/dz2| = 0.3.
TEST(EllCheck, TakesTheSlopesInEachCoordinate) {
  const Subject pendulum(R"(
observer: HighGainObserver
plant:
  states: [angle, rate]
  flow: {angle: rate, rate: -9.81*sin(angle) - 0.3*rate}
sensors: {y: {h: [angle], measured: continuous, source: {topic: y}}}
sampling: {T1: 0.01, T2: 0.01}
gains:
  form: transformed
  ell: 5
  K: [2, 1]
  T: [angle, rate]
  Theta: {angle: z1, rate: z2}
  Phi: -9.81*sin(angle) - 0.3*rate
  saturations: {angle: [-4, 4], rate: [-10, 10]}
)");
  const EllCheck check = check_ell(pendulum.law, 0, 500);
  EXPECT_NEAR(9.81, check.slopes(0), 0.02);
  EXPECT_NEAR(0.3, check.slopes(1), 1e-6);
  // P = [0.5 -0.5; -0.5 1.5] solves the Lyapunov equation: |P B| = sqrt(2.5).
  const double ell = check.sufficient_ell;
  EXPECT_NEAR(ell, 2.0 * std::sqrt(2.5) * std::hypot(check.slopes(0) / ell, check.slopes(1)), 1e-6);
}

}  // namespace
}  // namespace sampled_data_observers
