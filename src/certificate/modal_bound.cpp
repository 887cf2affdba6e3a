#include "certificate/modal_bound.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "certificate/bound_flow.h"
#include "certificate/held_output.h"
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

/// A jump whose reset waits: `kNext` and `kShift` are of the estimate that flows on from that reset
/// as the plant flows, without outputs.
class HeldOutputBound : public IntervalBound {
 public:
  HeldOutputBound(const CertificateSubject& subject, const std::vector<ModalProof>& modes,
                  double flow_decay, const ErrorAssumptions& assumptions)
      : IntervalBound(subject, assumptions, kEntries),
        norms_(subject, modes, assumptions),
        rate_(-flow_decay / 2.0),
        takes_delays_(modes.size() == 1 && !assumptions.injection_lipschitz) {
    for (std::size_t mode = 0; mode < modes.size(); ++mode) {
      held_.emplace_back(assumptions, norms_.at(static_cast<double>(mode)).output);
    }
  }

  bool follows_law() const override { return true; }
  bool holds_outputs() const override { return true; }
  bool takes_delays() const override { return takes_delays_; }

  void look_at(const LawAtWork& law, double* state) const override {
    if (is_lost(state)) return;
    double* values = numbers(state);
    const ModalNorms::OfMode& norms = norms_.at(static_cast<double>(law.mode));
    if (values[kMode] == kUntold) {
      values[kMode] = static_cast<double>(law.mode);
      values[kError] *= norms.per_error;
    }
    held_[law.mode].look_at(law.innovation, values[kError] / norms.least, values + kHeld);
  }

  void output(double* state) const override { held_.front().take_message(numbers(state) + kHeld); }
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
    HeldOutput::forget(values + kHeld);
    begin_interval(state);
  }

  void change_awaited_speed(double speed, double* state) const override {
    double* values = numbers(state);
    values[kSpeed] = raised(norms_.at(values[kMode]).per_error * speed);
  }
  void release(double* state) const override {
    if (is_lost(state)) return;
    double* values = numbers(state);
    values[kError] = values[kNext] + values[kShift];
    values[kIsAwaited] = values[kNext] = values[kShift] = values[kSpeed] = 0.0;
  }

 protected:
  void begin_numbers(double error, double* values) const override {
    std::fill_n(values, kEntries, 0.0);
    values[kError] = error;
    values[kMode] = kUntold;
  }

  void flow_numbers(double duration, const Interval&, double* values) const override {
    const ModalNorms::OfMode& norms = norms_.at(values[kMode]);
    if (values[kIsAwaited] != 0.0) {
      values[kNext] = flowed_linearly(values[kNext], norms.growth, norms.push, duration);
      values[kShift] = flowed_linearly(values[kShift], norms.growth, values[kSpeed], duration);
    }
    if (!HeldOutput::is_known(values + kHeld)) {
      const double growth = norms.growth + norms.free_injection;
      values[kError] = flowed_linearly(values[kError], growth, norms.push, duration);
      return;
    }
    const HeldOutput& held = held_[static_cast<std::size_t>(values[kMode])];
    values[kError] =
        held.flowed(values[kError], rate_, norms.push, norms.injection, duration, values + kHeld);
    HeldOutput::advance(duration, values + kHeld);
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
  enum Entry : Eigen::Index {
    kError,      ///< at least |e| in the norm of the mode's P
    kMode,       ///< its position, or kUntold
    kIsAwaited,  ///< whether a reset waits
    kNext,       ///< likewise, of the error of the estimate that flows from it
    kShift,      ///< by how much that one has moved since the jump, in the same norm
    kSpeed,      ///< how fast it moves there
    kHeld,       ///< HeldOutput
    kEntries = kHeld + HeldOutput::kEntries
  };

  void go_on(double factor, double noise, const JumpMotion& motion, double* state) const {
    if (is_lost(state)) return;
    double* values = numbers(state);
    const double before = values[kError];
    double after = factor * before + noise;
    const auto mode = static_cast<double>(motion.mode);
    const double moved = raised(norms_.at(mode).per_error * motion.moved);
    // Sooner than T1 it may have been told twice, before the estimate began, too: then x stayed
    // where it was, and only x̂ jumped.
    if (is_too_soon(interval(state).tau) && values[kMode] == mode) {
      after = std::max(after, before + moved);
    }
    values[kError] = after;
    values[kMode] = mode;
    // A law takes no output of before a jump for one of after it; and one that waits goes on
    // holding what it held.
    HeldOutput::forget(values + kHeld);
    values[kIsAwaited] = 0.0;
    if (motion.awaited_speed) {
      values[kIsAwaited] = 1.0;
      values[kNext] = after;
      values[kShift] = 0.0;
      values[kError] = after + moved;
      change_awaited_speed(*motion.awaited_speed, state);
    }
    begin_interval(state);
  }

  ModalNorms norms_;
  double rate_;
  bool takes_delays_;
  std::vector<HeldOutput> held_;  ///< one for each mode
};

class SwitchBound : public IntervalBound {
 public:
  SwitchBound(const CertificateSubject& subject, const std::vector<ModalProof>& modes,
              std::optional<double> jump_decay, const ErrorAssumptions& assumptions)
      : IntervalBound(subject, assumptions, kEntries), norms_(subject, modes, assumptions) {
    if (jump_decay) contraction_ = raised(std::exp(-*jump_decay));
  }

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
    if (contraction_ && !is_first && switches && is_foreseen(tau)) {
      carried = std::min(carried, *contraction_ * values[kAfterSwitch]);
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
  std::optional<double> contraction_;
};

}  // namespace

std::unique_ptr<const ErrorBound> held_output_bound(const CertificateSubject& subject,
                                                    const std::vector<ModalProof>& modes,
                                                    double flow_decay,
                                                    const ErrorAssumptions& assumptions) {
  refuse_uncertain_stamps(assumptions);
  require_output_rate(assumptions);
  return std::make_unique<const HeldOutputBound>(subject, modes, flow_decay, assumptions);
}

std::unique_ptr<const ErrorBound> switch_bound(const CertificateSubject& subject,
                                               const std::vector<ModalProof>& modes,
                                               std::optional<double> jump_decay,
                                               const ErrorAssumptions& assumptions) {
  refuse_uncertain_stamps(assumptions);
  return std::make_unique<const SwitchBound>(subject, modes, jump_decay, assumptions);
}

}  // namespace sampled_data_observers
