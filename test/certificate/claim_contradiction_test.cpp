// A claim is about what runs: the gains that the law computes with, outputs that are injected
// included, and the plant that its formulas describe.
#include "config/claim_contradiction.h"

#include <gtest/gtest.h>

#include <fstream>

#include "certificate/certified_gains.h"
#include "config/design_config.h"
#include "support/config_faults.h"

namespace sampled_data_observers::test {
namespace {

const char kNeuron[] = "config/examples/bernard2022_neuron_jump_based/gains.yaml";
const char kInjection[] = "gains: {output_injection: {x1: membrane}}";

/// The message with which a configuration is refused.
std::string refusal(const ConfigNode& tree) {
  return fault_of([&] { read_observer_config(with_own_hash(tree), no_plant_plugins); });
}

std::string refusal(const std::string& file, const std::string& changes) {
  return refusal(CertifiedGains(file).with(changes).tree());
}

void expect_message(const std::string& message, const std::vector<const char*>& parts) {
  EXPECT_EQ("", missing_parts({"", "", parts}, message)) << message;
}

TEST(ClaimTest, StatedErrorMapsThatRestOnAnInjectedOutputNeedIt) {
  expect_message(refusal(kNeuron, "{}"),
                 {"gains/output_injection: expected {x1: membrane}, on which certificate/A rests",
                  "found none"});
  EXPECT_EQ("no fault", refusal(kNeuron, kInjection));
  const ObserverConfig config = CertifiedGains(kNeuron).with(kInjection).config();
  EXPECT_NE("", config.guarantee);
  const ObserverConfig uncertified =
      CertifiedGains(kNeuron).with("allow_uncertified: true").config();
  EXPECT_EQ("", uncertified.guarantee);
  EXPECT_NE(std::string::npos, uncertified.warning.find("gains/output_injection"));
}

TEST(ClaimTest, StatedErrorMapsMustBeThoseOfTheFormulas) {
  expect_message(refusal(CertifiedGains(kNeuron)
                             .with(kInjection)
                             .with("certificate: {A: [[0, -1, 0], [0, -0.03, 0], [0, 0, 0]]}")
                             .tree()),
                 {"certificate/A: expected the map of the error: f(x) - f(x^) = [", "at x = [",
                  "x^ = [", "output_injection: {x1: membrane}", "found A (x - x^) = ["});
  expect_message(refusal(CertifiedGains(kNeuron)
                             .with(kInjection)
                             .with("certificate: {A_d: [[0, 0, 0], [0, 1, 0.9], [0, 0, 1]]}")
                             .tree()),
                 {"certificate/A_d: expected the map of the error: g(x) - g(x^) = [", "at x = ["});
}

const char kUnstable[] = R"yaml(
observer: ConstantGainObserver
plant: {states: [x], A: [[1]]}
sensors: {position: {C: [[1]], source: {topic: position}}}
sampling: {T1: 1, T2: 1}
gains: {L: [[0]]}
certificate:
  theorem: ferrante2016_theorem1
  plant: {file: plant.yaml, hash: none}
  T1: 1
  T2: 1
  A: [[-1]]
  decay: 0.5
  P: [[1]]
)yaml";

TEST(ClaimTest, ACertificateDoesNotReplaceALinearPlant) {
  const ConfigNode tree = read_yaml_text(kUnstable, "unstable.yaml");
  expect_message(refusal(tree), {"unstable.yaml", "certificate/A: expected the map of the error",
                                 "found A (x - x^) = ["});
  const ConfigNode stable = override_with(tree, read_yaml_text("plant: {A: [[-1]]}", "test.yaml"));
  EXPECT_EQ("no fault", refusal(stable));
}

TEST(ClaimTest, ALipschitzConstantMustBeOne) {
  const char kLink[] = "config/examples/ferrante2019_flexible_link/gains.yaml";
  EXPECT_EQ("no fault", refusal(kLink, "{}"));
  expect_message(
      refusal(kLink, "plant: {psi: ['20 * sin(4 * v1)'], lipschitz_constant: 0.1}"),
      {"plant/lipschitz_constant: expected at least |psi(a) - psi(b)| / |a - b|, which is "
       "80",
       "at a = [", "b = [", "found 0.1"});
  // Less than a percent short.
  expect_message(refusal(kLink, "plant: {lipschitz_constant: 3.28}"), {"which is 3.3 at"});
  // It holds nowhere but near the origin.
  expect_message(refusal(kLink, "plant: {psi: ['0.1 * v1^2']}"),
                 {"lipschitz_constant", "min and max"});
  EXPECT_EQ("no fault", refusal(kLink, "plant: {psi: ['0.1 * max(min(v1, 10), -10)^2']}"));
}

TEST(ClaimTest, VerticesMustHoldTheFormulas) {
  const char kDrive[] = "config/examples/etienne2019_dc_drive/gains.yaml";
  EXPECT_EQ("no fault", refusal(kDrive, "{}"));
  expect_message(refusal(kDrive, "plant: {psi: ['1.01 * sin(v1)'], lipschitz_constant: 1.01}"),
                 {"plant/vertices: expected matrices", "in the convex hull", "at x = [", "x^ = [",
                  "found 2 whose hull lacks it"});
  expect_message(refusal(kDrive, "plant: {vertices: {2: [[0, 0, 0], [-1.9, 0, 0], [0, 0, 0]]}}"),
                 {"plant/vertices"});
}

TEST(ClaimTest, TheFlowMustBeInTheHullOfItsVertices) {
  const auto refuted = [](const std::string& change) {
    const ConfigNode tree = override_with(
        read_yaml_text("plant:\n"
                       "  states: [x1, x2]\n"
                       "  inputs: [u]\n"
                       "  flow: {x1: x2, x2: '-(2 + max(-1, min(1, u)))*x1 + 0.1*sin(x2)'}\n"
                       "  jacobian_vertices: {1: [[0, 1], [-1, 0]], 2: [[0, 1], [-3, 0]]}\n"
                       "  G: [[0], [1]]\n"
                       "  S: [[0, 1]]\n"
                       "  lipschitz_constant: 0.1\n"
                       "sensors: {y: {C: [[1, 0]], source: {topic: y}}}\n",
                       "plant.yaml"),
        read_yaml_text(change, "test.yaml"));
    ConfigSection root(tree, "");
    const auto found = refute_lipschitz_claims(*read_plant(root, no_plant_plugins).plant,
                                               Eigen::Vector2d(0.5, 0.0));
    return found ? found->key + ": " + found->expected : std::string("no fault");
  };
  EXPECT_EQ("no fault", refuted("{}"));
  EXPECT_EQ("no fault", refuted("plant: {jacobian_vertices: {3: [[0, 1], [-4, 0]]}}"));
  for (const char* wrong :
       {"plant: {lipschitz_constant: 0.09}", "plant: {jacobian_vertices: {2: [[0, 1], [-2.9, 0]]}}",
        "plant: {jacobian_vertices: {2: [[0, 1.01], [-3, 0]]}}"}) {
    EXPECT_NE(refuted(wrong).find("jacobian_vertices: matrices A_i"), std::string::npos) << wrong;
  }
}

TEST(ClaimTest, EveryKeyOfTheGainsMustBeOneOfTheTheorems) {
  expect_message(refusal("config/examples/bernard2022_switched/gains.yaml",
                         "gains: {projection: {1: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}}"),
                 {"gains/projection: expected only gains that bernard2022_section7_3_2 is about"});
}

/// A ball whose height is measured while it flies, too: L_c of it is none of the theorem's gains.
TEST(ClaimTest, AGainThatTheTheoremDoesNotNameMustBeZero) {
  const auto with_L_c = [](const std::string& L_c) {
    return refusal("config/examples/bernard2022_bouncing_ball/gains.yaml",
                   "sensors: {level: {C: [[1, 0]], measured: continuous, source: {topic: level}}}\n"
                   "gains: {L_c: " +
                       L_c + "}");
  };
  EXPECT_EQ("no fault", with_L_c("[[0], [0]]"));
  expect_message(
      with_L_c("[[0], [1e-9]]"),
      {"test.yaml:2: gains/L_c: expected only gains that bernard2022_corollary5_2 is about",
       "make them again with 'design synthesize'", "allow_uncertified: true",
       "found 'L_c', which changes the observer that it is about"});
}

TEST(ClaimTest, AProofOfTheInverseOutputGainIsForNoGainFromACertificate) {
  const char kInverse[] = "test/certificate/attack/all_outputs/sferlazza2019_equation17.yaml";
  EXPECT_EQ("no fault", refusal(kInverse, "{}"));
  expect_message(refusal(kInverse, "gains: {P: [[1, 0], [0, 1]]}"),
                 {"gains/P: expected only gains that sferlazza2019_equation17 is about"});
}

TEST(ClaimTest, AGainThatIsAFormulaIsNotTheOneThatWasProved) {
  expect_message(refusal("config/examples/bernard2022_switched/gains.yaml",
                         "gains: {L_d: {1: [[1 + 0 * tau], [0], [0]]}}"),
                 {"gains/L_d/1: expected a 3 x 1 matrix of numbers, since "
                  "bernard2022_section7_3_2 is about it",
                  "found a formula"});
}

const char kHighGain[] = R"yaml(
observer: HighGainObserver
plant: {states: [x], A: [[0]], jump_map: {A_d: [[1]]}}
sensors: {level: {C: [[1]], measured: continuous, source: {topic: level}}}
jumps: {topic: jumps}
gains: {form: linear, ell: 1, K: [[1]]}
certificate:
  theorem: bernard2022_example4_2
  plant: {file: plant.yaml, hash: none}
  T1: 1
  T2: 2
  flow_decay: 1
  jump_decay: 0.1
  P: [[1]]
)yaml";

TEST(ClaimTest, AProofForAnObserverWithoutSaturationsIsForNoOther) {
  const ConfigNode tree = read_yaml_text(kHighGain, "high_gain.yaml");
  EXPECT_EQ("no fault", refusal(tree));
  const ConfigNode saturated =
      override_with(tree, read_yaml_text("gains: {saturations: {x: [-1, 1]}}", "test.yaml"));
  expect_message(refusal(saturated), {"gains/saturations: expected only gains that "
                                      "bernard2022_example4_2 is about"});
  const ConfigNode nonlinear =
      override_with(tree, read_yaml_text("gains: {form: original, K: [1], T: [x]}", "test.yaml"));
  expect_message(refusal(nonlinear),
                 {"gains/T: expected only gains that bernard2022_example4_2 is about"});
}

TEST(ClaimTest, AConstantThatIsSmallerThanAJumpMakesOfDistancesIsRefused) {
  const char kLipschitzJump[] = "test/certificate/attack/kicked/bernard2022_corollary4_1.yaml";
  EXPECT_EQ("no fault", refusal(kLipschitzJump, "{}"));
  const ConfigNode tree = CertifiedGains(kLipschitzJump)
                              .with("plant: {jump_map: {lipschitz_constant: 1.0}}")
                              .with_own_hash()
                              .tree();
  expect_message(refusal(tree),
                 {"plant/jump_map/lipschitz_constant", "|g(a) - g(b)| / |a - b|", "found 1"});
}

TEST(ClaimTest, DelayedJumpsLoseTheGuarantee) {
  const ObserverConfig config =
      CertifiedGains("config/examples/bernard2022_bouncing_ball/gains.yaml")
          .with("jumps: {late: delayed}")
          .config();
  EXPECT_EQ("", config.guarantee);
  EXPECT_NE(std::string::npos, config.warning.find("says nothing of jumps/late: delayed"));
}

/// The message with which a design refuses a plant file.
std::string design_refusal(const std::string& plant) {
  const std::string path = ::testing::TempDir() + "claim_plant.yaml";
  std::ofstream(path) << plant;
  return fault_of([&] { read_design_config({path}, no_plant_plugins); });
}

TEST(ClaimTest, DesignsRefuseThemToo) {
  const std::string lipschitz = R"yaml(
plant:
  states: [x, v]
  A: [[0, 1], [0, -1]]
  G: [[0], [1]]
  S: [[1, 0]]
  psi: ["20 * sin(4 * v1)"]
  lipschitz_constant: 0.1
sensors: {position: {C: [[1, 0]], source: {topic: position}}}
)yaml";
  expect_message(design_refusal(lipschitz),
                 {"claim_plant.yaml", "plant/lipschitz_constant", "a = ["});
  EXPECT_EQ("no fault", design_refusal(replaced(lipschitz, "constant: 0.1", "constant: 80")));
  const std::string stated = R"yaml(
plant: {states: [x], A: [[1]]}
sensors: {position: {C: [[1]], source: {topic: position}}}
design: {A: [[-1]]}
)yaml";
  expect_message(design_refusal(stated), {"design/A: expected the map of the error", "x = ["});
}

}  // namespace
}  // namespace sampled_data_observers::test
