// What a configuration with a certificate must be, to be accepted: the gains and the plant that the
// proof is about, in the times that it is about.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "certificate/certified_gains.h"
#include "config/dwell_times.h"
#include "linear_algebra/matrix_functions.h"
#include "support/law_runner.h"

namespace sampled_data_observers::test {
namespace {

const char kGains[] = "test/certificate/ferrante2019_oscillator_0.2.yaml";
const char kAssumptions[] = "{initial_error: 1, noise: 0.1, disturbance: 0.5}";

double initial_bound(const ObserverConfig& config) {
  Eigen::VectorXd state(config.law->state_size());
  config.law->initialize(state.data());
  return config.law->error_bound(state.data());
}

/// A bound is rounded to the safe side.
void expect_bound(double expected, double found) {
  EXPECT_GE(found, expected * (1.0 - 1e-14));
  EXPECT_LE(found, expected * (1.0 + 1e-8));
}

/// The message with which a configuration is refused.
std::string refusal_of(const CertifiedGains& gains) {
  try {
    gains.config();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no fault";
}

void expect_parts(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) {
    EXPECT_NE(std::string::npos, message.find(part)) << part << "\nis not in\n" << message;
  }
}

TEST(CertifiedConfigTest, AcceptsWhatIsProvedAndBoundsTheErrorWhereAsked) {
  const ObserverConfig plain = CertifiedGains(kGains).config();
  expect_parts(plain.guarantee,
               {"ferrante2019_theorem2: ", "(lambda_t = 0.3, gamma = 2.75, T2 = 0.2 s)",
                "; proved in ball arithmetic"});
  EXPECT_EQ("", plain.warning);
  EXPECT_TRUE(plain.warnings.empty());
  EXPECT_TRUE(std::isnan(initial_bound(plain)));
  const ObserverConfig bounded = CertifiedGains(kGains).assuming(kAssumptions).config();
  EXPECT_GT(initial_bound(bounded), 1.0);
  EXPECT_LT(initial_bound(bounded), 10.0);
}

TEST(CertifiedConfigTest, SaysProvedOnlyOfTheNumbersThatWere) {
  // Each is inside of what holds, and another claim than the one that was proved.
  for (const char* change :
       {"gains: {H: [[-0.95264]]}", "certificate: {T1: 0.0101}", "certificate: {gamma: 2.76}",
        "certificate: {P2: [[2.8203]]}", "certificate: {proof_hash: 0}"}) {
    const ObserverConfig config = CertifiedGains(kGains).with(change).config();
    expect_parts(config.guarantee, {"; checked in floating point, not proved"});
    EXPECT_EQ("", config.warning) << change;
    ASSERT_EQ(1u, config.warnings.size()) << change;
    expect_parts(config.warnings.front(),
                 {"ferrante2019_oscillator_0.2.yaml", "design verify GAINS --rigorous --record"});
  }
}

TEST(CertifiedConfigTest, SaysWhatItsErrorBoundsDoNotCover) {
  const std::string exact = CertifiedGains(kGains).assuming(kAssumptions).config().guarantee;
  EXPECT_EQ(std::string::npos, exact.find("; an error bound holds if"));
  EXPECT_EQ(std::string::npos, exact.find("integration"));
  expect_parts(
      CertifiedGains("config/examples/bernard2022_impulsive/gains.yaml")
          .assuming("{initial_error: 1, noise: 0}")
          .config()
          .guarantee,
      {"; an error bound holds if no input or jump of before its stamp is still on its way"});
  const std::string latent = CertifiedGains("config/examples/bernard2022_impulsive/gains.yaml")
                                 .assuming("{initial_error: 1, noise: 0, latency: 0.1}")
                                 .config()
                                 .guarantee;
  EXPECT_EQ(std::string::npos, latent.find("; an error bound holds if"));
  expect_parts(CertifiedGains("config/examples/etienne2019_dc_drive/gains.yaml")
                   .assuming("{initial_error: 1, noise: 0.1}")
                   .config()
                   .guarantee,
               {"the error of integration, in steps of 0.001 s", "no part of the bound"});
}

TEST(CertifiedConfigTest, WithoutCertificateNothingIsGuaranteed) {
  const char kUncertified[] = R"(
observer: ConstantGainObserver
plant: {states: [p], A: [[0]]}
sensors: {position: {C: [[1]], source: {topic: position}}}
sampling: {T1: 0.1, T2: 0.2}
gains: {L: [[0.5]]}
)";
  const auto config =
      read_observer_config(read_yaml_text(kUncertified, "a.yaml"), no_plant_plugins);
  EXPECT_EQ("", config.guarantee);
  EXPECT_EQ("", config.warning);
  EXPECT_TRUE(std::isnan(initial_bound(config)));
  try {
    read_observer_config(read_yaml_text(std::string(kUncertified) +
                                            "error_assumptions: {initial_error: 1, noise: 0}",
                                        "a.yaml"),
                         no_plant_plugins);
    FAIL();
  } catch (const ConfigError& error) {
    expect_parts(error.what(), {"a.yaml:7: error_assumptions", "certificate", "none"});
  }
}

TEST(CertifiedConfigTest, BoundsTheErrorAsTheTheoremsProofDoes) {
  const Certificate certificate = CertifiedGains(kGains).certificate();
  const Eigen::MatrixXd P1 = certificate.values.at("P1");
  const Eigen::VectorXd eigenvalues = symmetric_eigenvalues(P1);
  const double omega_2 =
      certificate.values.at("P2")(0, 0) * std::exp(scalar_value(certificate.values, "delta") * 0.2);
  const double rate = 2.0 * 0.3;
  const double w_squared = std::pow(scalar_value(certificate.values, "gamma") * 0.5, 2) / rate;
  const auto runner_with = [](const std::string& assumptions) {
    return CertifiedGains(kGains)
        .with("gains: {theta0: {position: [5]}}")
        .assuming(assumptions)
        .config()
        .law;
  };
  const auto law = runner_with("{initial_error: 1, noise: 0.1, disturbance: 0.5}");
  const auto norm = [&](double W) { return std::sqrt(W / eigenvalues(0)); };
  const auto bound = [&](const LawRunner& runner) {
    return law->error_bound(runner.state().data());
  };
  // Nothing before the first sample: of V, only the estimate's part is left after it.
  LawRunner sampled(law);
  sampled.sample(0, {0.0});
  double W = eigenvalues(1) + omega_2 * 0.01;
  expect_bound(norm(W), bound(sampled));
  sampled.flow(from_seconds(0.15));
  W = w_squared + (W - w_squared) * std::exp(-rate * 0.15);
  expect_bound(norm(W), bound(sampled));
  sampled.sample(0, {0.0});
  W += omega_2 * 0.01;
  expect_bound(norm(W), bound(sampled));

  // Before it, theta is C x − C x̂ − theta0 off.
  const auto quiet = runner_with("{initial_error: 0, noise: 0, disturbance: 0}");
  LawRunner flowing(quiet);
  expect_bound(norm(omega_2 * 25.0), quiet->error_bound(flowing.state().data()));
  flowing.flow(from_seconds(0.2));
  expect_bound(norm(omega_2 * 25.0 * std::exp(-rate * 0.2)),
               quiet->error_bound(flowing.state().data()));
  // Later than T2 after the last sample V grows at the rate δ − 2 λ at most.
  const double delta = scalar_value(certificate.values, "delta");
  flowing.flow(from_seconds(0.3));
  expect_bound(norm(omega_2 * 25.0 * std::exp(-rate * 0.2 + (delta - rate) * 0.3)),
               quiet->error_bound(flowing.state().data()));
  flowing.sample(0, {0.0});
  const double after_gap = quiet->error_bound(flowing.state().data());
  flowing.flow(from_seconds(0.15));
  expect_bound(after_gap * std::exp(-rate * 0.15 / 2.0),
               quiet->error_bound(flowing.state().data()));
}

struct Change {
  const char* yaml;
  /// Parts of the message: place, key, expected, found.
  std::vector<std::string> message;
};

const Change kUnproved[] = {
    {"gains: {L: [[1.5], [-1.02]]}",
     {"ferrante2019_oscillator_0.2.yaml", "certificate: expected gains and matrices",
      "found some that were altered since 'design' wrote them: ",
      "ferrante2019 (28) is violated by ", "design synthesize", "allow_uncertified: true"}},
    {"plant: {A: [[0, 1], [-4.1, 0]]}",
     {"ferrante2019_oscillator_0.2.yaml", "certificate/plant/hash: expected ",
      "the fingerprint of the plant and sensors configured", "plant.yaml", "found "}},
    {"sensors: {position: {C: [[1, 0.01]]}}", {"certificate/plant/hash: expected "}},
    {"sampling: {T2: 0.21}",
     {"sampling: expected T1 and T2 inside [0.1, 0.2] s", "found [0.1, 0.21] s"}},
    {"sampling: {T1: 0.09}", {"sampling: expected", "found [0.09, 0.2] s"}},
    {"certificate: {gamma: 0.5}", {"certificate: expected", "is violated by"}},
};

TEST(CertifiedConfigTest, RefusesWhatIsNotProved) {
  for (const Change& change : kUnproved) {
    SCOPED_TRACE(change.yaml);
    expect_parts(refusal_of(CertifiedGains(kGains).with(change.yaml)), change.message);
  }
}

const char kTwoSensors[] = "test/certificate/two_sensors.yaml";

TEST(CertifiedConfigTest, ComparesTheTimesOfEachSensorWithItsOwnOfTheProof) {
  EXPECT_EQ("", CertifiedGains(kTwoSensors).config().warning);
  EXPECT_NE("", CertifiedGains(kTwoSensors).config().guarantee);
  // Inside those of gps, but not of wheel, and the other way round.
  expect_parts(refusal_of(CertifiedGains(kTwoSensors).with("sampling: {wheel: {T2: 0.5}}")),
               {"sampling/wheel: expected T1 and T2 inside [0.05, 0.2] s", "[0.05, 0.5] s"});
  expect_parts(refusal_of(CertifiedGains(kTwoSensors).with("sampling: {gps: {T1: 0.1}}")),
               {"sampling/gps: expected T1 and T2 inside [0.2, 1] s", "found [0.1, 1] s"});
  const auto own =
      CertifiedGains(kTwoSensors).with("sensors: {gps: {sampling: {T1: 0.3, T2: 0.5}}}").config();
  EXPECT_EQ("", own.warning);
  EXPECT_EQ(from_seconds(0.5), own.options.sampling.of_sensor(0).T2);
}

TEST(CertifiedConfigTest, RefusesGridsOfTimersThatWouldFillTheMemory) {
  std::string wheel = "0, 0.05";
  for (int i = 1; i < 500; ++i) wheel += ", " + std::to_string(0.05 + i * 0.0003);
  expect_parts(refusal_of(CertifiedGains(kTwoSensors)
                              .with("certificate: {timer_nodes: {wheel: [" + wheel + ", 0.2]}}")),
               {"certificate/timer_nodes: expected at most 1000 nodes of the grid", "1506"});
  expect_parts(
      refusal_of(CertifiedGains(kTwoSensors).with("certificate: {timer_nodes: {wheel: [0, 0.2]}}")),
      {"certificate/timer_nodes/wheel: expected increasing times from 0 to T2 = 0.2 with "
       "T1 = 0.05 among them",
       "found [0, 0.2]"});
}

TEST(CertifiedConfigTest, TakesAverageDwellTimesThatImplyThatOfTheProof) {
  const char kAveraged[] = "test/certificate/bernard2022_bouncing_ball_reverse_average.yaml";
  const auto averaged = [&](const std::string& jumps) {
    return CertifiedGains(kAveraged).with("jumps: {" + jumps + "}");
  };
  expect_parts(averaged("").config().guarantee, {"tau = 0.5 s", "N0 = 4"});
  EXPECT_TRUE(averaged("").claim()->is_proved);
  for (const char* stronger :
       {"reverse_average_dwell_time: {tau: 0.5, N0: 4}",
        "reverse_average_dwell_time: {tau: 0.4, N0: 1}", "average_dwell_time: {tau: 9, N0: 9}"}) {
    EXPECT_NE("", averaged(stronger).config().guarantee) << stronger;
  }
  for (const char* weaker : {"reverse_average_dwell_time: {tau: 0.6, N0: 4}",
                             "reverse_average_dwell_time: {tau: 0.5, N0: 5}"}) {
    expect_parts(refusal_of(averaged(weaker)),
                 {"jumps/reverse_average_dwell_time: expected a tau not larger and an N0 not "
                  "larger than in {tau: 0.5, N0: 4}",
                  "for which the gains were made"});
  }
}

TEST(CertifiedConfigTest, WatchesTheAverageDwellTimeOfTheProof) {
  for (const char* jumps : {"{}", "{average_dwell_time: {tau: 9, N0: 9}}"}) {
    SCOPED_TRACE(jumps);
    const ObserverConfig config =
        CertifiedGains("test/certificate/bernard2022_bouncing_ball_reverse_average.yaml")
            .with(std::string("jumps: ") + jumps)
            .config();
    Eigen::VectorXd state(config.law->state_size());
    Eigen::VectorXd workspace(config.law->workspace_size());
    config.law->initialize(state.data());
    config.law->flow(from_seconds(1.9), state.data(), workspace.data());
    EXPECT_EQ(config.law->dwell_violations(state.data()), 0.0);
    // N0 tau = 2 s without a jump
    config.law->flow(from_seconds(0.2), state.data(), workspace.data());
    EXPECT_EQ(config.law->dwell_violations(state.data()), 1.0);
  }
}

TEST(CertifiedConfigTest, RoundsDwellTimesToThoseThatTheProofAllows) {
  const double third = 1.0 / 3.0;
  EXPECT_EQ(average_of({DwellTime::Kind::kAverage, third, 2.0}).tau, 333333334);
  EXPECT_EQ(average_of({DwellTime::Kind::kReverseAverage, 2.0 * third, 2.0}).tau, 666666666);
  for (const auto kind : {DwellTime::Kind::kAverage, DwellTime::Kind::kReverseAverage}) {
    for (int tenths = 1; tenths < 1000; ++tenths) {
      EXPECT_EQ(average_of({kind, tenths / 10.0, 1.0}).tau, tenths * 100000000LL);
    }
  }
  std::optional<DwellTimes> times;
  watch({DwellTime::Kind::kAverage, 0.5, 4.0}, times);
  watch({DwellTime::Kind::kAverage, 0.7, 5.0}, times);
  EXPECT_EQ(times->average->tau, 700000000);
  EXPECT_EQ(times->average->N0, 4.0);
  EXPECT_FALSE(times->reverse_average);
}

TEST(CertifiedConfigTest, RefusesAnOutputInjectionThatTheProofDoesNotKnow) {
  const std::string message =
      refusal_of(CertifiedGains("config/examples/bernard2022_bouncing_ball/gains.yaml")
                     .with("sensors: {level: {C: [[1, 0]], measured: continuous, "
                           "source: {topic: level}}}")
                     .with("gains: {output_injection: {theta: level}}"));
  expect_parts(message, {"gains/output_injection", "certificate/A", "design/A"});
}

TEST(CertifiedConfigTest, ABoundWithHeldOutputsTakesTheirRate) {
  const char kHeld[] = "test/certificate/attack/held/bernard2022_equation22.yaml";
  const auto refused = [&](const std::string& rest) {
    return refusal_of(
        CertifiedGains(kHeld).assuming("{initial_error: 1, noise: 0, disturbance: 0" + rest));
  };
  expect_parts(refused("}"), {"error_assumptions", "bernard2022_equation22", "no output_rate"});
  expect_parts(refused(", output_rate: -1}"), {"error_assumptions/output_rate", "found -1"});
  const std::string uncertain =
      refusal_of(CertifiedGains(kHeld)
                     .with("jumps: {stamp_error: 0.001}")
                     .assuming("{initial_error: 1, noise: 0, disturbance: 0, output_rate: 2}"));
  expect_parts(uncertain, {"bernard2022_equation22", "jumps/stamp_error"});
  expect_parts(refusal_of(CertifiedGains(kGains).assuming(
                   "{initial_error: 1, noise: 0, disturbance: 0, output_rate: 2}")),
               {"error_assumptions/output_rate", "measured: continuous", "none"});
}

TEST(CertifiedConfigTest, LoadsItWithAWarningAndWithoutBoundWhereThatIsAllowed) {
  for (const Change& change : kUnproved) {
    SCOPED_TRACE(change.yaml);
    const ObserverConfig config = CertifiedGains(kGains)
                                      .with(change.yaml)
                                      .with("allow_uncertified: true")
                                      .assuming(kAssumptions)
                                      .config();
    EXPECT_EQ("", config.guarantee);
    expect_parts(config.warning, {"no guarantee and no error bound: "});
    expect_parts(config.warning, change.message);
    EXPECT_TRUE(std::isnan(initial_bound(config)));
  }
  const ObserverConfig proved =
      CertifiedGains(kGains).with("allow_uncertified: true").assuming(kAssumptions).config();
  EXPECT_EQ("", proved.warning);
  EXPECT_FALSE(std::isnan(initial_bound(proved)));
}

TEST(CertifiedConfigTest, RefusesWhatIsNoCertificateInAnyCase) {
  const Change changes[] = {
      {"certificate: {P1: [[1, 0]]}", {"certificate/P1: expected a 2 x 2 matrix"}},
      {"certificate: {P1: [[1, 0], [0.1, 1]]}", {"certificate/P1: expected a symmetric matrix"}},
      {"certificate: {P2: [[.nan]]}", {"certificate/P2"}},
      {"certificate: {theorem: fermat}", {"certificate/theorem: expected one of", "'fermat'"}},
      {"certificate: {T1: 0.3}", {"certificate/T2: expected 0 <= T1 <= T2"}},
      {"certificate: {gama: 3}", {"certificate/gama"}},
      {"certificate: {T2: .inf}", {"certificate/theorem", "up to a longest one: T2 = inf"}},
      {"certificate: {average_dwell_time: {tau: 1, N0: 2}}",
       {"certificate/theorem", "not on their average"}},
      {"certificate: {average_dwell_time: {tau: 1, N0: 2}, reverse_average_dwell_time: {tau: 1}}",
       {"certificate/reverse_average_dwell_time: expected one of"}},
      {"certificate: {average_dwell_time: {tau: 0, N0: 2}}",
       {"certificate/average_dwell_time/tau: expected a number from"}},
      {"certificate: {average_dwell_time: {tau: 1, N0: 1.5}}",
       {"certificate/average_dwell_time/N0: expected a whole number"}},
      {"certificate: {average_dwell_time: {tau: 1}}", {"certificate/average_dwell_time/N0"}},
      {"certificate: {N: [[1]]}", {"certificate/N"}},
      {"error_assumptions: {initial_error: 1, noise: 0.1}",
       {"error_assumptions/disturbance", "such as the line 'disturbance: 0.1'"}},
      {"error_assumptions: {initial_error: -1, noise: 0.1, disturbance: 0}",
       {"error_assumptions/initial_error"}},
      {"error_assumptions: {noise: 0.1, disturbance: 0}", {"error_assumptions/initial_error"}},
      {"error_assumptions: {initial_error: 1, noise: 0, disturbance: 0, more: 1}",
       {"error_assumptions/more"}},
      {"allow_uncertified: perhaps", {"allow_uncertified: expected one of true, false"}},
  };
  for (const Change& change : changes) {
    SCOPED_TRACE(change.yaml);
    expect_parts(
        refusal_of(CertifiedGains(kGains).with("allow_uncertified: true").with(change.yaml)),
        change.message);
  }
}

/// Takes a key out of a section of the root.
ConfigNode without(ConfigNode tree, const std::string& section, const std::string& key) {
  for (auto& [name, node] : tree.entries) {
    if (name != section) continue;
    auto& entries = node.entries;
    entries.erase(std::remove_if(entries.begin(), entries.end(),
                                 [&](const auto& entry) { return entry.first == key; }),
                  entries.end());
  }
  return tree;
}

TEST(CertifiedConfigTest, SaysWhenTheTheoremIsAboutAnotherType) {
  const ConfigNode tree =
      without(CertifiedGains(kGains).with("observer: ConstantGainObserver").tree(), "gains", "H");
  try {
    read_observer_config(tree, no_plant_plugins);
    FAIL();
  } catch (const ConfigError& error) {
    expect_parts(error.what(), {"certificate/theorem: expected a theorem about a "
                                "ConstantGainObserver",
                                "about IntersampleInjectionObserver"});
  }
}

TEST(CertifiedConfigTest, ADisturbanceNeedsACertificateForDisturbances) {
  CertifiedGains gains(kGains);
  const auto read = [&](const std::string& assumptions) {
    const ConfigNode whole = gains.assuming(assumptions).tree();
    return read_observer_config(
        without(without(without(whole, "certificate", "N"), "certificate", "C_p"), "certificate",
                "gamma"),
        no_plant_plugins);
  };
  EXPECT_FALSE(std::isnan(initial_bound(read("{initial_error: 1, noise: 0, disturbance: 0}"))));
  EXPECT_THROW(read("{initial_error: 1, noise: 0, disturbance: 0.1}"), ConfigError);
}

TEST(CertifiedConfigTest, TakesTheDisturbanceThatTheGainsWereDesignedForWhereNoneIsDeclared) {
  const auto read = [](const std::string& assumptions) {
    return CertifiedGains(kGains)
        .with("certificate: {disturbance: 0.5}")
        .assuming(assumptions)
        .config();
  };
  const auto bound_after_a_sample = [](const ObserverConfig& config) {
    LawRunner runner(config.law);
    runner.sample(0, {0.0});
    runner.flow(from_seconds(0.15));
    return config.law->error_bound(runner.state().data());
  };
  const ObserverConfig designed = read("{initial_error: 1, noise: 0.1}");
  const ObserverConfig declared = read("{initial_error: 1, noise: 0.1, disturbance: 0.5}");
  EXPECT_EQ(bound_after_a_sample(designed), bound_after_a_sample(declared));
  EXPECT_LT(bound_after_a_sample(read("{initial_error: 1, noise: 0.1, disturbance: 0.4}")),
            bound_after_a_sample(designed));
  EXPECT_NE(designed.guarantee.find("|w| <= 0.5, the disturbance that the gains were designed for"),
            std::string::npos)
      << designed.guarantee;
  EXPECT_EQ(declared.guarantee.find("designed for"), std::string::npos);
}

ConfigNode without(ConfigNode tree, const std::string& section) {
  tree.entries.erase(std::remove_if(tree.entries.begin(), tree.entries.end(),
                                    [&](const auto& entry) { return entry.first == section; }),
                     tree.entries.end());
  return tree;
}

const char kTwoProofs[] = "config/examples/ferrante2019_oscillator/gains.yaml";

TEST(CertifiedConfigTest, TakesTheBoundFromTheRunTimeCertificate) {
  const auto bound_of = [](const ConfigNode& tree) {
    const auto law = read_observer_config(tree, no_plant_plugins).law;
    LawRunner runner(law);
    runner.sample(0, {0.0});
    return law->error_bound(runner.state().data());
  };
  const CertifiedGains both =
      CertifiedGains(kTwoProofs).assuming("{initial_error: 0, noise: 1, disturbance: 0}");
  ConfigNode other = both.tree();
  for (auto& [key, value] : other.entries) {
    if (key == kCertificate) value = *both.tree().find(kRunTimeCertificate);
  }
  const ConfigNode only_run_time = without(other, kRunTimeCertificate);
  const ConfigNode only_design = without(both.tree(), kRunTimeCertificate);
  EXPECT_EQ(bound_of(both.tree()), bound_of(only_run_time));
  EXPECT_LT(bound_of(both.tree()), bound_of(only_design));
  const std::string text = both.config().guarantee;
  expect_parts(text, {"gamma = 32.9", "proved in ball arithmetic", "run_time_certificate"});
}

TEST(CertifiedConfigTest, RefusesARunTimeCertificateThatDoesNotHold) {
  expect_parts(refusal_of(CertifiedGains(kTwoProofs).with("run_time_certificate: {lambda_t: 0.5}")),
               {"ferrante2019_oscillator", "run_time_certificate: expected gains and matrices",
                "is violated by"});
  expect_parts(
      refusal_of(CertifiedGains(kTwoProofs).with("run_time_certificate: {plant: {hash: no}}")),
      {"run_time_certificate/plant/hash: expected "});
  expect_parts(
      refusal_of(CertifiedGains(kTwoProofs).with("run_time_certificate: {N: [[1e-3], [0]]}")),
      {"run_time_certificate: expected the N of 'certificate'", "found another one"});
  const ConfigNode alone = without(CertifiedGains(kTwoProofs).tree(), kCertificate);
  try {
    read_observer_config(alone, no_plant_plugins);
    FAIL();
  } catch (const ConfigError& error) {
    expect_parts(error.what(),
                 {"run_time_certificate: expected the section 'certificate'", "found none"});
  }
}

TEST(CertifiedConfigTest, SaysWhereARunTimeCertificateIsNotKnownToBeProved) {
  const ObserverConfig config =
      CertifiedGains(kTwoProofs).with("run_time_certificate: {proof_hash: 0}").config();
  ASSERT_EQ(1u, config.warnings.size());
  expect_parts(config.warnings.front(),
               {"run_time_certificate", "design verify GAINS --rigorous --record"});
  EXPECT_EQ(config.guarantee.find("proved in ball"), std::string::npos) << config.guarantee;
}

// P > Φ(τ)ᵀ P Φ(τ), which is enclosed between the values of τ that are looked at.
TEST(CertifiedConfigTest, AConditionOfEightStatesHoldsOverAllTimes) {
  const Eigen::Index n = 8;
  Eigen::MatrixXd A = Eigen::MatrixXd::Random(n, n) - 6.0 * Eigen::MatrixXd::Identity(n, n);
  const MatrixExpression P = symbol("P", n, n);
  const MatrixExpression transition = exponential(time_tau() * A);
  const Condition condition{"P > Phi' P Phi", P - transpose(transition) * P * transition,
                            Condition::Range{0.1, 3.0}};
  const NamedMatrices values = {{"P", Eigen::MatrixXd::Identity(n, n)}};
  EXPECT_TRUE(all_hold(check({condition}, values)));
  EXPECT_FALSE(all_hold(check({condition}, {{"P", -Eigen::MatrixXd::Identity(n, n)}})));
}

}  // namespace
}  // namespace sampled_data_observers::test
