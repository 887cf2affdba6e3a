// Steps of integration belong to the claim: a proof is about the flow, and the observer computes
// with Runge-Kutta steps.
#include <gtest/gtest.h>

#include "config/plant_fingerprint.h"
#include "support/config_faults.h"
#include "support/law_runner.h"

namespace sampled_data_observers::test {
namespace {

/// A stiff Lipschitz plant, whose fast state follows the slow one within 0.3 ms.
const char kStiff[] = R"yaml(
observer: SampleAndHoldObserver
plant:
  states: [x, z]
  A: [[-1, 0], [3333, -3333]]
  G: [[1], [0]]
  S: [[1, 0]]
  psi: ["0.1 * sin(v1)"]
  lipschitz_constant: 0.1
  integration: {step: 0.001}
sensors: {position: {C: [[1, 0]], source: {topic: position}}}
sampling: {T1: 0.01, T2: 0.05}
gains: {L: [[0], [0]]}
)yaml";

/// That the conditions do not hold is of no matter: steps are looked at before them.
const char kCertificate[] = R"yaml(
certificate:
  theorem: etienne2019_proposition1
  plant: {file: plant.yaml, hash: none}
  T1: 0.01
  T2: 0.05
  alpha: 0.1
  P: [[1, 0], [0, 1]]
  X: [[1, 0], [0, 1]]
  Y: [[1, 0], [0, 1]]
  G: [[1, 0], [0, 1]]
)yaml";

std::string with_step(const std::string& text, const char* step) {
  return replaced(text, "step: 0.001", std::string("step: ") + step);
}

TEST(IntegrationCheckTest, StepsThatLetADecayingModeGrowAreRefused) {
  const std::string message = fault(kStiff);
  const Fault parts{"",
                    "",
                    {"test.yaml", "plant/integration/step: expected at most 0.00075 s",
                     "a mode of the rate 3.33e+03 1/s grow, which decays", "found 0.001 s"}};
  EXPECT_EQ("", missing_parts(parts, message)) << message;
  // The edge lies at 2.785 / 3333 s.
  EXPECT_EQ("no fault", fault(with_step(kStiff, "0.00083")));
  EXPECT_NE("no fault", fault(with_step(kStiff, "0.00084")));
}

double z_after_a_second(const std::string& text) {
  LawRunner runner(parse(text).law);
  runner.flow(kNanosecondsPerSecond);
  return runner.estimate()(1);
}

TEST(IntegrationCheckTest, WhatIsAcceptedDecaysAsTheFlowDoes) {
  const std::string start = std::string(kStiff) + "initial_estimate: {x: 0, z: 1}\n";
  EXPECT_NEAR(0.0, z_after_a_second(with_step(start, "0.00075")), 1e-9);
}

TEST(IntegrationCheckTest, ACertificateAsksForAccurateSteps) {
  const std::string vertices =
      replaced(kStiff, "lipschitz_constant: 0.1",
               "lipschitz_constant: 0.1\n"
               "  vertices: {1: [[0.1, 0], [0, 0]], 2: [[-0.1, 0], [0, 0]]}");
  const auto message_for = [&](const char* step) {
    ConfigNode tree =
        read_yaml_text(with_step(vertices, step) + std::string(kCertificate), "test.yaml");
    tree = override_with(
        tree, read_yaml_text("certificate: {plant: {hash: " + plant_fingerprint(tree) + "}}",
                             "hash.yaml"));
    return fault_of([&] { read_observer_config(tree, no_plant_plugins); });
  };
  const std::string message = message_for("0.0005");
  const Fault parts{"",
                    "",
                    {"test.yaml",
                     "plant/integration/step: expected at most 3e-05 s: the "
                     "certificate is about the flow itself",
                     "found 0.0005 s", "allow_uncertified"}};
  EXPECT_EQ("", missing_parts(parts, message)) << message;
  // Only the conditions are in the way then.
  EXPECT_NE(std::string::npos, message_for("0.00002").find("etienne2019"));
  EXPECT_EQ(std::string::npos, message_for("0.00002").find("integration"));
}

TEST(IntegrationCheckTest, UnitsOfStatesDoNotMatter) {
  // The fast state a thousand times as large, or as small.
  for (const char* coupling : {"3333000", "3.333"}) {
    const std::string message =
        fault(replaced(kStiff, "[3333, -3333]]", std::string("[") + coupling + ", -3333]]"));
    EXPECT_NE(std::string::npos, message.find("at most 0.00075 s")) << message;
  }
}

TEST(IntegrationCheckTest, InjectedGainsCountAsThePlantDoes) {
  const std::string fast = R"yaml(
observer: IntersampleInjectionObserver
plant:
  states: [x]
  flow: {x: "-sin(x)"}
  integration: {step: 0.01}
sensors: {position: {C: [[1]], source: {topic: position}}}
sampling: {T1: 0.1, T2: 0.2}
gains: {L: [[400]], H: [[-400]]}
)yaml";
  const std::string message = fault(fast);
  EXPECT_NE(std::string::npos, message.find("plant/integration/step: expected at most 0.0062 s"))
      << message;
  EXPECT_EQ("no fault", fault(replaced(fast, "step: 0.01", "step: 0.006")));
}

TEST(IntegrationCheckTest, ExactFlowsTakeAnyStep) {
  const std::string linear =
      replaced(replaced(replaced(replaced(kStiff, "  G: [[1], [0]]\n", ""), "  S: [[1, 0]]\n", ""),
                        "  psi: [\"0.1 * sin(v1)\"]\n", ""),
               "  lipschitz_constant: 0.1\n", "");
  EXPECT_EQ("no fault", fault(linear));
}

}  // namespace
}  // namespace sampled_data_observers::test
