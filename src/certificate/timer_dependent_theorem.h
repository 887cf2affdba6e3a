#pragma once

#include <string>
#include <vector>

#include "certificate/certificate.h"
#include "certificate/timer_dependent_conditions.h"

namespace sampled_data_observers {

/// A theorem whose Lyapunov function V = eᵀ P(τ) e is multi-affine in timers between the nodes of a
/// grid: what those of all types of observers share.
class TimerDependentTheorem : public Theorem {
 public:
  std::vector<NamedShape> multipliers(const CertificateSubject& subject) const override;
  std::vector<std::string> unlimited_multipliers(const CertificateSubject& subject) const override;
  std::vector<NamedShape> parameters(const CertificateSubject& subject) const override;
  std::string decay_parameter() const override { return "lambda_t"; }
  bool takes_flow_vertices() const override { return true; }
  bool takes_fall_at_events() const override { return true; }
  bool is_homogeneous(const CertificateSubject& subject) const override {
    return subject.plant.N.cols() == 0;
  }
  std::vector<Condition> conditions(const CertificateSubject& subject) const override;
  std::vector<GuaranteedFigure> guaranteed_figures(const CertificateSubject& subject,
                                                   const NamedMatrices& values) const override;

  /// The function whose conditions these are.
  TimerDependentFunction function(const CertificateSubject& subject) const;

 protected:
  virtual ErrorSystem error(const CertificateSubject& subject) const = 0;
};

/// The shortest and the longest times of the timers of a subject [s].
std::vector<double> shortest_times(const CertificateSubject& subject);
std::vector<double> longest_times(const CertificateSubject& subject);

}  // namespace sampled_data_observers
