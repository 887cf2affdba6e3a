#include "sampled_data_observers/config/plant_config.h"

#include <gtest/gtest.h>

#include <cmath>

#include "plant/lipschitz_map.h"
#include "support/config_faults.h"
#include "support/law_runner.h"

namespace sampled_data_observers {
namespace {

using test::Fault;
using test::fault;
using test::parse;
using test::replaced;

const char kFormulas[] = R"yaml(
observer: ConstantGainObserver
plant:
  states: [x1, x2]
  inputs: [u]
  parameters: {a: 0.5, I: 10}
  definitions: [{square: "x1^2"}, {twice: "2*square"}]
  flow: {x1: "twice + x2 + I", x2: "a*(u - x2)"}
  jump_map: {formulas: {x1: "-x1", x2: "x2 + a"}}
  integration: {step: 0.002, horizon: 5}
sensors:
  s: {h: ["x1*x2", "cos(x1)"], source: {topic: s}}
sampling: {T1: 0.1, T2: 1}
gains: {L: [[0.1, 0], [0, 0.1]]}
)yaml";

const char kLipschitz[] = R"yaml(
observer: SampleAndHoldObserver
plant:
  states: [x1, x2, x3]
  inputs: [u]
  A: [[0, 1, 0], [0, -3, 1], [0, -1, -1]]
  B: [[0], [0], [1]]
  G: [[0], [-2], [0]]
  S: [[1, 0, 0]]
  psi: ["sin(v1)"]
  lipschitz_constant: 1
  vertices: {1: [[0, 0, 0], [2, 0, 0], [0, 0, 0]], 2: [[0, 0, 0], [-2, 0, 0], [0, 0, 0]]}
sensors: {s: {C: [[1, 0, 0]], source: {topic: s}}}
sampling: {T1: 0.1, T2: 0.4}
gains: {L: [[-2.2], [0.16], [0.45]]}
)yaml";

const char kSwitched[] = R"(
observer: SynchronizedObserver
plant:
  states: [x]
  modes:
    7: {A: [[-2]], outputs: {d: {C: [[3]]}}}
    2: {A: [[-1]], jump_map: {A_d: [[0.5]]}}
sensors: {d: {C: [[1]], measured: at_jumps}}
jumps: {topic: switches, late: delayed, min_separation: 0.01, max_per_second: 20}
sampling: {T1: 0.1, T2: 1}
gains: {L_d: [[0.25]]}
)";

const char kJumpSets[] = R"(
observer: SynchronizedObserver
plant:
  states: [x, v]
  jump_map: {A_d: [[1, 0], [0, -0.8]]}
  A: [[0, 1], [0, 0]]
  jump_set: [x, v]
  flow_set: [-x]
sensors: {d: {C: [[1, 0]], measured: at_jumps}}
jumps: {gate: {margin: [0.1, 1], recovery: {after: 2}}, missing: {margin: 0.2, action: predict}}
sampling: {T1: 0.1, T2: 1}
gains: {L_d: [[0.25], [0]]}
)";

Eigen::VectorXd evaluate(const VectorMap& map, const Eigen::VectorXd& x, const Eigen::VectorXd& u) {
  Eigen::VectorXd out(map.size());
  map.evaluate(x.data(), u.data(), out.data());
  return out;
}

TEST(PlantConfigTest, ReadsAPlantByFormulas) {
  const ObserverConfig config = parse(kFormulas);
  const Plant& plant = *config.plant;
  EXPECT_FALSE(plant.is_affine());
  EXPECT_EQ(2000000, plant.integration().step);
  EXPECT_EQ(5 * kNanosecondsPerSecond, plant.integration().horizon);
  const PlantMode& mode = plant.modes().front();
  const Eigen::Vector2d x(3.0, 2.0);
  const Eigen::VectorXd u = Eigen::VectorXd::Constant(1, 4.0);
  EXPECT_EQ(Eigen::Vector2d(30.0, 1.0), evaluate(*mode.flow, x, u));
  EXPECT_EQ(Eigen::Vector2d(-3.0, 2.5), evaluate(*mode.jump, x, u));
  EXPECT_EQ(Eigen::Vector2d(6.0, std::cos(3.0)), evaluate(*mode.outputs[0], x, u));
}

const char kAngles[] = R"(
observer: ConstantGainObserver
plant: {states: [p, yaw], A: [[0, 0], [0, 0]]}
sensors:
  a: {C: [[1, 0], [0, 1]], source: {topic: a, type: nav_msgs/Odometry,
      fields: [pose.pose.position.x, pose.pose.orientation.yaw]}}
sampling: {T1: 0.1, T2: 0.2}
gains: {L: [[0.5, 0], [0, 0.5]]}
)";

TEST(PlantConfigTest, AnglesOfOrientationsAreAngularUnlessSaidOtherwise) {
  const auto angular = [](const std::string& text) {
    return parse(text).plant->sensors()[0].angular;
  };
  EXPECT_EQ((std::vector<bool>{false, true}), angular(kAngles));
  const std::vector<bool> none = {false, false};
  EXPECT_EQ(none, angular(replaced(kAngles, "[0, 1]], source",
                                   "[0, 1]], angular: [false, false], source")));
  EXPECT_EQ(none, angular(replaced(kAngles, "topic: a", "topic: a, scale: [1, 57.3]")));
  EXPECT_EQ(none, angular(replaced(replaced(kAngles, "nav_msgs/Odometry", "sensor_msgs/JointState"),
                                   "[pose.pose.position.x, pose.pose.orientation.yaw]",
                                   "[position.pitch, position.yaw]")));
}

TEST(PlantConfigTest, UnitsAreOfStatesInputsAndOutputs) {
  const ObserverConfig plain = parse(kFormulas);
  EXPECT_TRUE(plain.units.empty());
  const std::string units = "  units: {x1: mV, u: A, s: V}\n  integration:";
  const ObserverConfig config = parse(replaced(kFormulas, "  integration:", units));
  EXPECT_EQ((Units{{"s", "V"}, {"u", "A"}, {"x1", "mV"}}), config.units);
}

TEST(PlantConfigTest, AffineOutputsAreSuchHoweverTheyAreWritten) {
  const auto output = [](const std::string& keys) {
    return parse(replaced(kAngles, "C: [[1, 0], [0, 1]]", keys)).plant->modes()[0].outputs[0];
  };
  for (const char* keys :
       {"C: [[0, -11.9], [1, 0]], d: [101325, 0]", "h: [101325 - 11.9*yaw, p]"}) {
    const std::shared_ptr<const VectorMap> found = output(keys);
    const AffineMap* map = found->affine();
    ASSERT_NE(nullptr, map) << keys;
    EXPECT_EQ(-11.9, map->M()(0, 1));
    EXPECT_EQ(Eigen::Vector2d(101325.0, 0.0), map->c());
    const double x[] = {2.0, 100.0};
    double y[2];
    map->evaluate(x, nullptr, y);
    EXPECT_DOUBLE_EQ(101325.0 - 1190.0, y[0]);
  }
  EXPECT_EQ(nullptr, output("h: [p*yaw, p]")->affine());
  EXPECT_NE(std::string::npos,
            fault(replaced(kAngles, "C: [[1, 0], [0, 1]]", "C: [[1, 0], [0, 1]], d: [1]"))
                .find("sensors/a/d: expected a list of 2"));
  EXPECT_NE(std::string::npos,
            fault(replaced(kAngles, "C: [[1, 0], [0, 1]]", "h: [p, yaw], d: [1, 2]"))
                .find("sensors/a/d: expected the key C beside it"));
}

TEST(PlantConfigTest, AFilterTakesAnOutputByAnAffineFormula) {
  const ObserverConfig config = parse(R"(
observer: HybridKalmanFilter
plant: {states: [z], A: [[0]]}
sensors: {pressure: {h: [101325 - 11.9*z], source: {topic: pressure}}}
sampling: {T1: 0.1, T2: 0.2}
gains: {P0: [[100]], Q: [[0]], R: {pressure: [[1e-6]]}}
)");
  test::LawRunner runner(config.law);
  runner.sample(0, {101325.0 - 11.9 * 8.0});
  EXPECT_NEAR(8.0, runner.state()(0), 1e-6);
}

TEST(PlantConfigTest, ReadsALipschitzPlantWithItsVertices) {
  const ObserverConfig config = parse(kLipschitz);
  const auto map =
      std::dynamic_pointer_cast<const LipschitzMap>(config.plant->modes().front().flow);
  ASSERT_TRUE(map);
  EXPECT_EQ(1.0, *map->description().lipschitz_constant);
  ASSERT_EQ(2u, map->description().vertices.size());
  EXPECT_EQ(-2.0, map->description().vertices[1](1, 0));
  const Eigen::VectorXd out =
      evaluate(*map, Eigen::Vector3d(0.5, 1.0, 2.0), Eigen::VectorXd::Constant(1, 7.0));
  EXPECT_LT((Eigen::Vector3d(1.0, -1.0 - 2.0 * std::sin(0.5), 4.0) - out).norm(), 1e-15);
}

TEST(PlantConfigTest, ReadsAnAffineFlow) {
  const ObserverConfig config =
      parse(replaced(kLipschitz,
                     "  G: [[0], [-2], [0]]\n  S: [[1, 0, 0]]\n  psi: [\"sin(v1)\"]\n"
                     "  lipschitz_constant: 1\n  vertices: {1: [[0, 0, 0], [2, 0, 0], [0, 0, 0]], "
                     "2: [[0, 0, 0], [-2, 0, 0], [0, 0, 0]]}\n",
                     "  b: [0, -9.81, 0]\n"));
  EXPECT_TRUE(config.plant->is_affine());
  EXPECT_EQ(-9.81, config.plant->modes().front().flow->affine()->c()(1));
}

TEST(PlantConfigTest, ReadsASwitchedPlantAndHowItsJumpsCome) {
  const ObserverConfig config = parse(kSwitched);
  ASSERT_EQ(2u, config.plant->modes().size());
  EXPECT_EQ(2, config.plant->modes()[0].label);  // modes are in the order of their labels
  EXPECT_EQ(7, config.plant->modes()[1].label);
  EXPECT_EQ(1.0, config.plant->modes()[0].outputs[0]->affine()->M()(0, 0));
  EXPECT_EQ(3.0, config.plant->modes()[1].outputs[0]->affine()->M()(0, 0));
  EXPECT_TRUE(config.law->delays_jumps());
  EXPECT_EQ("switches", config.jumps->topic);
  EXPECT_TRUE(config.jumps->has_mode);
  EXPECT_EQ(1u, config.jumps->size);
  EXPECT_FALSE(config.sensors[0]);
  test::LawRunner runner(parse(replaced(kSwitched, "late: delayed, ", "")).law);
  EXPECT_TRUE(runner.jump({4.0}, 7.0));
  EXPECT_EQ(1.0, runner.estimate()(0));  // 0.5 * 0 + 0.25 * (4 - 1 * 0), then in mode 7
  runner.flow(kNanosecondsPerSecond);
  EXPECT_NEAR(std::exp(-2.0), runner.estimate()(0), 1e-15);
  EXPECT_TRUE(runner.jump({4.0}, 2.0));
  EXPECT_NEAR(std::exp(-2.0) + 0.25 * (4.0 - 3.0 * std::exp(-2.0)), runner.estimate()(0), 1e-14);
}

struct BadPlant {
  const char* good;
  Fault fault;
};

class BadPlantTest : public ::testing::TestWithParam<BadPlant> {};

TEST_P(BadPlantTest, IsRefusedWithAMessageThatHelps) {
  const Fault& change = GetParam().fault;
  const std::string found = fault(replaced(GetParam().good, change.from, change.to));
  EXPECT_EQ("", test::missing_parts(change, found)) << found;
}

INSTANTIATE_TEST_SUITE_P(
    Faults, BadPlantTest,
    ::testing::Values(
        BadPlant{kFormulas,
                 {"  integration:",
                  "  units: {x3: m}\n  integration:",
                  {"test.yaml:10", "plant/units/x3", "a state, an input or a sensor", "'x3'"}}},
        BadPlant{
            kFormulas,
            {"  integration:", "  units: {x1: [m]}\n  integration:", {"plant/units/x1", "a text"}}},
        BadPlant{kFormulas,
                 {"  integration:",
                  "  unit_norm: [x1, x2]\n  integration:",
                  {"plant/unit_norm", "list of lists"}}},
        BadPlant{kFormulas,
                 {"  integration:",
                  "  unit_norm: [[x1]]\n  integration:",
                  {"plant/unit_norm", "at least two", "found 1"}}},
        BadPlant{kFormulas,
                 {"  integration:",
                  "  unit_norm: [[x1, u]]\n  integration:",
                  {"test.yaml:10", "plant/unit_norm", "names of states", "'u'"}}},
        BadPlant{kFormulas,
                 {"  integration:",
                  "  unit_norm: [[x1, x2, x1]]\n  integration:",
                  {"plant/unit_norm", "'x1' twice"}}},
        BadPlant{kJumpSets,
                 {"  jump_set:",
                  "  unit_norm: [[x, v]]\n  jump_set:",
                  {"plant/unit_norm", "linear", "formulas"}}},
        BadPlant{kFormulas, {"a*(u - x2)", "a*(u - x2", {"test.yaml:8", "plant/flow", "x2"}}},
        BadPlant{kFormulas, {"a*(u - x2)", "a*(w - x2)", {"plant/flow", "w", "may use x1 x2 u"}}},
        BadPlant{kFormulas, {", x2: \"a*(u - x2)\"", "", {"plant/flow/x2", "missing"}}},
        BadPlant{kFormulas, {"flow: {", "flow: {x3: 1, ", {"plant/flow/x3", "unknown"}}},
        BadPlant{kFormulas, {"\"x1^2\"", "\"y^2\"", {"plant/definitions", "square", "y"}}},
        BadPlant{kFormulas, {"a: 0.5", "a: half", {"plant/parameters/a", "'half'"}}},
        BadPlant{kFormulas,
                 {"states: [x1, x2]", "states: [x1, \"x 2\"]", {"plant/definitions", "'x 2'"}}},
        BadPlant{kFormulas, {"x2: \"x2 + a\"", "x2: \"x2 = a\"", {"jump_map/formulas", "assigns"}}},
        BadPlant{kFormulas, {"\"cos(x1)\"", "\"cos(x1\"", {"sensors/s/h", "2:"}}},
        BadPlant{kFormulas, {"step: 0.002", "step: 0", {"plant/integration/step", "found 0"}}},
        BadPlant{kFormulas, {"horizon: 5", "horizon: 0.001", {"integration/horizon", "0.001"}}},
        BadPlant{kFormulas, {"flow: {", "plugin: a/B\n  flow: {", {"plant/plugin", "a/B"}}},
        BadPlant{
            kFormulas,
            {"flow: {", "jacobian_vertices: {}\n  flow: {", {"jacobian_vertices", "one n x n"}}},
        BadPlant{kFormulas,
                 {"flow: {",
                  "jacobian_vertices: {1: [[0, 1]]}\n  flow: {",
                  {"plant/jacobian_vertices/1", "2 x 2"}}},
        BadPlant{kFormulas,
                 {"flow: {",
                  "jacobian_vertices: {1: [[0, 1], [1, 0]]}\n  G: [[0], [1]]\n  flow: {",
                  {"plant/S", "missing"}}},
        BadPlant{kFormulas, {"flow: {", "G: [[0], [1]]\n  flow: {", {"plant/G", "unknown"}}},
        BadPlant{kFormulas, {"h: [", "measured: always, h: [", {"sensors/s/measured", "'always'"}}},
        BadPlant{kFormulas,
                 {"h: [", "measured: continuous, h: [", {"gains/L", "measured: sampled"}}},
        BadPlant{kLipschitz, {"psi: [\"sin(v1)\"]", "psi: [\"sin(v2)\"]", {"plant/psi", "v1"}}},
        BadPlant{kLipschitz, {"psi: [\"sin(v1)\"]", "psi: []", {"plant/psi", "at least one"}}},
        BadPlant{kLipschitz, {"G: [[0], [-2], [0]]", "G: [[0], [-2]]", {"plant/G", "3 x 1"}}},
        BadPlant{kLipschitz, {"S: [[1, 0, 0]]", "S: [[1, 0]]", {"plant/S", "m x 3"}}},
        BadPlant{kLipschitz,
                 {"lipschitz_constant: 1", "lipschitz_constant: 0", {"lipschitz_constant"}}},
        BadPlant{kSwitched, {"7: {A", "seven: {A", {"plant/modes", "whole number", "'seven'"}}},
        BadPlant{kSwitched, {"{C: [[3]]}", "{C: [[3], [4]]}", {"modes/7/outputs", "1 outputs"}}},
        BadPlant{kSwitched, {"outputs: {d:", "outputs: {e:", {"plant/modes/7/outputs/e"}}},
        BadPlant{kSwitched, {"late: delayed", "late: never", {"jumps/late", "rewind, delayed"}}},
        BadPlant{kSwitched, {"max_per_second: 20", "max_per_second: 0", {"jumps/max_per_second"}}},
        BadPlant{kSwitched, {"max_per_second: 20", "stamp_error: -1", {"jumps/stamp_error"}}},
        BadPlant{kSwitched, {"jumps: {", "jumps: {topc: x, ", {"jumps/topc", "unknown"}}},
        BadPlant{kSwitched,
                 {"jumps: {",
                  "jumps: {gate: {margin: 1, recovery: {after: 1}}, ",
                  {"jumps/gate/margin", "plant/jump_set"}}},
        BadPlant{kFormulas, {"flow: {", "jump_set: [x3]\n  flow: {", {"plant/jump_set", "x3"}}},
        BadPlant{kJumpSets, {"[0.1, 1]", "[0.1]", {"jumps/gate/margin", "list of 2"}}},
        BadPlant{kJumpSets, {"[0.1, 1]", "[0.1, -1]", {"jumps/gate/margin", "negative"}}},
        BadPlant{kJumpSets, {", recovery: {after: 2}", "", {"jumps/gate/recovery"}}},
        BadPlant{kJumpSets, {"flow_set: [-x]\n", "\n", {"jumps/missing/margin", "plant/flow_set"}}},
        BadPlant{kJumpSets, {"predict", "guess", {"jumps/missing/action", "report, predict"}}},
        BadPlant{kJumpSets,
                 {"jumps: {", "jumps: {late: delayed, ", {"jumps/missing/action", "delayed"}}},
        BadPlant{kJumpSets,
                 {"jump_map: {A_d: [[1, 0], [0, -0.8]]}\n  A: [[0, 1], [0, 0]]",
                  "modes: {1: {A: [[0, 1], [0, 0]]}, 2: {A: [[0, 0], [0, 0]]}}",
                  {"jumps/missing/action", "switches"}}},
        BadPlant{kSwitched, {"gains: {L_d: [[0.25]]}", "gains: {}", {"gains", "L_c, L_d or both"}}},
        BadPlant{kSwitched,
                 {"measured: at_jumps", "measured: continuous", {"sensors/d/source", "missing"}}}));

}  // namespace
}  // namespace sampled_data_observers
