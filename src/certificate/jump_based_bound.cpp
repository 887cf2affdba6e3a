#include "certificate/jump_based_bound.h"

#include <algorithm>
#include <cmath>

#include "certificate/bound_flow.h"
#include "certificate/outward.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// sup |a v|_P for |v| <= 1
double weighted_norm(const Eigen::MatrixXd& a, const Eigen::MatrixXd& P) {
  return a.cols() == 0 ? 0.0 : std::sqrt(largest_eigenvalue_above(a.transpose() * P * a));
}

/// |x − x̂|_P is at most the sum of two parts: one that comes from the error just after the last
/// jump, and one that the disturbance has caused since.
class JumpBasedBound : public ErrorBound {
 public:
  JumpBasedBound(const CertificateSubject& subject, const Eigen::MatrixXd& P,
                 const Eigen::MatrixXd& reset, const Eigen::MatrixXd& L_d,
                 const JumpContraction& contraction, const ErrorAssumptions& assumptions)
      : T1_(subject.T1), T2_(subject.T2), contraction_(contraction) {
    const Eigen::MatrixXd& A = subject.plant.A();
    growth_ = growth_above(P, A);
    push_ = weighted_norm(subject.plant.N, P) * assumptions.disturbance;
    reset_ = raised(std::sqrt(largest_generalized_eigenvalue(reset.transpose() * P * reset, P)));
    const Eigen::MatrixXd A_d = jump_of(subject.plant.mode());
    uncorrected_ = raised(std::sqrt(largest_generalized_eigenvalue(A_d.transpose() * P * A_d, P)));
    noise_ = weighted_norm(L_d, P) * assumptions.noise;
    initial_error_ = assumptions.initial_error;
    per_error_ = std::sqrt(largest_eigenvalue_above(P));
    least_ = std::sqrt(positive_least_eigenvalue(P, "P"));
  }

  Eigen::Index state_size() const override { return kEntries; }
  void initialize(double* state) const override { begin(initial_error_, state); }
  void begin(double error, double* state) const override {
    state[kAfterJump] = per_error_ * error;
    state[kCausedSince] = 0.0;
    state[kTau] = 0.0;
    state[kJumped] = 0.0;
  }
  void flow(double duration, double* state) const override {
    state[kTau] += duration;
    state[kCausedSince] = flowed_linearly(state[kCausedSince], growth_, push_, duration);
  }
  void jump(double moved, double* state) const override {
    const double tau = state[kTau];
    const bool is_foreseen = state[kJumped] != 0.0 && T1_ <= tau && tau <= T2_;
    const double carried =
        is_foreseen ? state[kAfterJump] * std::exp(contraction_.offset + contraction_.slope * tau)
                    : reset_ * flowed_linearly(state[kAfterJump], growth_, 0.0, tau);
    begin_interval(unless_told_twice(carried + reset_ * state[kCausedSince] + noise_, moved, state),
                   state);
  }
  void uncorrected_jump(double moved, double* state) const override {
    begin_interval(unless_told_twice(uncorrected_ * before_jump(state), moved, state), state);
  }
  void refused_jump(double moved, double* state) const override {
    const double before = before_jump(state);
    begin_interval(std::max(before, uncorrected_ * before + per_error_ * moved), state);
  }
  void sample(double*, double*) const override {}
  double bound(const double* state) const override { return before_jump(state) / least_; }

 private:
  enum Entry { kAfterJump, kCausedSince, kTau, kJumped, kEntries };

  double before_jump(const double* state) const {
    return flowed_linearly(state[kAfterJump], growth_, 0.0, state[kTau]) + state[kCausedSince];
  }
  /// A jump sooner after another than T1 is more likely one that was told twice: then x stayed
  /// where it was, and only x̂ jumped.
  double unless_told_twice(double after, double moved, const double* state) const {
    if (state[kJumped] == 0.0 || state[kTau] >= T1_) return after;
    return std::max(after, before_jump(state) + per_error_ * moved);
  }
  static void begin_interval(double after, double* state) {
    state[kAfterJump] = after;
    state[kCausedSince] = 0.0;
    state[kTau] = 0.0;
    state[kJumped] = 1.0;
  }

  double T1_;
  double T2_;
  JumpContraction contraction_;
  double growth_ = 0.0;
  double push_ = 0.0;
  double reset_ = 0.0;        // ‖A_d − L_d H_d‖ in the norm of P
  double uncorrected_ = 0.0;  // ‖A_d‖ in it
  double noise_ = 0.0;
  double initial_error_ = 0.0;
  double per_error_ = 0.0;  // |e|_P of |e| = 1
  double least_ = 0.0;
};

}  // namespace

std::unique_ptr<const ErrorBound> jump_based_bound(const CertificateSubject& subject,
                                                   const Eigen::MatrixXd& P,
                                                   const Eigen::MatrixXd& reset,
                                                   const Eigen::MatrixXd& L_d,
                                                   const JumpContraction& contraction,
                                                   const ErrorAssumptions& assumptions) {
  return std::make_unique<const JumpBasedBound>(subject, P, reset, L_d, contraction, assumptions);
}

}  // namespace sampled_data_observers
