#pragma once

#include <vector>

#include "certificate/error_bound.h"
#include "certificate/late_flow.h"
#include "certificate/timer_dependent_sum.h"

namespace sampled_data_observers {

/// The bound that a TimerDependentSum gives: W >= V = eᵀ P(τ) e with
///   Ẇ = −2 λ W + γ² |w|² between samples, W⁺ = W + ν_i |η_i|² at those of the sensor i.
///
/// P(τ) is at least P_c + P_i(τ_i) + Σ_{j≠i} φ_j P_j(T2_j), whichever timer i is looked at, with
/// numbers φ_j that make P_j(τ_j) >= φ_j P_j(T2_j): for each i that is affine in one timer between
/// its nodes, so that what is known of its inverse at the nodes holds between them. The least of
/// what the timers give counts. Where a timer is beyond its longest time it stands still in P, and
/// its slope, which the flow condition counts on, is missing: W grows by a rate κ_i more, or as
/// |e|_Q² of a constant Q does. A sample sooner than the shortest time takes W to
/// (√(μ W) + √ρ |η|)², μ and ρ from the parts of the jump condition, which hold at all times.
///
/// State: W, infinite where nothing is known any more | the timers [ns].
class TimerDependentSumBound : public ErrorBound {
 public:
  /// @param sum      whose conditions hold for the values
  /// @param longest  of each timer [s]
  /// @throws std::invalid_argument for a disturbance without N, and where rounding hides a bound
  TimerDependentSumBound(const TimerDependentSum& sum, std::vector<double> longest,
                         const NamedMatrices& values, const ErrorAssumptions& assumptions);

  Eigen::Index state_size() const override {
    return kTimers + static_cast<Eigen::Index>(timers_.size());
  }
  void initialize(double* state) const override;
  void begin(double error, double* state) const override;
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

 private:
  enum Entry { kW, kTimers };

  /// |e|_Q of a constant Q, for flow where timers are late.
  struct Norm {
    LateFlow::Growth growth;
    double out_constant = 0.0;  ///< P_c <= out_constant Q
  };
  /// What is known at a node of one timer.
  struct Node {
    Eigen::MatrixXd inverse;    ///< n x n: not less than the block of P⁻¹ of the state
    double inverse_norm = 0.0;  ///< not less than its largest eigenvalue
    double of_state = 0.0;      ///< not less than |P_i| on the state
    double of_injection = 0.0;  ///< and on what is injected
    double mu = 0.0;
    std::vector<double> into;  ///< of each Norm: Q <= into P
    std::vector<double> out;   ///< P_i <= out Q
  };
  struct Timer {
    std::vector<double> times;  ///< of its nodes [s]
    std::vector<Node> nodes;
    double shortest = 0.0;  ///< [s]
    double longest = 0.0;   ///< [s]
    double nu = 0.0;
    double rho = 0.0;
    double kappa = 0.0;            ///< [1/s]
    double weight_rounding = 0.0;  ///< what rounding may take from a weight between nodes
  };

  void compute_timer(const TimerDependentSum& sum, std::size_t timer, const NamedMatrices& values,
                     const std::vector<double>& shares, const std::vector<Eigen::MatrixXd>& norms);
  double time_of(std::size_t timer, const double* state) const;
  /// The cell of a timer, and the weights of its two ends, not less than they are.
  struct Place {
    const Node* low = nullptr;
    const Node* high = nullptr;
    double of_low = 0.0;
    double of_high = 0.0;
  };
  /// Where a timer is `later` [s] from now.
  Place place(std::size_t timer, const double* state, double later) const;
  /// Σ weight · of(node) there.
  template <typename Of>
  double mean(std::size_t timer, const double* state, double later, Of of) const;
  template <typename Of>
  double least_mean(const double* state, double later, Of of) const;
  double flowed_in_norms(double W, double from, double duration, const double* state) const;

  std::vector<Timer> timers_;
  std::vector<Norm> norms_;
  std::vector<std::size_t> timer_of_;  // of each sensor of the plant, kNoTimer where it has none
  double of_state_ = 0.0;              // not less than |P_c| on the state
  double of_injection_ = 0.0;
  double of_state_at_0_ = 0.0;  // not less than |P(0)| on the state
  double of_injection_at_0_ = 0.0;
  double rate_ = 0.0;  // 2 λ
  double push_ = 0.0;  // γ² |w|²
  double noise_ = 0.0;
  double initial_error_ = 0.0;
  double initial_injection_ = 0.0;
  bool injects_ = false;
};

}  // namespace sampled_data_observers
