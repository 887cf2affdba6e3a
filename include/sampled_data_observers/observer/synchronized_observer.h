#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {

class MetricGain;

/// The gains of a synchronized observer. Either may be zero: L_c alone makes it flow-based, L_d
/// alone jump-based.
struct SynchronizedGains {
  std::vector<Eigen::MatrixXd> L_c;  ///< per sensor that measures continuously, n x m_i
  std::vector<Eigen::MatrixXd> L_d;  ///< per sensor that measures at jumps, n x m_i
  /// In place of L_d: the metric (n x n) from which a gain L_d(τ) follows that depends on the time
  /// since the jump before.
  std::optional<Eigen::MatrixXd> metric = std::nullopt;
  /// Empty: f takes all states from x̂.
  std::vector<OutputInjection> output_injections;
};

/// The observer that jumps when the plant does (bernard2022, (13)), with innovation in the flow
/// from continuous outputs y_c, at jumps from outputs y_d measured just before them, or both:
///
///   ẋ̂ = f(x̂, u) + Σ L_c,i (y_c,i − h_i(x̂))      while the plant flows
///   x̂⁺ = g(x̂) + Σ L_d,i (y_d,i − h_i(x̂))         when it jumps
///
/// y_c is held between its messages; before the first of each continuous sensor, at the start and
/// after each jump, nothing is injected. A jump without y_d is the plant's own. With output
/// injections, f takes the named states from y_c (the neuron of bernard2022, section 7.2).
/// Innovations of angular outputs are wrapped.
class SynchronizedObserver : public PlantObserver {
 public:
  /// @throws std::invalid_argument when a size does not fit the plant, for a metric that is not
  /// symmetric positive definite, and one for a plant whose flow, jump map or outputs at jumps are
  /// not linear or whose outputs at jumps are dependent.
  SynchronizedObserver(const ObserverContext& context, SynchronizedGains gains);

  LawGains gains() const override;

 protected:
  bool flow_is_affine() const override;
  void derivative(const Held& held, const double* s, double* ds, double* workspace) const override;
  void jump(const Held& held, std::size_t next, const JumpOutputs& outputs, double* state,
            double* workspace) const override;

 private:
  Eigen::Index metric_workspace() const;
  /// correction ← L_d(τ) (y_d − H x̂) with the gain of the metric, where all of y_d is known.
  void correct_by_metric(const Held& held, const JumpOutputs& outputs, const double* state,
                         double* correction, double* workspace) const;

  SynchronizedGains gains_;
  std::shared_ptr<const MetricGain> metric_gain_;  ///< null without metric
  VectorSlot x_ = scratch(n());                    ///< x̂ with injected outputs
  VectorSlot correction_ = scratch(n());           ///< of x̂ at a jump
  // Of the gain of a metric.
  VectorSlot innovations_ = scratch(plant().outputs(SensorTiming::kAtJumps));
  VectorSlot L_d_ = scratch(n() * plant().outputs(SensorTiming::kAtJumps));
  VectorSlot metric_workspace_ = scratch(metric_workspace());
};

}  // namespace sampled_data_observers
