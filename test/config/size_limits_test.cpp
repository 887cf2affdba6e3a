// How large a plant may be, so that loading ends within seconds.
#include <gtest/gtest.h>

#include <string>

#include "support/config_faults.h"

namespace sampled_data_observers::test {
namespace {

std::string listed(std::size_t count, const std::string& prefix, const std::string& suffix = "") {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    text += (i == 0 ? "" : ", ") + prefix + std::to_string(i) + suffix;
  }
  return text;
}

std::string matrix(std::size_t rows, std::size_t columns, const std::string& diagonal) {
  std::string text;
  for (std::size_t i = 0; i < rows; ++i) {
    text += i == 0 ? "[" : ", [";
    for (std::size_t j = 0; j < columns; ++j) {
      text += (j == 0 ? "" : ", ") + (i == j ? diagonal : "0");
    }
    text += "]";
  }
  return "[" + text + "]";
}

/// An observer of a plant of n states, of which m are measured.
std::string observer(std::size_t n, std::size_t m, const std::string& gains,
                     const std::string& type = "ConstantGainObserver") {
  return "observer: " + type + "\nsampling: {T1: 0.1, T2: 0.1}\nplant: {states: [" +
         listed(n, "x") + "], A: " + matrix(n, n, "-1") +
         "}\nsensors: {s: {C: " + matrix(m, n, "1") + ", source: {topic: s}}}\ngains: {" + gains +
         "}\n";
}

std::string kalman(std::size_t n) {
  return observer(n, 1, "P0: " + matrix(n, n, "1") + ", R: [[1]]", "HybridKalmanFilter");
}

/// A plant by formulas of one state, with more keys.
std::string formulas(const std::string& keys, const std::string& formula = "-x") {
  return "observer: ConstantGainObserver\nsampling: {T1: 0.1, T2: 0.1}\nplant: {states: [x], " +
         keys + "flow: {x: \"" + formula +
         "\"}}\nsensors: {s: {C: [[1]], source: {topic: s}}}\ngains: {L: [[0.1]]}\n";
}

TEST(SizeLimitsTest, ManyStatesAreLoaded) {
  EXPECT_EQ("no fault", fault(observer(60, 10, "L: " + matrix(60, 10, "0.1"))));
  EXPECT_EQ("no fault", fault(kalman(30)));
}

TEST(SizeLimitsTest, TooManyVariablesAreRefused) {
  EXPECT_EQ(
      "test.yaml:3: plant/states: expected at most 120 states, inputs and outputs together, "
      "found 200",
      fault(observer(200, 1, "")));
  EXPECT_EQ(
      "test.yaml:3: plant: expected at most 120 states, inputs and outputs together, found "
      "130",
      fault(observer(70, 60, "")));
  EXPECT_EQ(
      "test.yaml:5: gains/P0: expected at most 60 states, inputs and outputs together, found "
      "61",
      fault(kalman(60)));
}

TEST(SizeLimitsTest, SeveralModesShareTheLimit) {
  const std::string mode = ": {A: " + matrix(70, 70, "-1") + "}";
  const std::string text = "observer: ConstantGainObserver\nplant: {states: [" + listed(70, "x") +
                           "], modes: {" + listed(8, "", mode) +
                           "}}\nsensors: {s: {C: " + matrix(1, 70, "1") +
                           ", source: {topic: s}}}\n";
  EXPECT_EQ(
      "test.yaml:2: plant: expected at most 60 states, inputs and outputs together with 8 "
      "modes, found 71",
      fault(text));
  EXPECT_EQ("test.yaml:2: plant/modes: expected at most 100 modes, found 101",
            fault("observer: ConstantGainObserver\nplant: {states: [x], modes: {" +
                  listed(101, "", ": {A: [[-1]]}") + "}}\nsensors: {s: {C: [[1]]}}\n"));
}

TEST(SizeLimitsTest, TooManyNamesOfFormulasAreRefused) {
  EXPECT_EQ("no fault", fault(formulas("definitions: [" + listed(200, "{d", ": \"x\"}") + "], ")));
  EXPECT_EQ("test.yaml:3: plant/definitions: expected at most 200 definitions, found 201",
            fault(formulas("definitions: [" + listed(201, "{d", ": \"x\"}") + "], ")));
  EXPECT_EQ("test.yaml:3: plant/parameters: expected at most 200 parameters, found 201",
            fault(formulas("parameters: {" + listed(201, "p", ": 1") + "}, ")));
}

TEST(SizeLimitsTest, ALongFormulaIsQuotedOnLessThanALine) {
  std::string sum = "-x";
  while (sum.size() < 9000) sum += "+x-x";
  EXPECT_EQ("no fault", fault(formulas("", sum)));
  const std::string unknown = fault(formulas("", sum + "-y"));
  EXPECT_NE(std::string::npos, unknown.find("'-x+x-x+x")) << unknown;
  EXPECT_NE(std::string::npos, unknown.find("(9004 characters): Unexpected token")) << unknown;
  EXPECT_LT(unknown.size(), 300u);
  for (const std::string& long_formula :
       {sum + sum, std::string(9000, 'y'), "x=" + sum, std::string(9000, '(')}) {
    EXPECT_LT(fault(formulas("", long_formula)).size(), 400u) << fault(formulas("", long_formula));
  }
  EXPECT_NE(std::string::npos,
            fault(formulas("", sum + sum)).find("is longer than 10000 characters"));
}

}  // namespace
}  // namespace sampled_data_observers::test
