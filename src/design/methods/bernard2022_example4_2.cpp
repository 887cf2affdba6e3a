#include <cmath>
#include <string>
#include <utility>

#include "certificate/theorems.h"
#include "design/certify.h"
#include "design/methods/bernard2022_parameters.h"
#include "design/methods/methods.h"

namespace sampled_data_observers {
namespace {

/// bernard2022, example 4.2: the least ℓ for which its high gain satisfies (22), or Corollary 4.1
/// for a jump map of which a Lipschitz constant is known.
class HighGainDesign : public DesignMethod {
 public:
  HighGainDesign(std::string summary, const Theorem& theorem)
      : summary_(std::move(summary)), theorem_(theorem) {}

  std::string name() const override { return theorem_.name(); }
  std::string summary() const override { return summary_; }
  const Theorem& theorem() const override { return theorem_; }

  std::vector<DesignParameter> parameters(const CertificateSubject& subject) const override {
    return {
        {"ell", "the gain [1/s]; the least where not given", std::nullopt, std::nullopt},
        {"decay_per_ell", "rate at which V falls in flow, in units of ell", std::nullopt,
         SearchRange{0.1, 1.98, false}},
        decay_parameter() == "decay" ? decay_parameter_of(subject) : jump_decay_parameter(),
    };
  }

  std::vector<Objective> objectives(const CertificateSubject&) const override {
    return {Objective::kFeasible, Objective::kMaxDecay};
  }

  DesignCandidate attempt(const CertificateSubject& subject, const Parameters& parameters,
                          Objective) const override {
    const auto given = parameters.find("ell");
    if (given != parameters.end()) return with_gain(subject, parameters, given->second);
    // What holds for an ell need not hold for larger ones: peaks of the high gain grow, too.
    double low = kLeastGain / time_scale(subject);
    double high = low;
    DesignCandidate best = with_gain(subject, parameters, high);
    for (int i = 0; i < kScanSteps && !best.is_verified(); ++i) {
      low = high;
      high *= kScanRatio;
      best = with_gain(subject, parameters, high);
    }
    while (best.is_verified() && high / low > kSearchRatio) {
      const double middle = std::sqrt(low * high);
      DesignCandidate candidate = with_gain(subject, parameters, middle);
      (candidate.is_verified() ? high : low) = middle;
      if (candidate.is_verified()) best = std::move(candidate);
    }
    return best;
  }

 private:
  static constexpr double kLeastGain = 0.1;  ///< in units of 1/time_scale()
  static constexpr double kScanRatio = 1.2;
  static constexpr int kScanSteps = 76;  ///< up to a million times the least gain
  static constexpr double kSearchRatio = 1.001;

  DesignCandidate with_gain(const CertificateSubject& subject, const Parameters& parameters,
                            double ell) const {
    const Eigen::Index n = subject.plant.states();
    // (s + 1)^n = s^n + K_n s^(n−1) + … + K_1
    Eigen::MatrixXd K(1, n);
    double binomial = 1.0;
    for (Eigen::Index i = 0; i < n; ++i) {
      K(0, i) = binomial;
      binomial *= static_cast<double>(n - i) / static_cast<double>(i + 1);
    }
    DesignCandidate candidate =
        certify_here(theorem(), subject,
                     {{"ell", scalar_matrix(ell)},
                      {"K", K},
                      {"flow_decay", scalar_matrix(ell * parameters.at("decay_per_ell"))},
                      {decay_parameter(), scalar_matrix(parameters.at(decay_parameter()))}},
                     Objective::kFeasible);
    candidate.cost = ell;
    return candidate;
  }

  std::string summary_;
  const Theorem& theorem_;
};

}  // namespace

const DesignMethod& bernard2022_high_gain_design() {
  static const HighGainDesign method(
      "least high gain ell for the time between jumps, with all zeros of K at -1",
      bernard2022_example4_2());
  return method;
}

const DesignMethod& bernard2022_high_gain_average_design() {
  static const HighGainDesign method(
      "least high gain ell for an average dwell time, with all zeros of K at -1",
      bernard2022_example4_2_average_dwell_time());
  return method;
}

const DesignMethod& bernard2022_high_gain_lipschitz_design() {
  static const HighGainDesign method(
      "least high gain ell for the time between jumps by a map with a Lipschitz constant",
      bernard2022_corollary4_1());
  return method;
}

const DesignMethod& bernard2022_high_gain_lipschitz_average_design() {
  static const HighGainDesign method(
      "least high gain ell for an average dwell time of jumps by a map with a Lipschitz constant",
      bernard2022_corollary4_1_average_dwell_time());
  return method;
}

}  // namespace sampled_data_observers
