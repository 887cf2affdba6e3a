#include <gtest/gtest.h>

#include <cmath>

#include "plant/affine_formula.h"
#include "plant/lipschitz_map.h"
#include "sampled_data_observers/plant/expression_map.h"
#include "sampled_data_observers/plant/runge_kutta_flow.h"
#include "support/allocation_counter.h"

namespace sampled_data_observers {
namespace {

const ExpressionNames kMapNames{{"x1", "x2"}, {"u"}, {{"a", 0.5}}};

std::string fault(const ExpressionNames& names, const std::vector<NamedExpression>& definitions,
                  const std::string& formula) {
  try {
    const ExpressionMap map(names, definitions, {{"f", formula}});
  } catch (const ExpressionError& error) {
    return error.name() + ": " + error.what();
  }
  return "";
}

TEST(ExpressionMapTest, EvaluatesFormulasOfStatesInputsAndConstants) {
  const ExpressionMap map(kMapNames, {}, {{"f", "-2*sin(x1) - 3*x2 + u"}, {"g", "a*x1^2 + pi"}});
  ASSERT_EQ(2, map.size());
  const double x[] = {0.7, -1.5};
  const double u[] = {4.0};
  double out[2];
  map.evaluate(x, u, out);
  EXPECT_DOUBLE_EQ(-2.0 * std::sin(0.7) + 4.5 + 4.0, out[0]);
  EXPECT_DOUBLE_EQ(0.5 * 0.7 * 0.7 + std::acos(-1.0), out[1]);
}

TEST(AffineFormulaTest, FormulasThatAreAffineAreTheMapThatTheyAre) {
  const auto map =
      affine_map_of(kMapNames, {"x2", "101325 - 11.9*x1", "-(x1 - 2*(a*x2 + u))/4 + 1.5e-1",
                                "pi*+x1*2 - -u", "x1^1 + sin(2)*x2"});
  ASSERT_NE(nullptr, map);
  Eigen::MatrixXd M(5, 2);
  M << 0.0, 1.0, -11.9, 0.0, -0.25, 0.25, 2.0 * std::acos(-1.0), 0.0, 1.0, std::sin(2.0);
  EXPECT_TRUE(M.isApprox(map->M(), 1e-15));
  EXPECT_EQ(Eigen::Vector4d(0.0, 0.0, 0.5, 1.0), Eigen::VectorXd(map->N()).head(4));
  EXPECT_EQ(Eigen::Vector4d(0.0, 101325.0, 0.15, 0.0), map->c().head(4));
  EXPECT_EQ(0, affine_map_of(kMapNames, {"x1"})->N().cols());
}

TEST(AffineFormulaTest, WhatIsNotOrCanNotBeToldIsNone) {
  for (const char* text :
       {"x1*x2", "1/x1", "sin(x1)", "x1^2", "x1 > 0 ? x1 : x2", "abs(x1)", "x1/0", "(x1", "x1)",
        "x1 x2", "1e", "y", "", "x1 +", "min(x1, x2)", "1..2*x1", "x1 && u"}) {
    EXPECT_EQ(nullptr, affine_map_of(kMapNames, {"x1", text})) << text;
  }
  EXPECT_EQ(nullptr,
            affine_map_of(kMapNames, {std::string(5000, '(') + "x1" + std::string(5000, ')')}));
}

TEST(ExpressionMapTest, FormulasThatAreOnlyANameOrANumberAreThatToTheBit) {
  const ExpressionMap map(
      kMapNames, {{"d", " u "}, {"e", "3*d"}, {"c", "-a/3"}},
      {{"f", "\tx2"}, {"g", "d"}, {"h", "e"}, {"i", "c"}, {"j", "sqrt(0 - 1)"}, {"k", "1e3"}});
  const double x[] = {0.7, -0.0};
  double out[6];
  for (const double u : {0.1, -0.3}) {
    map.evaluate(x, &u, out);
    EXPECT_EQ(0.0, out[0]);
    EXPECT_TRUE(std::signbit(out[0]));
    EXPECT_EQ(u, out[1]);
    EXPECT_EQ(3.0 * u, out[2]);
    EXPECT_EQ(-0.5 / 3.0, out[3]);
    EXPECT_TRUE(std::isnan(out[4]));
    EXPECT_EQ(1e3, out[5]);
  }
}

TEST(ExpressionMapTest, DefinitionsServeTheFormulasBehindThem) {
  const ExpressionMap map(kMapNames, {{"s", "x1 + x2"}, {"q", "s*s"}}, {{"f", "q - s + u"}});
  const double x[] = {1.0, 2.0};
  const double u[] = {0.5};
  double out = 0.0;
  map.evaluate(x, u, &out);
  EXPECT_EQ(6.5, out);
}

TEST(ExpressionMapTest, WhatHasNoValueIsNotFinite) {
  const ExpressionMap map(kMapNames, {}, {{"f", "sqrt(x1)"}, {"g", "1/x2"}, {"h", "ln(x1)"}});
  const double x[] = {-1.0, 0.0};
  const double u[] = {0.0};
  double out[3];
  map.evaluate(x, u, out);
  for (const double value : out) EXPECT_FALSE(std::isfinite(value));
}

TEST(ExpressionMapTest, RefusesWhatItCanNotUse) {
  EXPECT_EQ("", fault(kMapNames, {}, "x1 == 1 ? x2 : u"));
  EXPECT_NE(std::string::npos, fault(kMapNames, {}, "x3 + 1").find("x3"));
  EXPECT_NE(std::string::npos, fault(kMapNames, {}, "x3 + 1").find("it may use x1 x2 u a pi"));
  EXPECT_NE("", fault(kMapNames, {}, "2*(x1"));
  EXPECT_NE("", fault(kMapNames, {}, ""));
  EXPECT_NE(std::string::npos, fault(kMapNames, {}, "x1 = 3").find("assigns"));
  EXPECT_NE("", fault(kMapNames, {}, "x1, x2"));
  EXPECT_NE("", fault(kMapNames, {{"later", "last"}, {"last", "x1"}}, "later"));
  EXPECT_NE(std::string::npos, fault({{"x 1"}, {}, {}}, {}, "1").find("x 1"));
  EXPECT_NE("", fault({{"1x"}, {}, {}}, {}, "1"));
}

TEST(ExpressionMapTest, EvaluatingAllocatesNothing) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const ExpressionMap map(kMapNames, {{"s", "x1 + x2"}}, {{"f", "x1 > 0 ? sin(s) : sqrt(x1) + u"}});
  double x[] = {-1.0, 2.0};
  const double u[] = {0.5};
  double out = 0.0;
  const std::size_t before = test::allocations();
  for (int i = 0; i < 100; ++i) {
    x[0] = -x[0];
    map.evaluate(x, u, &out);
  }
  EXPECT_EQ(before, test::allocations());
}

LipschitzDescription pendulum() {
  LipschitzDescription description;
  description.A = Eigen::Matrix2d::Zero();
  description.A(0, 1) = 1.0;
  description.B = Eigen::Vector2d(0.0, 1.0);
  description.G = Eigen::Vector2d(0.0, -2.0);
  description.S = Eigen::RowVector2d(1.0, 0.0);
  description.psi = std::make_shared<const ExpressionMap>(
      ExpressionNames{{"v1"}, {}, {}}, std::vector<NamedExpression>{},
      std::vector<NamedExpression>{{"psi", "sin(v1)"}});
  return description;
}

TEST(LipschitzMapTest, IsTheLinearPartPlusTheNonlinearity) {
  const LipschitzMap map(pendulum());
  const double x[] = {0.3, 0.9};
  const double u[] = {0.25};
  double out[2];
  map.evaluate(x, u, out);
  EXPECT_EQ(0.9, out[0]);
  EXPECT_DOUBLE_EQ(0.25 - 2.0 * std::sin(0.3), out[1]);
}

TEST(LipschitzMapTest, RefusesPartsThatDoNotFit) {
  LipschitzDescription description = pendulum();
  description.G = Eigen::MatrixXd::Zero(2, 2);
  EXPECT_THROW(LipschitzMap{description}, std::invalid_argument);
  description = pendulum();
  description.vertices = {Eigen::MatrixXd::Zero(1, 1)};
  EXPECT_THROW(LipschitzMap{description}, std::invalid_argument);
  description = pendulum();
  description.lipschitz_constant = -1.0;
  EXPECT_THROW(LipschitzMap{description}, std::invalid_argument);
}

/// ẋ = (x2, -x1)
class Oscillator : public VectorField {
 public:
  void evaluate(const double* x, double* dx) const override {
    dx[0] = x[1];
    dx[1] = -x[0];
  }
};

double error_after_one_second(Duration step) {
  const RungeKuttaFlow flow(2, step);
  double x[] = {1.0, 0.0};
  flow.apply(Oscillator(), kNanosecondsPerSecond, x);
  return std::hypot(x[0] - std::cos(1.0), x[1] + std::sin(1.0));
}

TEST(RungeKuttaFlowTest, IsOfOrderFour) {
  const double coarse = error_after_one_second(kNanosecondsPerSecond / 10);
  const double fine = error_after_one_second(kNanosecondsPerSecond / 20);
  EXPECT_LT(coarse, 1e-6);
  EXPECT_NEAR(16.0, coarse / fine, 1.0);
}

TEST(RungeKuttaFlowTest, MayBeSplitAtWholeStepsWithoutChangingABit) {
  const Duration step = kNanosecondsPerSecond / 7;
  const RungeKuttaFlow flow(2, step);
  double whole[] = {1.0, 0.3};
  double split[] = {1.0, 0.3};
  flow.apply(Oscillator(), 10 * step + 12345, whole);
  flow.apply(Oscillator(), 4 * step, split);
  flow.apply(Oscillator(), 6 * step, split);
  flow.apply(Oscillator(), 12345, split);
  EXPECT_EQ(whole[0], split[0]);
  EXPECT_EQ(whole[1], split[1]);
}

TEST(RungeKuttaFlowTest, AllocatesNothing) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const RungeKuttaFlow flow(2, kNanosecondsPerSecond / 100);
  double x[] = {1.0, 0.0};
  const std::size_t before = test::allocations();
  flow.apply(Oscillator(), kNanosecondsPerSecond, x);
  EXPECT_EQ(before, test::allocations());
}

}  // namespace
}  // namespace sampled_data_observers
