#include "certificate/jump_based_bound.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "certificate/bound_flow.h"
#include "certificate/held_output.h"
#include "certificate/interval_bound.h"
#include "certificate/outward.h"
#include "certificate/sublevel_set.h"
#include "certificate/weighted_norm.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// |x − x̂|_P is at most the sum of parts: one that comes from the error just after the last jump,
/// one that has been caused since, and, while its reset waits, one of what x̂ lacks of it.
class JumpBasedBound : public IntervalBound {
 public:
  JumpBasedBound(const CertificateSubject& subject, const Eigen::MatrixXd& P,
                 const Eigen::MatrixXd& L_d, const JumpContraction& contraction,
                 const ErrorAssumptions& assumptions)
      : IntervalBound(subject, assumptions, kEntries),
        contraction_(contraction),
        injects_(assumptions.injection_lipschitz.has_value()),
        held_(assumptions, 1.0) {
    if (injects_) require_held_outputs(assumptions);
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
    injection_ = injection_gain(P, assumptions);
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
    go_on_from(after, motion, state);
  }
  void uncorrected_jump(const JumpMotion& motion, double* state) const override {
    const double after = uncorrected_ * before_jump(state) + shifted(jump_norm_, motion, state);
    go_on_from(after, motion, state);
  }
  void refused_jump(const JumpMotion& motion, double* state) const override {
    const double before = before_jump(state);
    const double jumped =
        uncorrected_ * before + per_error_ * motion.moved + shifted(jump_norm_, motion, state);
    go_on_from(std::max(before, jumped), state);
  }
  void sample(std::size_t, double*, double*) const override {}

  bool follows_law() const override { return injects_; }
  bool holds_outputs() const override { return injects_; }
  void look_at(const LawAtWork& law, double* state) const override {
    if (is_lost(state)) return;
    held_.look_at(law.innovation, before_jump(state) / least_, numbers(state) + kHeld);
  }
  void output(double* state) const override { held_.take_message(numbers(state) + kHeld); }

  bool takes_delays() const override { return !injects_ && jump_stamp_error() == 0.0; }
  void change_awaited_speed(double speed, double* state) const override {
    numbers(state)[kSpeed] = raised(per_error_ * speed);
  }
  void release(double* state) const override {
    double* values = numbers(state);
    values[kCausedSince] += values[kShift];
    values[kLacking] = values[kShift] = values[kSpeed] = 0.0;
  }

 protected:
  void begin_numbers(double error, double* numbers) const override {
    std::fill_n(numbers, kEntries, 0.0);
    numbers[kAfterJump] = per_error_ * error;
  }
  void narrow_numbers(const Eigen::Ref<const Eigen::MatrixXd>& Q, double* numbers) const override {
    numbers[kAfterJump] = std::min(numbers[kAfterJump], set_.radius_around(Q));
  }
  void flow_numbers(double duration, const Interval& from, double* numbers) const override {
    numbers[kCausedSince] = caused(duration, from, numbers);
    HeldOutput::advance(duration, numbers + kHeld);
    numbers[kLacking] = flowed_linearly(numbers[kLacking], growth_, 0.0, duration);
    numbers[kShift] = flowed_linearly(numbers[kShift], growth_, numbers[kSpeed], duration);
  }
  double error(const Interval& at, const double* numbers) const override {
    return whole_error(at, numbers) / least_;
  }
  void errors(const Interval& at, const double* numbers, double*,
              Eigen::Ref<Eigen::VectorXd> bounds) const override {
    set_.bounds(whole_error(at, numbers), bounds);
  }
  void error_ellipsoid(const Interval& at, const double* numbers, double*,
                       Eigen::Ref<Eigen::MatrixXd> Q) const override {
    set_.ellipsoid(whole_error(at, numbers), Q);
  }

 private:
  double contraction_over(double tau) const {
    const double grown = contraction_.slope * tau;
    // The two may cancel.
    const double rounding = 1e-14 * (std::abs(contraction_.offset) + std::abs(grown));
    return std::exp(contraction_.offset + grown + rounding);
  }

  enum Entry : Eigen::Index {
    kAfterJump,
    kCausedSince,
    kLacking,  ///< by how much x̂ lacks a reset that waits
    kShift,    ///< by how much the estimate that flows from that reset has moved since
    kSpeed,    ///< how fast it moves there
    kHeld,     ///< HeldOutput
    kEntries = kHeld + HeldOutput::kEntries
  };

  static void require_held_outputs(const ErrorAssumptions& assumptions) {
    if (assumptions.jump_stamp_error > 0.0) {
      throw std::invalid_argument(
          "jumps/stamp_error: an output that is injected is that of the plant, not of the plant as "
          "its jumps are told");
    }
    require_output_rate(assumptions);
  }

  double caused(double duration, const Interval& from, const double* numbers) const {
    const double now = numbers[kCausedSince];
    if (HeldOutput::is_known(numbers + kHeld)) {
      return held_.flowed(now, growth_, push_, injection_, duration, numbers + kHeld);
    }
    if (!injects_) return flowed_linearly(now, growth_, push_, duration);
    // f takes x̂_s in place of the output x_s: that is injection_ |x_s − x̂_s| at most.
    const double free = injection_ / least_;
    const double carried = flowed_linearly(numbers[kAfterJump], growth_, 0.0, from.tau + duration);
    return flowed_linearly(now, growth_ + free, push_, duration) +
           raised(carried * std::expm1(free * duration));
  }

  /// Of the error without a reset that waits in the norm of P.
  double weighted_error(const Interval& at, const double* numbers) const {
    return flowed_linearly(numbers[kAfterJump], growth_, 0.0, at.tau) + numbers[kCausedSince];
  }
  /// Of x − x̂ in it.
  double whole_error(const Interval& at, const double* numbers) const {
    return weighted_error(at, numbers) + numbers[kLacking];
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
    std::fill_n(numbers(state), kEntries, 0.0);
    numbers(state)[kAfterJump] = after;
    begin_interval(state);
  }
  /// The same at a jump that the law takes, at once or later.
  void go_on_from(double after, const JumpMotion& motion, double* state) const {
    go_on_from(unless_told_twice(after, motion, state), state);
    if (!motion.awaited_speed) return;
    numbers(state)[kLacking] = raised(per_error_ * motion.moved);
    change_awaited_speed(*motion.awaited_speed, state);
  }

  JumpContraction contraction_;
  bool injects_;
  HeldOutput held_;
  double growth_ = 0.0;
  double push_ = 0.0;
  double reset_ = 0.0;        // ‖A_d − L_d H_d‖ in the norm of P
  double uncorrected_ = 0.0;  // ‖A_d‖ in it
  double noise_ = 0.0;
  double per_error_ = 0.0;  // |e|_P of |e| = 1
  double least_ = 0.0;
  SublevelSet set_;         // of |e|_P²
  double injection_ = 0.0;  // what f makes of |h| = 1 in the norm of P, per second
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
