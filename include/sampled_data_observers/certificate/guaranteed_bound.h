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
/// - where the timeline holds the estimate, since its flow is not finite, or a jump is without
///   effect, since its result is not;
/// - after a jump that the law refuses;
/// - after an input or a jump that was rejected: an event of kind kRejected says so;
/// - at a sample or jump before which the bound is above `error_limit`.
/// Samples that are refused were not taken. Wherever an estimate begins, whether configured or
/// given, the assumption on the initial error is taken to hold anew.
///
/// A share of 64 n ε of |x̂| is added for the rounding of the estimate, n the number of its states.
class GuaranteedBound : public LawDecorator {
 public:
  /// @param error_limit  the largest |x − x̂| at samples and jumps for which the law's innovation
  /// is y − C x̂ and no angle in it is wrapped; infinity without angles.
  GuaranteedBound(const std::shared_ptr<const ObserverLaw>& law,
                  std::unique_ptr<const ErrorBound> bound, double error_limit);

  Eigen::Index workspace_size() const override;
  Eigen::Index event_size(EventKind kind, int channel) const override;
  void initialize(double* state) const override;
  void flow(Duration duration, double* state, double* workspace) const override;
  Effect reset(const Event& event, double* state, double* workspace) const override;
  void hold(double* state) const override;
  double error_bound(const double* state) const override;
  BoundLoss bound_loss(const double* state) const override;

 private:
  double* then(double* state) const;
  double* now(double* state) const;
  const double* now(const double* state) const;
  double bound_of(const double* part) const;
  void settle(double* part, BoundLoss reason) const;
  void lose(double* part, BoundLoss reason) const;
  void give_up(double* state, BoundLoss reason) const;
  void take_over(const double* from, double* to) const;
  void flow_part(double* state) const;
  void begin_interval(double* state) const;

  std::unique_ptr<const ErrorBound> bound_;
  double error_limit_;
  bool jumps_are_measured_;
};

}  // namespace sampled_data_observers
