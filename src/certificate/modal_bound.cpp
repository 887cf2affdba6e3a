#include "certificate/modal_bound.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "certificate/bound_flow.h"
#include "certificate/interval_bound.h"
#include "certificate/modal_norms.h"
#include "certificate/outward.h"

namespace sampled_data_observers {
namespace {

/// Of the mode in a bound that has begun and was not told yet in which one: its numbers are of the
/// norm |e| itself.
constexpr double kUntold = -1.0;

void refuse_uncertain_stamps(const ErrorAssumptions& assumptions) {
  if (assumptions.jump_stamp_error == 0.0) return;
  throw std::invalid_argument(
      "jumps/stamp_error: the theorem's bound takes each jump at its stamp");
}

class HeldOutputBound : public IntervalBound {
 public:
  HeldOutputBound(const CertificateSubject& subject, const std::vector<ModalProof>& modes,
                  double flow_decay, double output_rate, const ErrorAssumptions& assumptions)
      : IntervalBound(subject, assumptions, kEntries),
        norms_(subject, modes, assumptions),
        rate_(-flow_decay / 2.0),
        noise_(assumptions.noise),
        output_rate_(output_rate) {}

  bool follows_law() const override { return true; }
  bool holds_outputs() const override { return true; }

  void look_at(const LawAtWork& law, double* state) const override {
    if (is_lost(state)) return;
    double* values = numbers(state);
    const ModalNorms::OfMode& norms = norms_.at(static_cast<double>(law.mode));
    if (values[kMode] == kUntold) {
      values[kMode] = static_cast<double>(law.mode);
      values[kError] *= norms.per_error;
    }
    if (!law.innovation) {
      values[kIsHeld] = 0.0;
    } else if (values[kIsHeld] == 0.0) {
      const double error = values[kError] / norms.least;
      hold(raised(*law.innovation) + norms.output * error, values);
    }
  }

  void output(double* state) const override { hold(noise_, numbers(state)); }
  void sample(std::size_t, double*, double*) const override {}

  void jump(const JumpMotion& motion, double* state) const override {
    const ModalNorms::OfMode& norms = norms_.at(numbers(state)[kMode]);
    go_on(norms.reset[motion.mode], norms.noise, motion, state);
  }
  void uncorrected_jump(const JumpMotion& motion, double* state) const override {
    go_on(norms_.at(numbers(state)[kMode]).uncorrected[motion.mode], 0.0, motion, state);
  }
  void refused_jump(const JumpMotion& motion, double* state) const override {
    double* values = numbers(state);
    const ModalNorms::OfMode& norms = norms_.at(values[kMode]);
    const double jumped =
        norms.uncorrected[motion.mode] * values[kError] + norms.per_error * motion.moved;
    values[kError] = std::max(values[kError], jumped);
    // The law holds what it held, which may have been measured before a jump.
    values[kIsHeld] = 0.0;
    begin_interval(state);
  }

 protected:
  void begin_numbers(double error, double* values) const override {
    values[kError] = error;
    values[kMode] = kUntold;
    values[kIsHeld] = values[kSince] = values[kOffset] = 0.0;
  }

  void flow_numbers(double duration, const Interval&, double* values) const override {
    const ModalNorms::OfMode& norms = norms_.at(values[kMode]);
    if (values[kIsHeld] == 0.0) {
      values[kError] = flowed_linearly(values[kError], norms.growth, norms.push, duration);
      return;
    }
    const double held = values[kOffset] + output_rate_ * values[kSince];
    values[kError] =
        flowed_linearly(values[kError], rate_, norms.push + norms.injection * held, duration) +
        norms.injection * output_rate_ * integral_of_ramp(rate_, duration);
    values[kSince] += duration;
  }

  double error(const Interval&, const double* values) const override {
    const double error = values[kError];
    return values[kMode] == kUntold ? error : error / norms_.at(values[kMode]).least;
  }
  void errors(const Interval& at, const double* values, double* workspace,
              Eigen::Ref<Eigen::VectorXd> bounds) const override {
    if (values[kMode] == kUntold) return IntervalBound::errors(at, values, workspace, bounds);
    norms_.at(values[kMode]).set.bounds(values[kError], bounds);
  }
  void error_ellipsoid(const Interval& at, const double* values, double* workspace,
                       Eigen::Ref<Eigen::MatrixXd> Q) const override {
    if (values[kMode] == kUntold) return IntervalBound::error_ellipsoid(at, values, workspace, Q);
    norms_.at(values[kMode]).set.ellipsoid(values[kError], Q);
  }

 private:
  enum Entry {
    kError,   ///< at least |e| in the norm of the mode's P
    kMode,    ///< its position, or kUntold
    kIsHeld,  ///< whether |y_held − C_c x| is bounded by the next two
    kSince,   ///< time since that was kOffset at most [s]
    kOffset,
    kEntries
  };

  static void hold(double offset, double* values) {
    values[kIsHeld] = 1.0;
    values[kSince] = 0.0;
    values[kOffset] = offset;
  }

  void go_on(double factor, double noise, const JumpMotion& motion, double* state) const {
    if (is_lost(state)) return;
    double* values = numbers(state);
    const double before = values[kError];
    double after = factor * before + noise;
    const auto mode = static_cast<double>(motion.mode);
    // Sooner than T1 it may have been told twice, before the estimate began, too: then x stayed
    // where it was, and only x̂ jumped.
    if (is_too_soon(interval(state).tau) && values[kMode] == mode) {
      after = std::max(after, before + norms_.at(mode).per_error * motion.moved);
    }
    values[kError] = after;
    values[kMode] = mode;
    values[kIsHeld] = 0.0;  // a law takes no output of before a jump for one of after it
    begin_interval(state);
  }

  ModalNorms norms_;
  double rate_;
  double noise_;
  double output_rate_;
};

class SwitchBound : public IntervalBound {
 public:
  SwitchBound(const CertificateSubject& subject, const std::vector<ModalProof>& modes,
              double jump_decay, const ErrorAssumptions& assumptions)
      : IntervalBound(subject, assumptions, kEntries),
        norms_(subject, modes, assumptions),
        contraction_(raised(std::exp(-jump_decay))) {}

  bool follows_law() const override { return true; }

  void look_at(const LawAtWork& law, double* state) const override {
    double* values = numbers(state);
    if (is_lost(state) || values[kMode] != kUntold) return;
    values[kMode] = static_cast<double>(law.mode);
    values[kAfterSwitch] *= norms_.at(values[kMode]).per_error;
  }

  void sample(std::size_t, double*, double*) const override {}

  void jump(const JumpMotion& motion, double* state) const override {
    if (is_lost(state)) return;
    const double* values = numbers(state);
    const auto [tau, is_first] = interval(state);
    const ModalNorms::OfMode& norms = norms_.at(values[kMode]);
    const double factor = norms.reset[motion.mode];
    double carried = factor * flowed_linearly(values[kAfterSwitch], norms.growth, 0.0, tau);
    const bool switches = values[kMode] != static_cast<double>(motion.mode);
    if (!is_first && switches && is_foreseen(tau)) {
      carried = std::min(carried, contraction_ * values[kAfterSwitch]);
    }
    go_on(carried + factor * values[kCausedSince] + norms.noise, motion, state);
  }
  void uncorrected_jump(const JumpMotion& motion, double* state) const override {
    if (is_lost(state)) return;
    const double factor = norms_.at(numbers(state)[kMode]).uncorrected[motion.mode];
    go_on(factor * before_jump(state), motion, state);
  }
  void refused_jump(const JumpMotion&, double* state) const override { lose(state); }

 protected:
  void begin_numbers(double error, double* values) const override {
    values[kAfterSwitch] = error;
    values[kCausedSince] = 0.0;
    values[kMode] = kUntold;
  }

  void flow_numbers(double duration, const Interval&, double* values) const override {
    const ModalNorms::OfMode& norms = norms_.at(values[kMode]);
    values[kCausedSince] =
        flowed_linearly(values[kCausedSince], norms.growth, norms.push, duration);
  }

  double error(const Interval& at, const double* values) const override {
    if (values[kMode] == kUntold) return values[kAfterSwitch];
    return weighted_error(at, values) / norms_.at(values[kMode]).least;
  }
  void errors(const Interval& at, const double* values, double* workspace,
              Eigen::Ref<Eigen::VectorXd> bounds) const override {
    if (values[kMode] == kUntold) return IntervalBound::errors(at, values, workspace, bounds);
    norms_.at(values[kMode]).set.bounds(weighted_error(at, values), bounds);
  }
  void error_ellipsoid(const Interval& at, const double* values, double* workspace,
                       Eigen::Ref<Eigen::MatrixXd> Q) const override {
    if (values[kMode] == kUntold) return IntervalBound::error_ellipsoid(at, values, workspace, Q);
    norms_.at(values[kMode]).set.ellipsoid(weighted_error(at, values), Q);
  }

 private:
  /// Of |e| in the norm of the mode's P, two parts as of JumpBasedBound, and the mode or kUntold.
  enum Entry { kAfterSwitch, kCausedSince, kMode, kEntries };

  double weighted_error(const Interval& at, const double* values) const {
    const double growth = norms_.at(values[kMode]).growth;
    return flowed_linearly(values[kAfterSwitch], growth, 0.0, at.tau) + values[kCausedSince];
  }
  double before_jump(const double* state) const {
    return weighted_error(interval(state), numbers(state));
  }

  void go_on(double after, const JumpMotion& motion, double* state) const {
    double* values = numbers(state);
    const auto mode = static_cast<double>(motion.mode);
    // As in HeldOutputBound. What leads into another mode is not told twice.
    if (is_too_soon(interval(state).tau) && values[kMode] == mode) {
      after = std::max(after, before_jump(state) + norms_.at(mode).per_error * motion.moved);
    }
    values[kAfterSwitch] = after;
    values[kCausedSince] = 0.0;
    values[kMode] = mode;
    begin_interval(state);
  }

  ModalNorms norms_;
  double contraction_;
};

}  // namespace

std::unique_ptr<const ErrorBound> held_output_bound(const CertificateSubject& subject,
                                                    const std::vector<ModalProof>& modes,
                                                    double flow_decay,
                                                    const ErrorAssumptions& assumptions) {
  refuse_uncertain_stamps(assumptions);
  if (!assumptions.output_rate) {
    throw std::invalid_argument(
        "no output_rate, how fast the continuous output changes at most [its unit/s]: it is held "
        "between its messages");
  }
  return std::make_unique<const HeldOutputBound>(subject, modes, flow_decay,
                                                 *assumptions.output_rate, assumptions);
}

std::unique_ptr<const ErrorBound> switch_bound(const CertificateSubject& subject,
                                               const std::vector<ModalProof>& modes,
                                               double jump_decay,
                                               const ErrorAssumptions& assumptions) {
  refuse_uncertain_stamps(assumptions);
  return std::make_unique<const SwitchBound>(subject, modes, jump_decay, assumptions);
}

}  // namespace sampled_data_observers
