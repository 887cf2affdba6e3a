#pragma once

#include <optional>
#include <vector>

#include "certificate/error_bound.h"
#include "certificate/form_maximum.h"
#include "certificate/late_flow.h"
#include "certificate/timer_dependent_conditions.h"

namespace sampled_data_observers {

/// The bound that a Lyapunov function V = eᵀ P(τ) e gives: W >= V with
///   Ẇ = −2 λ W + γ² |w|² between events, W⁺ = μ W + ν_i |η_i|² at those of the timer i (μ = 1
/// unless the function falls at events),
/// as the theorem has it, so that (x − x̂)(x − x̂)ᵀ <= W P(τ)⁻¹ in the entries of the state.
///
/// Between nodes P(τ)⁻¹ is at most the mean of the inverses at the corners of the cell by the
/// weights of the interpolation, since the inverse is convex. Where a timer is beyond its longest
/// time it stands still: LateFlow says what the flow makes of V then. An event sooner than the
/// shortest time, such as the first one after the estimate began, takes W to (√(μ W) + √ρ |η|)²,
/// with the least μ and ρ for which that holds at the corners of the cell; the same is used at all
/// events, where it is less. Gains between nodes are those that the law computes, off by δK by
/// rounding: there √W grows by √(δKᵀ P⁺ δK) |C e + η|.
///
/// State: W, infinite where nothing is known any more | the timers [ns].
class TimerDependentBound : public ErrorBound {
 public:
  /// @param function  whose conditions hold for the values
  /// @throws std::invalid_argument for a disturbance without N, and where rounding hides a bound
  TimerDependentBound(const TimerDependentFunction& function, std::vector<double> longest,
                      const NamedMatrices& values, const ErrorAssumptions& assumptions);

  Eigen::Index state_size() const override {
    return kTimers + static_cast<Eigen::Index>(grid_.dimensions());
  }
  void initialize(double* state) const override;
  void begin(double error, double* state) const override;
  void narrow(const Eigen::Ref<const Eigen::MatrixXd>& Q, double* state) const override;
  void begin_at_sample(std::size_t sensor, double error, double* state) const override;
  void flow(double duration, double* state) const override;
  void sample(std::size_t sensor, double* state, double* workspace) const override;
  bool injects_between_samples() const override { return injects_; }
  void jump(const JumpMotion& motion, double* state) const override;
  double bound(const double* state) const override;
  void state_bounds(const double* state, double* workspace,
                    Eigen::Ref<Eigen::VectorXd> bounds) const override;
  void ellipsoid(const double* state, double* workspace,
                 Eigen::Ref<Eigen::MatrixXd> Q) const override;

  // For bounds that are made of several.
  enum Entry { kW, kTimers };

  /// The largest that a node has at the corners of the cell in which the timers are.
  double largest_here(const std::vector<double>& of_nodes, const double* state) const;
  double time_of(std::size_t timer, const double* state) const;
  void advance_timers(double duration, double* state) const;
  const LateFlow& late_flow() const { return *late_flow_; }
  double shortest(std::size_t timer) const { return shortest_[timer]; }
  double longest(std::size_t timer) const { return longest_[timer]; }
  /// 2 λ
  double rate() const { return rate_; }
  /// W just after an event in time, as the theorem has it.
  double foreseen(std::size_t timer, double W) const;

 private:
  /// What is known at a node.
  struct Node {
    Eigen::MatrixXd inverse;    ///< n x n: not less than the block of P_k⁻¹ of the state
    double inverse_norm = 0.0;  ///< not less than its largest eigenvalue
    FormMaximum form;           ///< of the block of P_k of the state, but for its rounding
    double raise = 1.0;         ///< not less than the share of the exact P_k in the computed one
    double of_state = 0.0;      ///< not less than |P_k| on the state
    double of_injection = 0.0;  ///< and on what is injected
    std::vector<double> mu;     ///< of each timer
    std::vector<double> rho;    ///< of each timer
    // Of each timer, where gains are interpolated between nodes:
    std::vector<double> output;  ///< not less than |C P_k⁻¹ Cᵀ|
    /// Of the cell whose lowest node it is: √(δKᵀ P⁺ δK), δK what gains are off by rounding.
    std::vector<double> gain_rounding;
  };

  /// Where the timers are so much later [s].
  TensorGrid::Interpolation interpolation(const double* state, double later) const;
  void reset(std::size_t timer, double* state) const;
  void compute_nodes(const TimerDependentFunction& function, const NamedMatrices& values,
                     double disturbance);

  TensorGrid grid_;
  std::vector<Node> nodes_;
  std::vector<double> shortest_;       // [s]
  std::vector<double> longest_;        // [s]
  std::vector<std::size_t> timer_of_;  // of each sensor of the plant, kNoTimer where it has none
  std::vector<double> nu_;             // ν_i
  /// What rounding may take from a weight between nodes.
  double weight_rounding_ = 0.0;
  std::optional<LateFlow> late_flow_;
  double rate_ = 0.0;  // 2 λ
  double fall_ = 1.0;  // the μ of the theorem
  double push_ = 0.0;  // γ² |w|²
  double noise_ = 0.0;
  double initial_error_ = 0.0;
  double initial_injection_ = 0.0;
  bool injects_ = false;
};

}  // namespace sampled_data_observers
