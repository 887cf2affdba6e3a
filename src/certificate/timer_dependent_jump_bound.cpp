#include "certificate/timer_dependent_jump_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "certificate/held_output.h"
#include "certificate/outward.h"
#include "certificate/sublevel_set.h"
#include "certificate/timer_dependent_bound.h"
#include "certificate/timer_dependent_theorem.h"
#include "certificate/weighted_norm.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

double squared_norm(double value) { return value * value; }

/// State: that of TimerDependentBound | HeldOutput.
class TimerDependentJumpBound : public TimerDependentBound {
 public:
  TimerDependentJumpBound(const TimerDependentFunction& function, const CertificateSubject& subject,
                          const NamedMatrices& values, const ErrorAssumptions& assumptions)
      : TimerDependentBound(function, longest_times(subject), values, assumptions),
        corrects_at_jumps_(subject.plant.mode().C_d.rows() > 0),
        holds_(values.count("L_c") > 0 || assumptions.injection_lipschitz),
        held_(assumptions, holds_ ? raised(norm2(subject.plant.mode().C_c)) : 0.0) {
    const Eigen::MatrixXd A_d = jump_of(subject.plant.mode());
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(A_d.rows(), A_d.cols());
    std::vector<Eigen::MatrixXd> P;
    for (std::size_t k = 0; k < function.grid().size(); ++k) {
      P.push_back(evaluate(function.P(k), values));
    }
    const Eigen::MatrixXd& after = P.front();
    for (const Eigen::MatrixXd& P_k : P) {
      uncorrected_.push_back(norm_between(P_k, after, A_d));
      stayed_.push_back(norm_between(P_k, after, identity));
    }
    moved_ = raised(std::sqrt(largest_eigenvalue_above(after)));
    if (holds_) compute_outputs(function, subject, values, P, assumptions);
  }

  Eigen::Index state_size() const override {
    return TimerDependentBound::state_size() + HeldOutput::kEntries;
  }
  bool follows_law() const override { return holds_; }
  bool holds_outputs() const override { return holds_; }
  void look_at(const LawAtWork& law, double* state) const override {
    if (!is_lost(state)) held_.look_at(law.innovation, bound(state), held(state));
  }
  void output(double* state) const override { held_.take_message(held(state)); }

  void flow(double duration, double* state) const override {
    if (!holds_ || is_lost(state)) return TimerDependentBound::flow(duration, state);
    if (!HeldOutput::is_known(held(state))) {
      state[kW] =
          squared_norm(flowed_linearly(std::sqrt(state[kW]), free_.rate, free_.push, duration));
      return advance_timers(duration, state);
    }
    const bool is_late = time_of(0, state) + duration > longest(0);
    double growth = -rate() / 2.0;
    if (is_late) growth = std::max(growth, late_flow().growth(1).rate);
    const double off = held_.flowed(0.0, growth, 0.0, injection_, duration, held(state));
    TimerDependentBound::flow(duration, state);
    state[kW] = raised(squared_norm(std::sqrt(state[kW]) + off));
    HeldOutput::advance(duration, held(state));
  }

  void jump(const JumpMotion& motion, double* state) const override {
    if (is_lost(state)) return;
    if (!corrects_at_jumps_) return uncorrected_jump(motion, state);
    const double if_told_twice = told_twice(motion, state);
    reset(0, state);
    go_on_from(std::max(state[kW], if_told_twice), state);
  }
  void uncorrected_jump(const JumpMotion& motion, double* state) const override {
    if (is_lost(state)) return;
    const double root = std::sqrt(state[kW]);
    const double jumped = squared_norm(largest_here(uncorrected_, state) * root);
    const double foreseen = corrects_at_jumps_ || is_too_soon(state)
                                ? std::numeric_limits<double>::infinity()
                                : state[kW];
    go_on_from(std::max(std::min(jumped, foreseen), told_twice(motion, state)), state);
  }
  void refused_jump(const JumpMotion& motion, double* state) const override {
    if (is_lost(state)) return;
    const double root = std::sqrt(state[kW]);
    const double stayed = largest_here(stayed_, state) * root;
    const double jumped = largest_here(uncorrected_, state) * root + moved_ * motion.moved;
    go_on_from(raised(squared_norm(std::max(stayed, jumped))), state);
  }

 private:
  double* held(double* state) const { return state + TimerDependentBound::state_size(); }
  static bool is_lost(const double* state) { return std::isinf(state[kW]); }
  bool is_too_soon(const double* state) const { return time_of(0, state) < shortest(0); }

  /// V where x stayed, and x̂ alone jumped; 0 where that is not so.
  double told_twice(const JumpMotion& motion, const double* state) const {
    if (!is_too_soon(state)) return 0.0;
    const double stayed = largest_here(stayed_, state) * std::sqrt(state[kW]);
    return raised(squared_norm(stayed + moved_ * motion.moved));
  }

  void go_on_from(double W, double* state) const {
    state[kW] = W;
    state[kTimers] = 0.0;
    // A law takes no output of before a jump for one of after it.
    HeldOutput::forget(held(state));
  }

  void compute_outputs(const TimerDependentFunction& function, const CertificateSubject& subject,
                       const NamedMatrices& values, const std::vector<Eigen::MatrixXd>& P,
                       const ErrorAssumptions& assumptions) {
    const Eigen::MatrixXd& C_c = subject.plant.mode().C_c;
    const auto L_c = values.find("L_c");
    // Where nothing is held, A - L_c C_c does not have the second term.
    std::vector<Eigen::MatrixXd> F;
    for (const MatrixExpression& flow : plant_flows(subject.plant)) {
      F.push_back(evaluate(flow, values));
    }
    const LateFlow::Growth before =
        LateFlow::growth_on_face(function, F, P, 0, assumptions.disturbance);
    const LateFlow::Growth late =
        LateFlow::growth_on_face(function, F, P, 1, assumptions.disturbance);
    free_ = {std::max(before.rate, late.rate), std::max(before.push, late.push)};
    double taken = 0.0;   // |d|_P per |h|
    double output = 0.0;  // |C_c e| per |e|_P
    for (const Eigen::MatrixXd& P_k : P) {
      const double of_f = injection_gain(P_k, assumptions);
      const double of_L_c = L_c == values.end() ? 0.0 : norm_into(P_k, L_c->second);
      injection_ = std::max(injection_, raised(of_f + of_L_c));
      taken = std::max(taken, of_f);
      const Eigen::MatrixXd inverse = inverse_above(P_k, positive_least_eigenvalue(P_k, "P"));
      output =
          std::max(output, std::sqrt(largest_eigenvalue_above(C_c * inverse * C_c.transpose())));
    }
    free_.rate += raised(taken * raised(output));
  }

  bool corrects_at_jumps_;
  bool holds_;
  HeldOutput held_;
  std::vector<double> uncorrected_;  // ‖A_d‖ from the norm of P_k to that of P_0
  std::vector<double> stayed_;       // ‖I‖, likewise
  double moved_ = 0.0;               // |e|_P_0 of |e| = 1
  LateFlow::Growth free_;            // where no output is held
  double injection_ = 0.0;           // per |h| of what is held
};

}  // namespace

std::unique_ptr<const ErrorBound> timer_dependent_jump_bound(const TimerDependentFunction& function,
                                                             const CertificateSubject& subject,
                                                             const NamedMatrices& values,
                                                             const ErrorAssumptions& assumptions) {
  if (assumptions.jump_stamp_error > 0.0) {
    throw std::invalid_argument(
        "jumps/stamp_error: the theorem's bound takes each jump at its stamp");
  }
  auto bound =
      std::make_unique<const TimerDependentJumpBound>(function, subject, values, assumptions);
  if (bound->holds_outputs()) require_output_rate(assumptions);
  return bound;
}

}  // namespace sampled_data_observers
