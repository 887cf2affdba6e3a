#include "jump_based_bound.h"

#include <cmath>
#include <limits>

#include "bound_flow.h"
#include "outward.h"
#include "sampled_data_observers/certificate/matrix_functions.h"

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
    initial_ = std::sqrt(largest_eigenvalue_above(P)) * assumptions.initial_error;
    least_ = std::sqrt(least_eigenvalue_below(P));
  }

  Eigen::Index state_size() const override { return kEntries; }
  void initialize(double* state) const override {
    state[kAfterJump] = initial_;
    state[kCausedSince] = 0.0;
    state[kTau] = 0.0;
    state[kJumped] = 0.0;
  }
  void flow(double duration, double* state) const override {
    state[kTau] += duration;
    state[kCausedSince] = flowed_linearly(state[kCausedSince], growth_, push_, duration);
  }
  void jump(double* state) const override {
    const double tau = state[kTau];
    const bool is_first = state[kJumped] == 0.0;
    // A jump so soon is more likely one that was told twice.
    if (!is_first && tau < T1_) lose(state);
    if (!std::isinf(state[kAfterJump])) {
      const bool is_foreseen = !is_first && tau <= T2_;
      const double carried =
          is_foreseen ? state[kAfterJump] * std::exp(contraction_.offset + contraction_.slope * tau)
                      : reset_ * flowed_linearly(state[kAfterJump], growth_, 0.0, tau);
      state[kAfterJump] = carried + reset_ * state[kCausedSince] + noise_;
    }
    begin_interval(state);
  }
  void uncorrected_jump(double* state) const override {
    if (state[kJumped] != 0.0 && state[kTau] < T1_) lose(state);
    state[kAfterJump] =
        uncorrected_ *
        (flowed_linearly(state[kAfterJump], growth_, 0.0, state[kTau]) + state[kCausedSince]);
    begin_interval(state);
  }
  void sample(double*, double*) const override {}
  double bound(const double* state) const override {
    const double carried = flowed_linearly(state[kAfterJump], growth_, 0.0, state[kTau]);
    return (carried + state[kCausedSince]) / least_;
  }

 private:
  enum Entry { kAfterJump, kCausedSince, kTau, kJumped, kEntries };

  static void begin_interval(double* state) {
    state[kCausedSince] = 0.0;
    state[kTau] = 0.0;
    state[kJumped] = 1.0;
  }
  static void lose(double* state) { state[kAfterJump] = std::numeric_limits<double>::infinity(); }

  double T1_;
  double T2_;
  JumpContraction contraction_;
  double growth_ = 0.0;
  double push_ = 0.0;
  double reset_ = 0.0;        // ‖A_d − L_d H_d‖ in the norm of P
  double uncorrected_ = 0.0;  // ‖A_d‖ in it
  double noise_ = 0.0;
  double initial_ = 0.0;
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
