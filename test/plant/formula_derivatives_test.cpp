// Formulas are differentiated as muParser evaluates them.
#include <gtest/gtest.h>
#include <muParser.h>

#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "plant/bias_states.h"
#include "plant/bounded_slope_map.h"
#include "plant/differentiation.h"
#include "plant/formula_parser.h"
#include "plant/formula_program.h"
#include "plant/jacobian.h"
#include "plant/lipschitz_map.h"
#include "support/allocation_counter.h"

namespace sampled_data_observers {
namespace {

const ExpressionNames kNames{{"x", "y"}, {"u"}, {{"a", 0.5}}};

ExpressionMap formula(const std::string& text) { return {kNames, {}, {{"f", text}}}; }

double value(const std::string& text, const Eigen::Vector2d& x, double u = 0.7) {
  double result = 0.0;
  formula(text).evaluate(x.data(), &u, &result);
  return result;
}

Eigen::RowVector2d gradient(const std::string& text, const Eigen::Vector2d& x, double u = 0.7) {
  Eigen::RowVector2d result;
  formula(text).jacobian()->evaluate(x.data(), &u, result.data());
  return result;
}

/// The value by what is differentiated.
double understood(const std::string& text, const Eigen::Vector2d& x, double u = 0.7) {
  FormulaGraph graph;
  std::map<std::string, FormulaGraph::Node> names = {{"a", graph.constant(0.5)}};
  names["x"] = graph.variable(0);
  names["y"] = graph.variable(1);
  names["u"] = graph.variable(2);
  names["pi"] = graph.constant(std::acos(-1.0));
  const mu::Parser parser;
  for (const auto& [name, number] : parser.GetConst()) names[name] = graph.constant(number);
  const FormulaProgram program(graph, 2, {parse_formula(text, names, graph)});
  double result = 0.0;
  program.evaluate(x.data(), &u, &result);
  return result;
}

TEST(FormulaDerivativesTest, AreThoseOfTheTextbook) {
  struct Case {
    std::string formula;
    std::string by_x;
  };
  const std::vector<Case> cases = {
      {"sin(2*x)", "2*cos(2*x)"},
      {"cos(x)*y", "-sin(x)*y"},
      {"tan(x)", "1/cos(x)^2"},
      {"asin(x)", "1/sqrt(1 - x^2)"},
      {"acos(x)", "-1/sqrt(1 - x^2)"},
      {"atan(3*x)", "3/(1 + 9*x^2)"},
      {"sinh(x)", "cosh(x)"},
      {"cosh(x)", "sinh(x)"},
      {"tanh(x)", "1/cosh(x)^2"},
      {"asinh(x)", "1/sqrt(x^2 + 1)"},
      {"acosh(x + 2)", "1/sqrt((x + 2)^2 - 1)"},
      {"atanh(x)", "1/(1 - x^2)"},
      {"log2(x)", "1/(x*ln(2))"},
      {"log10(x)", "1/(x*ln(10))"},
      {"log(x)", "1/x"},
      {"ln(x*y)", "1/x"},
      {"exp(-x^2)", "-2*x*exp(-x^2)"},
      {"sqrt(x)", "1/(2*sqrt(x))"},
      {"abs(-x)", "1"},
      {"sign(x) + rint(x)", "0"},
      {"atan2(x, y)", "y/(x^2 + y^2)"},
      {"atan2(y, x)", "-y/(x^2 + y^2)"},
      {"min(y, x*x, 9)", "2*x"},
      {"max(y, x*x, -9)", "0"},
      {"sum(x, y, 3*x)", "4"},
      {"avg(x, y, 3*x)", "4/3"},
      {"x^5", "5*x^4"},
      {"x^y", "y*x^(y - 1)"},
      {"y^x", "y^x*ln(y)"},
      {"x/y - y/x", "1/y + y/x^2"},
      {"x > y ? x^2 : y*x", "y"},
      {"(x < y && y <= 1) || x == 2 ? x*u : 0", "u"},
      {"x >= 0.1 && x != 7 ? -x^2 : 1", "-2*x"},
      {"-x^2*a - -x + 2^-x", "-2*x*a + 1 - ln(2)*2^(-x)"},
      {"_pi*x + pi + _e*x + 1.5e-1*x + .5*x", "_pi + _e + 0.15 + 0.5"},
  };
  const Eigen::Vector2d at(0.3, 0.8);
  for (const Case& each : cases) {
    EXPECT_NEAR(value(each.by_x, at), gradient(each.formula, at)(0),
                1e-14 * (1.0 + std::abs(value(each.by_x, at))))
        << each.formula;
    EXPECT_NEAR(value(each.formula, at), understood(each.formula, at), 1e-15) << each.formula;
  }
}

TEST(FormulaDerivativesTest, EveryFunctionOfMuParserIsKnown) {
  const mu::Parser parser;
  for (const auto& [name, callback] : parser.GetFunDef()) {
    const std::string arguments = callback.GetArgc() == 1 ? "(x)" : "(x, y)";
    EXPECT_NO_THROW(gradient(name + arguments, Eigen::Vector2d(0.3, 0.8))) << name;
  }
}

/// A formula of x, y, u and a that is smooth almost everywhere.
std::string random_formula(std::mt19937_64& generator, int depth) {
  std::uniform_int_distribution<int> kind(0, depth > 0 ? 13 : 4);
  const auto part = [&] { return random_formula(generator, depth - 1); };
  switch (kind(generator)) {
    case 0:
      return "x";
    case 1:
      return "y";
    case 2:
      return "u";
    case 3:
      return "a";
    case 4:
      return "1.25";
    case 5:
      return part() + " + " + part();
    case 6:
      return part() + " - (" + part() + ")";
    case 7:
      return "(" + part() + ")*" + part();
    case 8:
      return "(" + part() + ")/(2 + (" + part() + ")^2)";
    case 9:
      return "sin(" + part() + ")";
    case 10:
      return "-" + std::string("(") + part() + ")^2";
    case 11:
      return "exp(-abs(" + part() + "))";
    case 12:
      return "(" + part() + " < " + part() + " ? " + part() + " : " + part() + ")";
    default:
      return "atan2(" + part() + ", 1 + (" + part() + ")^2)";
  }
}

TEST(FormulaDerivativesTest, OfRandomFormulasAreTheirDifferences) {
  std::mt19937_64 generator(11);
  std::uniform_real_distribution<double> coordinate(-1.5, 1.5);
  int different = 0;
  for (int i = 0; i < 500; ++i) {
    const std::string text = random_formula(generator, 4);
    const Eigen::Vector2d at(coordinate(generator), coordinate(generator));
    const double known = value(text, at);
    EXPECT_NEAR(known, understood(text, at), 1e-12 * (1.0 + std::abs(known))) << text;
    Eigen::RowVector2d differences;
    std::vector<double> workspace(4);
    const double u = 0.7;
    differentiate(formula(text), at.data(), &u, Eigen::Vector2d::Ones(), differences.data(),
                  workspace.data());
    const Eigen::RowVector2d found = gradient(text, at);
    // A kink may lie between the two points of a difference.
    if ((found - differences).norm() > 1e-6 * (1.0 + differences.norm())) ++different;
  }
  EXPECT_LE(different, 2);
}

TEST(FormulaDerivativesTest, GoThroughDefinitionsAndGiveEachEntryByColumns) {
  const ExpressionMap map(kNames, {{"s", "x*y"}, {"q", "s^2 + u*x"}},
                          {{"f", "q"}, {"g", "s - x"}, {"h", "u"}});
  const auto derivative = map.jacobian();
  ASSERT_EQ(6, derivative->size());
  Eigen::Matrix<double, 3, 2> J;
  const double x[] = {2.0, 3.0};
  const double u = 5.0;
  const std::size_t before = test::allocations();
  derivative->evaluate(x, &u, J.data());
  if (test::allocations_are_counted()) {
    EXPECT_EQ(before, test::allocations());
  }
  Eigen::Matrix<double, 3, 2> expected;
  expected << 2.0 * 6.0 * 3.0 + 5.0, 2.0 * 6.0 * 2.0, 3.0 - 1.0, 2.0, 0.0, 0.0;
  EXPECT_EQ(expected, J);
}

TEST(FormulaDerivativesTest, AreRefusedWhereTheyTakeTooMuch) {
  std::string deep = "x";
  for (int i = 0; i < 600; ++i) deep = "(" + deep + ")";
  EXPECT_THROW(formula(deep).jacobian(), std::invalid_argument);
  std::string powers = "x";
  for (int i = 0; i < 600; ++i) powers += "^x";
  EXPECT_THROW(formula(powers).jacobian(), std::invalid_argument);
}

/// The Jacobian that a map knows, and the same by differences.
void expect_its_differences(const std::shared_ptr<const VectorMap>& map, const Eigen::VectorXd& x) {
  const double u = 0.4;
  const Eigen::Index n = x.size();
  Eigen::MatrixXd differences(map->size(), n);
  Eigen::VectorXd workspace(n + 2 * map->size());
  differentiate(*map, x.data(), &u, Eigen::VectorXd::Ones(n), differences.data(), workspace.data());
  ASSERT_NE(nullptr, map->jacobian());
  const Jacobian jacobian(map, Eigen::VectorXd::Ones(n));
  EXPECT_EQ(0, jacobian.workspace_size());
  Eigen::MatrixXd J(map->size(), n);
  jacobian.evaluate(x.data(), &u, J.data(), nullptr);
  EXPECT_LT((differences - J).norm(), 1e-9 * (1.0 + J.norm()));
}

TEST(JacobianTest, OfMapsAroundFormulasIsKnown) {
  LipschitzDescription description;
  description.A = (Eigen::MatrixXd(2, 2) << 0.1, 1.0, -0.5, 0.2).finished();
  description.B = Eigen::Vector2d(0.0, 1.0);
  description.G = (Eigen::MatrixXd(2, 2) << 0.0, 0.3, -2.0, 1.0).finished();
  description.S = (Eigen::MatrixXd(3, 2) << 1.0, 0.0, 0.5, 1.0, 0.0, 2.0).finished();
  description.psi = std::make_shared<const ExpressionMap>(
      ExpressionNames{{"v1", "v2", "v3"}, {"u"}, {}}, std::vector<NamedExpression>{},
      std::vector<NamedExpression>{{"1", "sin(v1)*v2 + u*v1"}, {"2", "v3^2"}});
  const auto lipschitz = std::make_shared<const LipschitzMap>(description);
  expect_its_differences(lipschitz, Eigen::Vector2d(0.3, -0.8));

  const auto formulas = std::make_shared<const ExpressionMap>(
      kNames, std::vector<NamedExpression>{},
      std::vector<NamedExpression>{{"1", "x*y"}, {"2", "sin(x) + u*y"}});
  expect_its_differences(std::make_shared<const BoundedSlopeMap>(formulas, 3.0),
                         Eigen::Vector2d(0.3, -0.8));

  PlantDescription plant;
  plant.state_names = {"x", "y"};
  plant.input_names = {"u"};
  plant.sensors = {{"s", SensorTiming::kSampled, {false, false}}};
  plant.modes.push_back({0, formulas, formulas, {formulas}, nullptr, nullptr});
  const PlantDescription extended = with_bias_states(plant, {{"b", 0, 1}});
  const Eigen::Vector3d at(0.3, -0.8, 0.5);
  expect_its_differences(extended.modes[0].flow, at);
  expect_its_differences(extended.modes[0].jump, at);
  expect_its_differences(extended.modes[0].outputs[0], at);
}

/// A map as plug-ins have it.
class Opaque : public VectorMap {
 public:
  explicit Opaque(std::shared_ptr<const VectorMap> map) : map_(std::move(map)) {}
  Eigen::Index size() const override { return map_->size(); }
  void evaluate(const double* x, const double* u, double* out) const override {
    map_->evaluate(x, u, out);
  }

 private:
  std::shared_ptr<const VectorMap> map_;
};

TEST(JacobianTest, OfOtherMapsIsByDifferencesAndOfAffineOnesTheirMatrix) {
  const auto formulas = std::make_shared<const ExpressionMap>(
      kNames, std::vector<NamedExpression>{},
      std::vector<NamedExpression>{{"1", "x*y"}, {"2", "sin(x) + u*y"}});
  const Jacobian known(formulas, Eigen::Vector2d::Ones());
  const Jacobian differences(std::make_shared<const Opaque>(formulas), Eigen::Vector2d::Ones());
  const Eigen::Vector2d x(0.3, -0.8);
  const double u = 0.4;
  Eigen::Matrix2d J;
  Eigen::Matrix2d by_differences;
  Eigen::VectorXd workspace(differences.workspace_size());
  known.evaluate(x.data(), &u, J.data(), nullptr);
  differences.evaluate(x.data(), &u, by_differences.data(), workspace.data());
  EXPECT_NE(J, by_differences);
  EXPECT_LT((J - by_differences).norm(), 1e-9);

  const Eigen::Matrix2d M = (Eigen::Matrix2d() << 1.0, 2.0, 3.0, 4.0).finished();
  const Jacobian affine(std::make_shared<const AffineMap>(M), Eigen::Vector2d::Ones());
  affine.evaluate(x.data(), &u, J.data(), nullptr);
  EXPECT_EQ(M, J);
  ASSERT_NE(nullptr, affine.constant());
}

}  // namespace
}  // namespace sampled_data_observers
