#pragma once

#include <memory>

#include "sampled_data_observers/certificate/error_bound.h"
#include "sampled_data_observers/observer/law_decorator.h"

namespace sampled_data_observers {

/// A law with a guaranteed bound on its error: an ErrorBound that the same events drive, so that
/// the bound is a function of the events as the estimate is.
///
/// The bound is lost, that is infinite, until the next start:
/// - where the ErrorBound says so;
/// - where the timeline holds the estimate, since its flow is not finite;
/// - after a jump whose outputs, which the law corrects with, do not come;
/// - at a sample or jump before which the bound is above `error_limit`.
/// Resets that the law refuses leave the bound alone. Wherever an estimate begins, whether
/// configured or given, the assumption on the initial error is taken to hold anew.
class GuaranteedBound : public LawDecorator {
 public:
  /// @param error_limit  the largest |x − x̂| at samples and jumps for which the law's innovation
  /// is y − C x̂ and no angle in it is wrapped; infinity without angles.
  GuaranteedBound(const std::shared_ptr<const ObserverLaw>& law,
                  std::unique_ptr<const ErrorBound> bound, double error_limit);

  Eigen::Index workspace_size() const override;
  void initialize(double* state) const override;
  void flow(Duration duration, double* state, double* workspace) const override;
  Effect reset(const Event& event, double* state, double* workspace) const override;
  void hold(double* state) const override;
  double error_bound(const double* state) const override;

 private:
  double* then(double* state) const;
  double* now(double* state) const;
  const double* now(const double* state) const;
  double bound_of(const double* part) const;
  void settle(double* part) const;
  void take_over(const double* from, double* to) const;
  void begin_reset(double* state) const;
  void end_reset(double* state) const;

  std::unique_ptr<const ErrorBound> bound_;
  double error_limit_;
  bool jumps_are_measured_;
};

}  // namespace sampled_data_observers
