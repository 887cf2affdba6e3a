#include "config/guarantee_config.h"

#include <algorithm>
#include <cmath>
#include <locale>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "config/certificate_config.h"
#include "config/claim_contradiction.h"
#include "config/integration_check.h"
#include "config/number_text.h"
#include "config/plant_fingerprint.h"
#include "sampled_data_observers/config/gains_config.h"

namespace sampled_data_observers {
namespace {

constexpr double kLargestAssumption = 1e50;

const char kRemedy[] =
    "; make them again with 'design synthesize', or set allow_uncertified: true to run without "
    "guarantee";

/// Keys of `gains` that no theorem names and that are looked at beside it, or change nothing of
/// what it says: where θ begins is an assumption of the bound.
const char* const kBesideGains[] = {"theta0", "variant", "output_injection"};

std::string interval(double low, double high) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(12);
  text << '[' << low << ", " << high << "] s";
  return text.str();
}

/// Every key of the gains that the law computes with must be one that the theorem is about.
std::optional<ConfigError> objection_to_gains(ConfigSection& root, const Certificate& certificate) {
  ConfigSection gains = root.section("gains");
  const Theorem& theorem = *certificate.theorem;
  const std::vector<NamedShape> known = theorem.gains(certificate.subject);
  const std::map<std::string, std::string> choices = theorem.gain_choices();
  for (const std::string& key : gains.keys()) {
    const bool is_known = std::any_of(known.begin(), known.end(), [&](const NamedShape& shape) {
      return shape.name.substr(0, shape.name.find('/')) == key;
    });
    const bool is_beside = choices.count(key) > 0 ||
                           std::count(std::begin(kBesideGains), std::end(kBesideGains), key) > 0;
    if (is_known || is_beside) continue;
    return gains.error(key, "only gains that " + theorem.name() + " is about" + kRemedy,
                       "'" + key + "', which changes the observer that it is about");
  }
  if (gains.has("output_injection") && !certificate.subject.plant.stated.A) {
    return gains.error("output_injection",
                       "certificate/A, the flow of the error under the injection (design again "
                       "with design/A), or no output injection" +
                           std::string(kRemedy),
                       "a certificate about the plant's own flow");
  }
  return std::nullopt;
}

/// What the plant's own maps, with the outputs that are injected, refute of what the files state.
std::optional<ConfigError> objection_to_statements(ConfigSection& root,
                                                   const CertificateConfig& claim,
                                                   const ObserverConfig& config) {
  const Certificate& certificate = claim.certificate;
  const Plant& plant = *config.plant;
  Eigen::VectorXd state(config.law->state_size());
  config.law->initialize(state.data());
  const Eigen::VectorXd centre = state.head(plant.states());
  const StatedErrorMaps& stated = certificate.subject.plant.stated;
  if (!stated.A) {
    if (const auto found = refute_lipschitz_claims(plant, centre)) {
      return root.section("plant").error(found->key, found->expected + kRemedy, found->found);
    }
  }
  if (stated.is_empty()) return std::nullopt;
  ConfigSection gains = root.section("gains");
  const std::vector<OutputInjection> injections = read_output_injections(gains, plant);
  const auto found = refute_error_maps(plant, stated, injections, centre);
  if (!found) return std::nullopt;
  if (const auto others = injections_that_explain(plant, stated, centre)) {
    return gains.error("output_injection",
                       in_words(plant, *others) + ", on which certificate/A rests" + kRemedy,
                       injections.empty() ? "none" : in_words(plant, injections));
  }
  return root.section(claim.section).error(found->key, found->expected + kRemedy, found->found);
}

/// Before the certificate is read: it could not be with the gains of another type.
void require_theorem_for_type(ConfigSection& root, const std::string& key,
                              const std::string& type) {
  if (!root.has(key)) return;
  ConfigSection section = root.section(key);
  const Theorem* theorem = find_theorem(section.text("theorem"));
  if (theorem == nullptr) return;
  const std::vector<std::string> types = theorem->observer_types();
  if (std::count(types.begin(), types.end(), type) > 0) return;
  throw section.error("theorem", "a theorem about a " + type + ", the type of this observer",
                      theorem->name() + ", which is about " + types.front());
}

/// Why a certificate does not hold for a configuration, if so.
std::optional<ConfigError> objection(ConfigSection& root, const ConfigNode& tree,
                                     const CertificateConfig& claim, const ObserverConfig& config) {
  const ConfigSection section = root.section(claim.section);
  const Certificate& certificate = claim.certificate;
  if (auto error = objection_to_gains(root, certificate)) return error;
  const std::string hash = plant_fingerprint(tree);
  if (claim.plant_hash != hash) {
    return section.error("plant/hash",
                         hash +
                             ", the fingerprint of the plant and sensors configured: the gains "
                             "were made for others (" +
                             claim.plant_file + ")" + kRemedy,
                         claim.plant_hash);
  }
  const CertificateSubject& subject = certificate.subject;
  const SamplingBounds& sampling = config.options.sampling;
  if (root.has("sampling") &&
      (sampling.T1 < from_seconds(subject.T1) || sampling.T2 > from_seconds(subject.T2))) {
    return root.error("sampling",
                      "T1 and T2 inside " + interval(subject.T1, subject.T2) +
                          ", for which the gains were made" + kRemedy,
                      interval(to_seconds(sampling.T1), to_seconds(sampling.T2)));
  }
  if (auto error = objection_to_statements(root, claim, config)) return error;
  if (auto error = objection_to_step(root, *config.plant, *config.law, true)) return error;
  const std::vector<ConditionCheck> checks = check(certificate);
  if (all_hold(checks)) return std::nullopt;
  return root.error(claim.section,
                    "gains and matrices for which the conditions of " +
                        certificate.theorem->name() + " hold" + kRemedy,
                    "others: " + describe_violations(checks));
}

double assumption(ConfigSection& section, const std::string& key) {
  return section.number_in(key, 0.0, kLargestAssumption, std::nullopt);
}

constexpr double kLongestLatency = 1e5;  // s

/// That of error_assumptions, or else what the gains were designed for, which `guarantee` then
/// says.
double read_disturbance(ConfigSection& section, const CertificateConfig& claim,
                        Guarantee& guarantee) {
  if (section.has("disturbance")) return assumption(section, "disturbance");
  if (!claim.disturbance) {
    throw section.error("disturbance",
                        "the largest |w| that enters by certificate/N, such as the line "
                        "'disturbance: 0.1' (0 for none)",
                        "none");
  }
  if (!guarantee.text.empty()) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text
        << "; |w| <= " << *claim.disturbance
        << ", the disturbance that the gains were designed for, since error_assumptions gives none";
    guarantee.text += text.str();
  }
  return *claim.disturbance;
}

ErrorAssumptions read_assumptions(ConfigSection& root, const CertificateConfig& claim,
                                  const Plant& plant, Guarantee& guarantee) {
  ErrorAssumptions assumptions;
  ConfigSection section = root.section("error_assumptions");
  assumptions.initial_error = assumption(section, "initial_error");
  assumptions.noise = assumption(section, "noise");
  if (claim.certificate.subject.plant.N.cols() > 0) {
    assumptions.disturbance = read_disturbance(section, claim, guarantee);
  } else if (section.has("disturbance") && assumption(section, "disturbance") > 0.0) {
    throw section.error("disturbance",
                        "0, or a certificate for disturbances (with certificate/N; design again "
                        "with design/N)",
                        "'" + section.text("disturbance") + "'");
  }
  guarantee.latency = from_seconds(section.number_in("latency", 0.0, kLongestLatency, 0.0));
  section.finish();
  ConfigSection theta = root.section("gains").section_or_empty("theta0");
  for (const Sensor& sensor : plant.sensors()) {
    if (!theta.has(sensor.name)) continue;
    assumptions.initial_injection = theta.vector(sensor.name, sensor.outputs()).norm();
  }
  return assumptions;
}

/// Theorems are about the law itself, and about outputs that are there all the time where they are
/// continuous.
void require_bounded(ConfigSection& root, const ObserverConfig& config, bool delays_jumps) {
  if (delays_jumps) {
    throw root.error("error_assumptions", "jumps/late: rewind beside it",
                     "delayed, for which there is no bound");
  }
  if (config.plant->outputs(SensorTiming::kContinuous) > 0) {
    throw root.error("error_assumptions", "no sensor with measured: continuous",
                     "one: its values are held between messages, for which there is no bound");
  }
}

/// What the error bound does not cover, for who reads the log.
std::string conditions_of_bound(const Plant& plant, const ObserverLaw& law, Duration latency) {
  std::string text;
  if (latency == 0 && (plant.inputs() > 0 || plant.jumps())) {
    text +=
        "; an error bound holds if no input or jump of before its stamp is still on its way "
        "(error_assumptions/latency is 0)";
  }
  if (law.flow_step() > 0) {
    text += "; the error of integration, in steps of " +
            number_text(to_seconds(law.flow_step()), 4) +
            " s that are short enough for the flow, is taken as small and is no part of the bound";
  }
  return text;
}

std::unique_ptr<const ErrorBound> bound_of(const ConfigSection& root,
                                           const Certificate& certificate,
                                           const ErrorAssumptions& assumptions) {
  const Theorem& theorem = *certificate.theorem;
  std::unique_ptr<const ErrorBound> bound;
  try {
    bound = theorem.error_bound(certificate.subject, certificate.values, assumptions);
  } catch (const std::invalid_argument& fault) {
    throw root.error("error_assumptions",
                     "assumptions for which " + theorem.name() + " gives a bound", fault.what());
  }
  if (!bound) {
    throw root.error("error_assumptions", "a certificate of a theorem that gives a bound",
                     theorem.name());
  }
  return bound;
}

}  // namespace

Guarantee read_guarantee(ConfigSection& root, const ConfigNode& tree, const ObserverConfig& config,
                         bool delays_jumps) {
  Guarantee guarantee;
  const bool allow_uncertified = root.flag("allow_uncertified", false);
  for (const char* key : {kCertificate, kRunTimeCertificate}) {
    require_theorem_for_type(root, key, config.type);
  }
  const auto claim = read_certificate(root, *config.plant);
  const auto for_bound = read_certificate(root, *config.plant, kRunTimeCertificate);
  if (!claim) {
    if (for_bound) {
      throw root.error(kRunTimeCertificate,
                       "the section 'certificate', what the gains were made for, beside it",
                       "none");
    }
    if (!root.has("error_assumptions")) return guarantee;
    throw root.error("error_assumptions",
                     "a certificate beside it (gains made by 'design synthesize')", "none");
  }
  auto error = objection(root, tree, *claim, config);
  if (!error && for_bound) error = objection(root, tree, *for_bound, config);
  if (error && !allow_uncertified) throw ConfigError(*error);
  const Certificate& certificate = claim->certificate;
  const Theorem& theorem = *certificate.theorem;
  if (!error && delays_jumps) {
    guarantee.warning =
        "the certificate says nothing of jumps/late: delayed, which lets jumps take effect when "
        "they become known: " +
        theorem.name() + " is about those that take effect when they happen (jumps/late: rewind)";
  } else if (!error) {
    const CertificateConfig* unproved = !claim->is_proved                    ? &*claim
                                        : for_bound && !for_bound->is_proved ? &*for_bound
                                                                             : nullptr;
    guarantee.text =
        statement(certificate) + (unproved == nullptr ? "; proved in ball arithmetic"
                                                      : "; checked in floating point, not proved");
    if (unproved != nullptr) {
      guarantee.remark =
          unproved->origin + ": " + unproved->section +
          ": its conditions hold in floating point, but the file records no proof of "
          "just these numbers: prove them with 'design verify GAINS --rigorous --record'";
    }
  }
  if (error) guarantee.warning = std::string("no guarantee and no error bound: ") + error->what();
  if (!root.has("error_assumptions")) return guarantee;
  require_bounded(root, config, delays_jumps);
  const CertificateConfig& basis = for_bound ? *for_bound : *claim;
  const ErrorAssumptions assumptions = read_assumptions(root, basis, *config.plant, guarantee);
  if (error) return guarantee;
  guarantee.bound = bound_of(root, basis.certificate, assumptions);
  guarantee.noise = assumptions.noise;
  if (for_bound) {
    guarantee.text += std::string("; error bound by the proof in ") + kRunTimeCertificate;
  }
  guarantee.text += conditions_of_bound(*config.plant, *config.law, guarantee.latency);
  return guarantee;
}

}  // namespace sampled_data_observers
