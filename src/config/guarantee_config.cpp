#include "config/guarantee_config.h"

#include <cmath>
#include <locale>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "config/certificate_config.h"
#include "config/claim_contradiction.h"
#include "config/claimed_gains.h"
#include "config/dwell_times.h"
#include "config/injection_config.h"
#include "config/integration_check.h"
#include "config/number_text.h"
#include "config/plant_fingerprint.h"
#include "config/sampling_config.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {
namespace {

constexpr double kLargestAssumption = 1e50;

Eigen::VectorXd initial_estimate_of(const ObserverLaw& law, const Plant& plant) {
  Eigen::VectorXd state(law.state_size());
  law.initialize(state.data());
  return state.head(plant.states());
}

/// What the plant's own maps, with the outputs that are injected, refute of what the files state.
std::optional<ConfigError> objection_to_statements(ConfigSection& root,
                                                   const CertificateConfig& claim,
                                                   const ObserverConfig& config) {
  const Certificate& certificate = claim.certificate;
  const Plant& plant = *config.plant;
  const Eigen::VectorXd centre = initial_estimate_of(*config.law, plant);
  const StatedErrorMaps& stated = certificate.subject.plant.stated;
  if (const auto found = refute_jump_constant(plant, centre)) {
    return root.section("plant").error(found->key, found->expected + kGainsRemedy, found->found);
  }
  if (!stated.A) {
    if (const auto found = refute_lipschitz_claims(plant, centre)) {
      return root.section("plant").error(found->key, found->expected + kGainsRemedy, found->found);
    }
  }
  if (stated.is_empty()) return std::nullopt;
  const std::vector<OutputInjection> injections = config.law->observer().gains().output_injections;
  const auto found = refute_error_maps(plant, stated, injections, centre);
  if (!found) return std::nullopt;
  if (const auto others = injections_that_explain(plant, stated, centre)) {
    return root.section("gains").error(
        "output_injection",
        in_words(plant, *others) + ", on which certificate/A rests" + kGainsRemedy,
        injections.empty() ? "none" : in_words(plant, injections));
  }
  return root.section(claim.section)
      .error(found->key, found->expected + kGainsRemedy, found->found);
}

std::string dwell_time_text(double tau, double N0) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(12);
  text << "{tau: " << tau << ", N0: " << N0 << "}";
  return text.str();
}

/// An average dwell time that is configured must imply that for which the gains were made.
std::optional<ConfigError> objection_to_dwell_times(ConfigSection& root,
                                                    const CertificateSubject& subject) {
  if (!subject.dwell_time) return std::nullopt;
  ConfigSection jumps = root.section_or_empty("jumps");
  const std::optional<DwellTimes> configured = read_dwell_times(jumps);
  if (!configured) return std::nullopt;
  const DwellTime& claimed = *subject.dwell_time;
  const bool is_average = claimed.kind == DwellTime::Kind::kAverage;
  const auto& own = is_average ? configured->average : configured->reverse_average;
  if (!own) return std::nullopt;
  const Duration tau = average_of(claimed).tau;
  if (own->N0 <= claimed.N0 && (is_average ? own->tau >= tau : own->tau <= tau)) {
    return std::nullopt;
  }
  return jumps.error(is_average ? kAverageDwellTime : kReverseAverageDwellTime,
                     std::string(is_average ? "a tau not less" : "a tau not larger") +
                         " and an N0 not larger than in " +
                         dwell_time_text(claimed.tau, claimed.N0) +
                         ", for which the gains were made" + kGainsRemedy,
                     dwell_time_text(to_seconds(own->tau), own->N0));
}

/// The times between samples of each sensor, or between jumps, must be those of the certificate.
std::optional<ConfigError> objection_to_sampling(ConfigSection& root, const Plant& plant,
                                                 const CertificateSubject& subject) {
  const auto expected = [](const SamplingTimes& certified) {
    return "T1 and T2 inside " + to_text(certified) + ", for which the gains were made" +
           kGainsRemedy;
  };
  const SamplingTimes of_all{subject.T1, subject.T2};
  const SamplingConfig sampling = read_sampling(root, plant);
  if (sampling.jumps && !is_inside(*sampling.jumps, of_all)) {
    return root.error("sampling", expected(of_all), to_text(*sampling.jumps));
  }
  std::size_t sampled = 0;
  for (std::size_t i = 0; i < plant.sensors().size(); ++i) {
    const auto& times = sampling.sensors[i];
    if (!times) continue;
    const SamplingTimes& certified =
        subject.sensor_times.empty() ? of_all : subject.sensor_times[sampled++];
    if (is_inside(*times, certified)) continue;
    return sampling_error(root, plant.sensors()[i], expected(certified), to_text(*times));
  }
  return std::nullopt;
}

/// Why a certificate does not hold for a configuration, if so.
std::optional<ConfigError> objection(ConfigSection& root, const ConfigNode& tree,
                                     const CertificateConfig& claim, const ObserverConfig& config) {
  const ConfigSection section = root.section(claim.section);
  const Certificate& certificate = claim.certificate;
  if (auto error = objection_to_gains(root.section("gains"), *certificate.theorem,
                                      certificate.subject, config.law->observer().gains())) {
    return error;
  }
  const std::string hash = plant_fingerprint(tree);
  if (claim.plant_hash != hash) {
    return section.error("plant/hash",
                         hash +
                             ", the fingerprint of the plant and sensors configured: the gains "
                             "were made for others (" +
                             claim.plant_file + ")" + kGainsRemedy,
                         claim.plant_hash);
  }
  const CertificateSubject& subject = certificate.subject;
  if (auto error = objection_to_sampling(root, *config.plant, subject)) return error;
  if (auto error = objection_to_dwell_times(root, subject)) return error;
  if (auto error = objection_to_statements(root, claim, config)) return error;
  if (auto error = objection_to_step(root, *config.plant, *config.law, true)) return error;
  const std::vector<ConditionCheck> checks = check(certificate);
  if (all_hold(checks)) return std::nullopt;
  return root.error(
      claim.section,
      "gains and matrices for which the conditions of " + certificate.theorem->name() + " hold" +
          kGainsRemedy,
      std::string(claim.is_altered ? "some that were altered since 'design' wrote them: "
                                   : "others: ") +
          describe_violations(checks));
}

/// The bound must not leave out a disturbance that the certificate reckons with.
std::optional<ConfigError> objection_to_other_disturbances(ConfigSection& root,
                                                           const CertificateConfig& claim,
                                                           const CertificateConfig& for_bound) {
  const Eigen::MatrixXd& N = claim.certificate.subject.plant.N;
  const Eigen::MatrixXd& own = for_bound.certificate.subject.plant.N;
  if (N.cols() == own.cols() && N == own) return std::nullopt;
  return root.error(for_bound.section, std::string("the N of 'certificate'") + kGainsRemedy,
                    own.cols() == 0 ? "none" : "another one");
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
                                  const ObserverConfig& config, Guarantee& guarantee) {
  const LawGains law = config.law->observer().gains();
  const Plant& plant = *config.plant;
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
  if (section.has("output_rate")) {
    if (plant.outputs(SensorTiming::kContinuous) == 0) {
      throw section.error("output_rate", "a sensor with measured: continuous beside it", "none");
    }
    assumptions.output_rate = assumption(section, "output_rate");
  }
  assumptions.injection_lipschitz =
      read_injection(section, law, plant, initial_estimate_of(*config.law, plant));
  section.finish();
  assumptions.initial_injection = law.initial_injection;
  return assumptions;
}

/// Theorems are about the law itself, and take innovations as they are.
void require_bounded(ConfigSection& root, const ObserverConfig& config) {
  if (config.plant->has_angles(SensorTiming::kContinuous)) {
    throw root.error("error_assumptions", "no angles among the outputs with measured: continuous",
                     "one, for which there is no bound: it may have been wrapped");
  }
}

/// What the error bound does not cover, for who reads the log.
std::string conditions_of_bound(const Plant& plant, const ObserverLaw& law,
                                const Estimator::Options& options, Duration latency) {
  std::string text;
  if (options.jump_stamp_error > 0) {
    text += "; no error bound is given within " +
            number_text(to_seconds(options.jump_stamp_error), 4) +
            " s (jumps/stamp_error) of a jump, nor sooner than that after its stamp";
  }
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
                                           const ErrorAssumptions& assumptions, bool delays_jumps) {
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
  if (delays_jumps && !bound->takes_delays()) {
    throw root.error("error_assumptions", "jumps/late: rewind beside it",
                     "delayed, for which there is no bound here: there is one of plants that do "
                     "not switch, are corrected by continuous outputs or at jumps, without "
                     "gains/output_injection and jumps/stamp_error");
  }
  return bound;
}

}  // namespace

Guarantee read_guarantee(ConfigSection& root, const ConfigNode& tree, const ObserverConfig& config,
                         bool delays_jumps) {
  Guarantee guarantee;
  const bool allow_uncertified = root.flag("allow_uncertified", false);
  const ObserverLaw& law = *config.law;
  const auto claim = read_certificate(root, *config.plant, law.observer().gains());
  const auto for_bound =
      read_certificate(root, *config.plant, law.observer().gains(), kRunTimeCertificate);
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
  if (!error && for_bound) error = objection_to_other_disturbances(root, *claim, *for_bound);
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
  if (!error && (!delays_jumps || root.has("error_assumptions"))) {
    for (const auto* known : {&claim, &for_bound}) {
      if (*known && (*known)->certificate.subject.dwell_time) {
        guarantee.dwell_times.push_back(*(*known)->certificate.subject.dwell_time);
      }
    }
  }
  if (error) guarantee.warning = std::string("no guarantee and no error bound: ") + error->what();
  if (!root.has("error_assumptions")) return guarantee;
  require_bounded(root, config);
  // Proofs for the bound at run time take jumps at their stamps, and when they happen.
  const bool takes_jumps_as_stamped = config.options.jump_stamp_error == 0 && !delays_jumps;
  const bool is_by_other = for_bound && takes_jumps_as_stamped;
  const CertificateConfig& basis = is_by_other ? *for_bound : *claim;
  ErrorAssumptions assumptions = read_assumptions(root, basis, config, guarantee);
  assumptions.jump_stamp_error = to_seconds(config.options.jump_stamp_error);
  if (error) return guarantee;
  guarantee.bound = bound_of(root, basis.certificate, assumptions, delays_jumps);
  guarantee.noise = assumptions.noise;
  std::string& told = delays_jumps ? guarantee.warning : guarantee.text;
  if (delays_jumps) {
    told += "; the error bound takes that in, and is of the size of a jump until its release";
  }
  if (is_by_other) told += std::string("; error bound by the proof in ") + kRunTimeCertificate;
  told += conditions_of_bound(*config.plant, law, config.options, guarantee.latency);
  return guarantee;
}

}  // namespace sampled_data_observers
