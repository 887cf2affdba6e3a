#include "certificate/jump_based_bound.h"

#include <algorithm>
#include <cmath>

#include "certificate/bound_flow.h"
#include "certificate/interval_bound.h"
#include "certificate/outward.h"
#include "certificate/sublevel_set.h"
#include "certificate/weighted_norm.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// |x − x̂|_P is at most the sum of two parts: one that comes from the error just after the last
/// jump, and one that the disturbance has caused since.
class JumpBasedBound : public IntervalBound {
 public:
  JumpBasedBound(const CertificateSubject& subject, const Eigen::MatrixXd& P,
                 const Eigen::MatrixXd& L_d, const JumpContraction& contraction,
                 const ErrorAssumptions& assumptions)
      : IntervalBound(subject, assumptions, kEntries), contraction_(contraction) {
    const Eigen::MatrixXd& A = subject.plant.A();
    growth_ = growth_above(P, A);
    push_ = norm_into(P, subject.plant.N) * assumptions.disturbance;
    const Eigen::MatrixXd A_d = jump_of(subject.plant.mode());
    const Eigen::MatrixXd& C_d = subject.plant.mode().C_d;
    const Eigen::MatrixXd reset = A_d - L_d * C_d;
    reset_ = norm_between(P, P, MatrixExpression(A_d) - MatrixExpression(L_d) * C_d);
    uncorrected_ = norm_between(P, P, A_d);
    noise_ = norm_into(P, L_d) * assumptions.noise;
    per_error_ = std::sqrt(largest_eigenvalue_above(P));
    const double least_eigenvalue = positive_least_eigenvalue(P, "P");
    least_ = std::sqrt(least_eigenvalue);
    set_ = SublevelSet(P, least_eigenvalue);
    if (jump_stamp_error() == 0.0) return;
    flow_norm_ = raised(norm2(A));
    flown_ = raised(std::exp(flow_norm_ * jump_stamp_error()));
    reset_norm_ = raised(norm2(reset));
    jump_norm_ = raised(norm2(A_d));
    const double injection = raised(norm2(L_d) * norm2(C_d));
    const Eigen::MatrixXd& N = subject.plant.N;
    const double disturbance = N.cols() == 0 ? 0.0 : raised(norm2(N)) * assumptions.disturbance;
    disturbed_ = (1.0 + flown_ * jump_norm_ + injection) * flown_ * disturbance;
  }

  void jump(const JumpMotion& motion, double* state) const override {
    const auto [tau, is_first] = interval(state);
    const double after_jump = numbers(state)[kAfterJump];
    const double carried = !is_first && is_foreseen(tau)
                               ? after_jump * contraction_over(tau)
                               : reset_ * flowed_linearly(after_jump, growth_, 0.0, tau);
    const double after = carried + reset_ * numbers(state)[kCausedSince] + noise_ +
                         shifted(reset_norm_, motion, state);
    go_on_from(unless_told_twice(after, motion, state), state);
  }
  void uncorrected_jump(const JumpMotion& motion, double* state) const override {
    const double after = uncorrected_ * before_jump(state) + shifted(jump_norm_, motion, state);
    go_on_from(unless_told_twice(after, motion, state), state);
  }
  void refused_jump(const JumpMotion& motion, double* state) const override {
    const double before = before_jump(state);
    const double jumped =
        uncorrected_ * before + per_error_ * motion.moved + shifted(jump_norm_, motion, state);
    go_on_from(std::max(before, jumped), state);
  }
  void sample(std::size_t, double*, double*) const override {}

 protected:
  void begin_numbers(double error, double* numbers) const override {
    numbers[kAfterJump] = per_error_ * error;
    numbers[kCausedSince] = 0.0;
  }
  void flow_numbers(double duration, const Interval&, double* numbers) const override {
    numbers[kCausedSince] = flowed_linearly(numbers[kCausedSince], growth_, push_, duration);
  }
  double error(const Interval& at, const double* numbers) const override {
    return weighted_error(at, numbers) / least_;
  }
  void errors(const Interval& at, const double* numbers, double*,
              Eigen::Ref<Eigen::VectorXd> bounds) const override {
    set_.bounds(weighted_error(at, numbers), bounds);
  }
  void error_ellipsoid(const Interval& at, const double* numbers, double*,
                       Eigen::Ref<Eigen::MatrixXd> Q) const override {
    set_.ellipsoid(weighted_error(at, numbers), Q);
  }

 private:
  double contraction_over(double tau) const {
    const double grown = contraction_.slope * tau;
    // The two may cancel.
    const double rounding = 1e-14 * (std::abs(contraction_.offset) + std::abs(grown));
    return std::exp(contraction_.offset + grown + rounding);
  }

  enum Entry { kAfterJump, kCausedSince, kEntries };

  /// Of |x − x̂|_P.
  double weighted_error(const Interval& at, const double* numbers) const {
    return flowed_linearly(numbers[kAfterJump], growth_, 0.0, at.tau) + numbers[kCausedSince];
  }
  double before_jump(const double* state) const {
    return weighted_error(interval(state), numbers(state));
  }
  /// A jump sooner after another than T1 is more likely one that was told twice: then x stayed
  /// where it was, and only x̂ jumped. The first may have been told before the estimate began.
  double unless_told_twice(double after, const JumpMotion& motion, const double* state) const {
    if (!is_too_soon(interval(state).tau)) return after;
    return std::max(after, before_jump(state) + per_error_ * motion.moved);
  }
  /// Of |r|_P, by which a jump that was not at its stamp changes the error.
  /// @param reset_norm  ‖A_d − L_d C_d‖ of what the law took
  double shifted(double reset_norm, const JumpMotion& motion, const double* state) const {
    if (jump_stamp_error() == 0.0) return 0.0;
    const double error = before_jump(state) / least_;
    const double before = motion.speed_before + flow_norm_ * error;
    const double after = motion.speed_after + flow_norm_ * jump_norm_ * error;
    const double speed =
        flown_ * (after + (reset_norm + 2.0 * (flown_ - 1.0) * jump_norm_) * before);
    return raised(per_error_ * jump_stamp_error() * (speed + disturbed_));
  }
  static void go_on_from(double after, double* state) {
    numbers(state)[kAfterJump] = after;
    numbers(state)[kCausedSince] = 0.0;
    begin_interval(state);
  }

  JumpContraction contraction_;
  double growth_ = 0.0;
  double push_ = 0.0;
  double reset_ = 0.0;        // ‖A_d − L_d H_d‖ in the norm of P
  double uncorrected_ = 0.0;  // ‖A_d‖ in it
  double noise_ = 0.0;
  double per_error_ = 0.0;  // |e|_P of |e| = 1
  double least_ = 0.0;
  SublevelSet set_;  // of |e|_P²
  // Where stamps of jumps may be off.
  double flow_norm_ = 0.0;   // ‖A‖
  double flown_ = 1.0;       // of ‖e^{Aε}‖
  double reset_norm_ = 0.0;  // ‖A_d − L_d C_d‖
  double jump_norm_ = 0.0;   // ‖A_d‖
  double disturbed_ = 0.0;   // what w adds, per second
};

}  // namespace

std::unique_ptr<const ErrorBound> jump_based_bound(const CertificateSubject& subject,
                                                   const Eigen::MatrixXd& P,
                                                   const Eigen::MatrixXd& L_d,
                                                   const JumpContraction& contraction,
                                                   const ErrorAssumptions& assumptions) {
  return std::make_unique<const JumpBasedBound>(subject, P, L_d, contraction, assumptions);
}

}  // namespace sampled_data_observers
