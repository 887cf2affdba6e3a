#include "certificate/timer_dependent_jump_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
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

/// Of the mode in a bound that has begun and was not told yet in which one: |e| stands for W.
constexpr double kUntoldMode = -1.0;

double squared_norm(double value) { return value * value; }

std::vector<Eigen::MatrixXd> values_of_P(const TimerDependentFunction& function,
                                         const NamedMatrices& values) {
  std::vector<Eigen::MatrixXd> P;
  for (std::size_t k = 0; k < function.grid().size(); ++k) {
    P.push_back(evaluate(function.P(k), values));
  }
  return P;
}

/// What a mode's error does between jumps, and at those that leave it.
class JumpTimerMode {
 public:
  JumpTimerMode(const std::vector<TimerDependentFunction>& functions, std::size_t number,
                const CertificateSubject& subject, const NamedMatrices& values,
                const ErrorAssumptions& assumptions)
      : plant_(subject.plant.modes[number]),
        own_(functions[number], longest_times(subject), values, assumptions),
        held_(assumptions, plant_.C_c.rows() > 0 ? raised(norm2(plant_.C_c)) : 0.0) {
    const TimerDependentFunction& function = functions[number];
    const ErrorReset& reset = function.system().resets.front();
    const std::vector<Eigen::MatrixXd> P = values_of_P(function, values);
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(reset.J.rows(), reset.J.cols());
    const bool corrects = reset.C.rows() > 0;
    const Eigen::MatrixXd K = corrects ? evaluate(reset.K(0), values) : Eigen::MatrixXd();
    MatrixExpression map = reset.J;
    if (corrects) {
      map = map - MatrixExpression(K) * MatrixExpression(reset.C);
    }
    for (const TimerDependentFunction& next : functions) {
      const Eigen::MatrixXd after = evaluate(next.P(0), values);
      Switch& into = into_.emplace_back();
      for (const Eigen::MatrixXd& P_k : P) {
        into.corrected.push_back(norm_between(P_k, after, map));
        into.uncorrected.push_back(norm_between(P_k, after, reset.J));
      }
      if (corrects) into.noise = raised(norm_into(after, K) * assumptions.noise);
    }
    for (const Eigen::MatrixXd& P_k : P) stayed_.push_back(norm_between(P_k, P.front(), identity));
    moved_ = raised(std::sqrt(largest_eigenvalue_above(P.front())));
    compute_outputs(function, number, subject, values, P, assumptions);
  }

  const TimerDependentBound& own() const { return own_; }
  const HeldOutput& held() const { return held_; }
  bool corrects_at_jumps() const { return plant_.C_d.rows() > 0; }

  /// @param held  of the state
  void flow(double duration, bool holds, double* state, double* held) const {
    double& W = state[TimerDependentBound::kW];
    if (!holds) return own_.flow(duration, state);
    if (!HeldOutput::is_known(held)) {
      W = squared_norm(flowed_linearly(std::sqrt(W), free_.rate, free_.push, duration));
      return own_.advance_timers(duration, state);
    }
    const bool is_late = own_.time_of(0, state) + duration > own_.longest(0);
    double growth = -own_.rate() / 2.0;
    if (is_late) growth = std::max(growth, own_.late_flow().growth(1).rate);
    const double off = held_.flowed(0.0, growth, 0.0, injection_, duration, held);
    own_.flow(duration, state);
    W = raised(squared_norm(std::sqrt(W) + off));
    HeldOutput::advance(duration, held);
  }

  // √V just after a jump into a mode.
  double corrected(std::size_t next, const double* state) const {
    return own_.largest_here(into_[next].corrected, state) * root(state) + into_[next].noise;
  }
  double uncorrected(std::size_t next, const double* state) const {
    return own_.largest_here(into_[next].uncorrected, state) * root(state);
  }
  /// As the theorem has it.
  double foreseen(const double* state) const {
    return std::sqrt(raised(own_.foreseen(0, state[TimerDependentBound::kW])));
  }
  /// Where x stayed.
  double stayed(const double* state) const {
    return own_.largest_here(stayed_, state) * root(state);
  }
  /// Of |e| = 1, just after a jump.
  double moved() const { return moved_; }

 private:
  struct Switch {
    std::vector<double> corrected;    ///< ‖J − K C‖ from the norm of P_k to that just after
    std::vector<double> uncorrected;  ///< ‖J‖, likewise
    double noise = 0.0;               ///< |K η| there at most
  };

  static double root(const double* state) { return std::sqrt(state[TimerDependentBound::kW]); }

  void compute_outputs(const TimerDependentFunction& function, std::size_t number,
                       const CertificateSubject& subject, const NamedMatrices& values,
                       const std::vector<Eigen::MatrixXd>& P, const ErrorAssumptions& assumptions) {
    const bool switches = subject.plant.modes.size() > 1;
    const auto L_c = values.find(switches ? of_mode("L_c", plant_) : "L_c");
    // Where nothing is held, A - L_c C_c does not have the second term.
    std::vector<Eigen::MatrixXd> F;
    if (switches) {
      F.push_back(subject.plant.modes[number].A);
    } else {
      for (const MatrixExpression& flow : plant_flows(subject.plant)) {
        F.push_back(evaluate(flow, values));
      }
    }
    const LateFlow::Growth before =
        LateFlow::growth_on_face(function, F, P, 0, assumptions.disturbance);
    const LateFlow::Growth late =
        LateFlow::growth_on_face(function, F, P, 1, assumptions.disturbance);
    free_ = {std::max(before.rate, late.rate), std::max(before.push, late.push)};
    if (plant_.C_c.rows() == 0) return;
    double taken = 0.0;   // |d|_P per |h|
    double output = 0.0;  // |C_c e| per |e|_P
    for (const Eigen::MatrixXd& P_k : P) {
      const double of_f = injection_gain(P_k, assumptions);
      const double of_L_c = L_c == values.end() ? 0.0 : norm_into(P_k, L_c->second);
      injection_ = std::max(injection_, raised(of_f + of_L_c));
      taken = std::max(taken, of_f);
      const Eigen::MatrixXd inverse = inverse_above(P_k, positive_least_eigenvalue(P_k, "P"));
      output = std::max(output, std::sqrt(largest_eigenvalue_above(plant_.C_c * inverse *
                                                                   plant_.C_c.transpose())));
    }
    free_.rate += raised(taken * raised(output));
  }

  ModeMatrices plant_;
  TimerDependentBound own_;
  HeldOutput held_;
  std::vector<Switch> into_;    // each mode
  std::vector<double> stayed_;  // ‖I‖ from the norm of P_k to that of P_0
  double moved_ = 0.0;          // |e|_P_0 of |e| = 1
  LateFlow::Growth free_;       // where no output is held
  double injection_ = 0.0;      // per |h| of what is held
};

/// State: that of TimerDependentBound | the mode | HeldOutput.
class TimerDependentJumpBound : public ErrorBound {
 public:
  TimerDependentJumpBound(const std::vector<TimerDependentFunction>& functions,
                          const CertificateSubject& subject, const NamedMatrices& values,
                          const ErrorAssumptions& assumptions)
      : switches_(functions.size() > 1),
        holds_(subject.plant.mode().C_c.rows() > 0),
        initial_error_(assumptions.initial_error) {
    for (std::size_t mode = 0; mode < functions.size(); ++mode) {
      modes_.push_back(
          std::make_unique<const JumpTimerMode>(functions, mode, subject, values, assumptions));
    }
  }

  Eigen::Index state_size() const override { return mode_from() + 1 + HeldOutput::kEntries; }
  bool follows_law() const override { return switches_ || holds_; }
  bool holds_outputs() const override { return holds_; }

  void initialize(double* state) const override {
    std::fill_n(state, state_size(), 0.0);
    begin(initial_error_, state);
  }
  void begin(double error, double* state) const override {
    if (!switches_) return modes_.front()->own().begin(error, state);
    state[TimerDependentBound::kW] = error;
    state[mode_from()] = kUntoldMode;
  }
  void narrow(const Eigen::Ref<const Eigen::MatrixXd>& Q, double* state) const override {
    if (is_told(state)) own(state).narrow(Q, state);
  }
  void look_at(const LawAtWork& law, double* state) const override {
    if (is_lost(state)) return;
    if (!is_told(state)) {
      state[mode_from()] = static_cast<double>(law.mode);
      own(state).begin(state[TimerDependentBound::kW], state);
    }
    if (holds_) mode(state).held().look_at(law.innovation, bound(state), held(state));
  }
  void output(double* state) const override {
    modes_.front()->held().take_message(held(state));  // the noise is that of all modes
  }

  void flow(double duration, double* state) const override {
    if (is_lost(state)) return;
    mode(state).flow(duration, holds_, state, held(state));
  }
  void sample(std::size_t, double*, double*) const override {}

  void jump(const JumpMotion& motion, double* state) const override {
    if (is_lost(state)) return;
    const JumpTimerMode& from = mode(state);
    if (!from.corrects_at_jumps()) return uncorrected_jump(motion, state);
    double root = from.corrected(motion.mode, state);
    if (is_foreseen(motion, state)) root = std::min(root, from.foreseen(state));
    go_on_from(root, motion, state);
  }
  void uncorrected_jump(const JumpMotion& motion, double* state) const override {
    if (is_lost(state)) return;
    const JumpTimerMode& from = mode(state);
    double root = from.uncorrected(motion.mode, state);
    if (!from.corrects_at_jumps() && is_foreseen(motion, state)) {
      root = std::min(root, from.foreseen(state));
    }
    go_on_from(root, motion, state);
  }
  void refused_jump(const JumpMotion& motion, double* state) const override {
    if (is_lost(state)) return;
    if (switches_) {
      state[TimerDependentBound::kW] = std::numeric_limits<double>::infinity();
      return;
    }
    const JumpTimerMode& from = mode(state);
    const double jumped = from.uncorrected(0, state) + from.moved() * motion.moved;
    set(std::max(from.stayed(state), jumped), 0, state);
  }

  double bound(const double* state) const override {
    return is_told(state) ? own(state).bound(state) : state[TimerDependentBound::kW];
  }
  void state_bounds(const double* state, double* workspace,
                    Eigen::Ref<Eigen::VectorXd> bounds) const override {
    if (!is_told(state)) return ErrorBound::state_bounds(state, workspace, bounds);
    own(state).state_bounds(state, workspace, bounds);
  }
  void ellipsoid(const double* state, double* workspace,
                 Eigen::Ref<Eigen::MatrixXd> Q) const override {
    if (!is_told(state)) return ErrorBound::ellipsoid(state, workspace, Q);
    own(state).ellipsoid(state, workspace, Q);
  }

 private:
  Eigen::Index mode_from() const { return modes_.front()->own().state_size(); }
  double* held(double* state) const { return state + mode_from() + 1; }
  bool is_told(const double* state) const { return state[mode_from()] != kUntoldMode; }
  const JumpTimerMode& mode(const double* state) const {
    return *modes_[static_cast<std::size_t>(state[mode_from()])];
  }
  const TimerDependentBound& own(const double* state) const { return mode(state).own(); }
  static bool is_lost(const double* state) { return std::isinf(state[TimerDependentBound::kW]); }
  bool is_too_soon(const double* state) const {
    return own(state).time_of(0, state) < own(state).shortest(0);
  }
  bool stays(const JumpMotion& motion, const double* state) const {
    return state[mode_from()] == static_cast<double>(motion.mode);
  }
  bool is_foreseen(const JumpMotion& motion, const double* state) const {
    return !is_too_soon(state) && (!switches_ || !stays(motion, state));
  }

  /// After a jump that the law took. One that is sooner than T1 may have been told twice, if it
  /// leads into the same mode: then x stayed, and x̂ alone jumped.
  void go_on_from(double root, const JumpMotion& motion, double* state) const {
    if (is_too_soon(state) && stays(motion, state)) {
      const JumpTimerMode& from = mode(state);
      root = std::max(root, from.stayed(state) + from.moved() * motion.moved);
    }
    set(root, motion.mode, state);
  }
  void set(double root, std::size_t next, double* state) const {
    state[TimerDependentBound::kW] = raised(squared_norm(root));
    state[TimerDependentBound::kTimers] = 0.0;
    state[mode_from()] = static_cast<double>(next);
    // A law takes no output of before a jump for one of after it.
    HeldOutput::forget(held(state));
  }

  bool switches_;
  bool holds_;
  double initial_error_;
  std::vector<std::unique_ptr<const JumpTimerMode>> modes_;
};

}  // namespace

std::unique_ptr<const ErrorBound> timer_dependent_jump_bound(
    const std::vector<TimerDependentFunction>& functions, const CertificateSubject& subject,
    const NamedMatrices& values, const ErrorAssumptions& assumptions) {
  if (assumptions.jump_stamp_error > 0.0) {
    throw std::invalid_argument(
        "jumps/stamp_error: the theorem's bound takes each jump at its stamp");
  }
  auto bound =
      std::make_unique<const TimerDependentJumpBound>(functions, subject, values, assumptions);
  if (bound->holds_outputs()) require_output_rate(assumptions);
  return bound;
}

}  // namespace sampled_data_observers
