#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/config_faults.h"

namespace sampled_data_observers {
namespace {

using test::fault;

const char kLinear[] = R"(
observer: HighGainObserver
plant: {states: [p, v, w], A: [[0, 1, 0], [0, 0, 0], [0, 0, -1]]}
sensors:
  a: {C: [[1, 0, 0]], measured: continuous, source: {topic: a}}
  b: {C: [[0, 0, 1]], measured: continuous, source: {topic: b}}
sampling: {T1: 0.01, T2: 0.01}
gains: {form: linear, ell: 2, K: [[2, 3], [1]], saturations: {v: [-5, 5]}}
)";

const char kTransformed[] = R"(
observer: HighGainObserver
plant:
  states: [x1, x2]
  inputs: [u]
  parameters: {k: 2}
  flow: {x1: x2, x2: -k*x1^3 + u}
sensors: {y: {h: [x1], measured: continuous, source: {topic: y}}}
sampling: {T1: 0.01, T2: 0.01}
gains:
  form: transformed
  ell: 3
  K: [2, 1]
  T: [x1, x2]
  definitions: [{cube: z1^3}]
  Theta: {x1: z1, x2: z2 + 0*cube}
  Phi: -k*cube + u + 0*x2
  saturations: {x1: [-2, 2]}
)";

const char kOriginal[] = R"(
observer: HighGainObserver
plant:
  states: [x1, x2]
  flow: {x1: x2, x2: -x1^3}
sensors: {y: {h: [x1], measured: continuous, source: {topic: y}}}
sampling: {T1: 0.01, T2: 0.01}
gains: {form: original, ell: 3, K: [2, 1], T: [x1, x2], damping: 0.01}
)";

const char kSwitchedOriginal[] = R"(
observer: HighGainObserver
plant:
  states: [x1, x2]
  modes:
    1: {flow: {x1: x2, x2: -x1^3}}
    4: {flow: {x1: x2, x2: -x1}}
sensors: {y: {h: [x1], measured: continuous, source: {topic: y}}}
sampling: {T1: 0.01, T2: 0.01}
gains:
  form: original
  ell: 3
  modes:
    1: {K: [2, 1], T: [x1, x2]}
    4: {K: [3, 2], T: [x1, x2]}
)";

struct FaultyText {
  const char* text;
  test::Fault change;
};

class BadHighGainTest : public ::testing::TestWithParam<FaultyText> {};

TEST_P(BadHighGainTest, IsRefusedWithAMessageThatHelps) {
  const std::string text = GetParam().text;
  const test::Fault& change = GetParam().change;
  EXPECT_EQ("no fault", fault(text));
  const std::string found = fault(test::replaced(text, change.from, change.to));
  EXPECT_EQ("", test::missing_parts(change, found)) << found;
}

INSTANTIATE_TEST_SUITE_P(
    Faults, BadHighGainTest,
    ::testing::Values(
        FaultyText{kLinear,
                   {"form: linear", "form: quadratic", {"gains/form", "linear, transformed"}}},
        FaultyText{kLinear, {"ell: 2", "ell: -2", {"gains", "ell must be positive"}}},
        FaultyText{kLinear, {"ell: 2, ", "", {"gains/ell", "missing"}}},
        FaultyText{kLinear,
                   {"[[2, 3], [1]]", "[[2, 3], 1]", {"gains/K", "list of such lists", "'1'"}}},
        FaultyText{kLinear, {"[[2, 3], [1]]", "[[2, 3], [x]]", {"gains/K", "'x'"}}},
        FaultyText{kLinear,
                   {"[[2, 3], [1]]", "[2, 3]", {"gains", "one list per continuous output"}}},
        FaultyText{kLinear,
                   {"[[2, 3], [1]]", "[[2], [1]]", {"K of continuous output 1", "2 numbers"}}},
        FaultyText{kLinear, {"[[2, 3], [1]]", "[[2, 3], [-1]]", {"output 2", "not Hurwitz"}}},
        FaultyText{kLinear, {"[[0, 0, 1]]", "[[0, 1, 0]]", {"not observable", "2 of 3"}}},
        FaultyText{kLinear,
                   {"{v: [-5, 5]}", "{v: [5, -5]}", {"gains/saturations/v", "lower bound"}}},
        FaultyText{kLinear,
                   {"{v: [-5, 5]}", "{v: [5]}", {"gains/saturations/v", "2 finite numbers"}}},
        FaultyText{kLinear, {"{v: [-5, 5]}", "{u: [-5, 5]}", {"gains/saturations/u", "unknown"}}},
        FaultyText{kLinear, {"form: linear", "form: linear, T: [p]", {"gains/T", "unknown"}}},
        FaultyText{kLinear,
                   {"measured: continuous, source: {topic: a}", "source: {topic: a}", {"sampled"}}},
        FaultyText{kTransformed, {"K: [2, 1]", "K: [2, 1, 1]", {"gains/K", "2 finite numbers"}}},
        FaultyText{kTransformed, {"K: [2, 1]", "K: [2, -1]", {"gains", "not Hurwitz"}}},
        FaultyText{kTransformed, {"T: [x1, x2]", "T: [x1, z2]", {"gains/T", "z2"}}},
        FaultyText{kTransformed, {"T: [x1, x2]", "T: [x1, x2 + u]", {"gains/T", "u"}}},
        FaultyText{kTransformed, {"Theta: {x1: z1, ", "Theta: {", {"gains/Theta/x1", "missing"}}},
        FaultyText{kTransformed, {"{x1: z1, x2", "{x1: x1, x2", {"gains/Theta", "x1"}}},
        FaultyText{kTransformed, {"Phi: -k*cube", "Phi: -k*z3", {"gains/Phi", "z3"}}},
        FaultyText{kTransformed, {"[{cube: z1^3}]", "[{x2: z1^3}]", {"gains/definitions", "'x2'"}}},
        FaultyText{kTransformed, {"[{cube: z1^3}]", "[{cube: x1^3}]", {"gains/definitions", "x1"}}},
        FaultyText{kTransformed, {"{k: 2}", "{k: 2, z2: 1}", {"gains/form", "'z2'"}}},
        FaultyText{kTransformed, {"form: transformed", "form: original", {"gains/definitions"}}},
        FaultyText{kOriginal, {"damping: 0.01", "damping: -1", {"gains", "damping: a number"}}},
        FaultyText{kLinear,
                   {"form: linear", "form: linear, damping: 1", {"gains/damping", "unknown"}}},
        FaultyText{kOriginal, {"[x1, x2], damping", "[x1, x2, 0], damping", {"gains/K", "3"}}},
        FaultyText{kSwitchedOriginal,
                   {"4: {K: [3, 2], T: [x1, x2]}", "", {"gains/modes/4", "missing"}}},
        FaultyText{kSwitchedOriginal,
                   {"4: {K: [3, 2]", "4: {ell: 3, K: [3, 2]", {"gains/modes/4/ell", "unknown"}}},
        FaultyText{kSwitchedOriginal,
                   {"    4: {K",
                    "    2: {K: [2, 1], T: [x1, x2]}\n    4: {K",
                    {"gains/modes/2", "unknown"}}},
        FaultyText{kSwitchedOriginal, {"ell: 3", "ell: 3\n  K: [2, 1]", {"gains/K", "unknown"}}},
        FaultyText{kTransformed, {"h: [x1]", "h: [x1, x2]", {"gains/Phi", "2"}}},
        FaultyText{kOriginal,
                   {"K: [2, 1], T: [x1, x2]", "K: [2], T: [x1, x2]", {"gains/K", "2 finite"}}}));

}  // namespace
}  // namespace sampled_data_observers
