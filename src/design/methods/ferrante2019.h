#pragma once

#include <optional>
#include <vector>

#include "design/design_method.h"

namespace sampled_data_observers {

// What the designs of ferrante2019 share: all find gains for Theorem 2.

/// What is demanded of the intersample injection H.
enum class Injection {
  kFree,
  kPredictor,  ///< H = −C L (Remark 5): between samples the output of the estimate is predicted
  kHold        ///< H = 0: the innovation is held
};

/// lambda_t, delta, gain_bound, and gamma where there is a disturbance.
std::vector<DesignParameter> ferrante2019_parameters(const CertificateSubject& subject);
std::vector<Objective> ferrante2019_objectives(const CertificateSubject& subject);

/// The plant as an inequality is about: without disturbance and performance output where gamma is
/// neither asked for nor given. Without an end, it would outweigh all else.
PlantMatrices ferrante2019_plant(const CertificateSubject& subject, const Parameters& parameters,
                                 Objective objective);

/// A program with P1, P2, chi and gamma² as variables, and with delta and lambda_t fixed. gamma is
/// fixed where it is given and not minimized.
LmiProgram ferrante2019_program(const CertificateSubject& subject, const Parameters& parameters,
                                Objective objective);

/// Adds gamma² as variable where it is minimized, or fixes gamma as above.
void add_gamma(LmiProgram& program, const CertificateSubject& subject, const Parameters& parameters,
               Objective objective);

/// Whether the norm of L is within gain_bound, but for rounding: the inequalities ask for
/// kBoundShare of it.
bool keeps_gain_bound(const Eigen::MatrixXd& L, const Parameters& parameters);

class Ferrante2019Proposition : public LmiDesignMethod {
 public:
  const Theorem& theorem() const override { return *find_theorem("ferrante2019_theorem2"); }
  std::vector<DesignParameter> parameters(const CertificateSubject& subject) const override {
    return ferrante2019_parameters(subject);
  }
  std::vector<std::string> bounded_gains(const CertificateSubject&) const override { return {"L"}; }
  std::vector<Objective> objectives(const CertificateSubject& subject) const override {
    return ferrante2019_objectives(subject);
  }
  std::optional<DesignEstimate> estimate(const CertificateSubject& subject,
                                         const Parameters& parameters,
                                         Objective objective) const override {
    return estimate_by_program(subject, parameters, objective);
  }

 protected:
  NamedMatrices gains(const CertificateSubject& subject, const Parameters& parameters,
                      const NamedMatrices& solution) const final {
    NamedMatrices gains = any_gains(subject, solution);
    if (!keeps_gain_bound(gains.at("L"), parameters)) gains.clear();
    return gains;
  }

  virtual NamedMatrices any_gains(const CertificateSubject& subject,
                                  const NamedMatrices& solution) const = 0;
};

}  // namespace sampled_data_observers
