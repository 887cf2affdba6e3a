#pragma once

#include <Eigen/Core>
#include <memory>

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// ẋ at x, for RungeKuttaFlow.
class VectorField {
 public:
  virtual ~VectorField() = default;
  /// dx ← the derivative at x; must neither allocate nor throw.
  virtual void evaluate(const double* x, double* dx) const = 0;
  /// What else is to be done where a step of `duration` ns led from `before` to x, such as to bring
  /// x back to where it may be; by default nothing. Must neither allocate nor throw.
  virtual void end_step(Duration duration, const double* before, double* x) const;
};

/// The flow of ẋ = f(x) by the classical Runge–Kutta method of order 4 (Boost.odeint), in fixed
/// steps from the start of the flow on and one shorter step at its end. A flow may therefore be
/// split at whole multiples of the step without changing a bit.
///
/// It keeps scratch memory: one object serves one thread at a time. apply() allocates nothing.
class RungeKuttaFlow {
 public:
  /// @param states  n, > 0
  /// @param step    ns, > 0
  RungeKuttaFlow(Eigen::Index states, Duration step);
  ~RungeKuttaFlow();

  /// Carries x over `duration` >= 0.
  void apply(const VectorField& field, Duration duration, double* x) const;

 private:
  struct Stepper;
  Duration step_;
  std::unique_ptr<Stepper> stepper_;
};

}  // namespace sampled_data_observers
