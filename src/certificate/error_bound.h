#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>

namespace sampled_data_observers {

/// What is known beforehand of what an observer meets.
struct ErrorAssumptions {
  double initial_error = 0.0;  ///< |x − x̂| <= this where the estimate begins, units of the state
  double noise = 0.0;          ///< |η| <= this at every measurement, units of the outputs
  double disturbance = 0.0;    ///< |w| <= this at all times, units of w
  /// |θ| of what an observer with intersample injection adds before its first sample.
  double initial_injection = 0.0;
  double jump_stamp_error = 0.0;  ///< by how much the stamps of jumps may be off [s]
  /// How far a continuous output moves per second at most, between jumps: units of the outputs/s.
  std::optional<double> output_rate = std::nullopt;
  /// n, where the law injects an output y that picks a state into its flow (OutputInjection):
  /// |f_i(x with y) − f_i(x with y')| <= injection_lipschitz(i) |y − y'| for all x, y, y'.
  std::optional<Eigen::VectorXd> injection_lipschitz = std::nullopt;
};

/// What a jump of the plant does to an estimate.
struct JumpMotion {
  /// |x̂⁺ − x̂|, by which a jump that was told twice takes the estimate away at most; of a jump that
  /// the law refused |g(x̂) − x̂|, g the plant's jump map.
  double moved = 0.0;
  // Where the stamps of jumps may be off:
  double speed_before = 0.0;  ///< |f(x̂)|, f the plant's flow
  double speed_after = 0.0;   ///< |f(g(x̂))|
  std::size_t mode = 0;       ///< the one that follows, by its position among the plant's
  /// Where x̂ stays for now, and x̂⁺ waits for its release: |f(x̂⁺)|.
  std::optional<double> awaited_speed = std::nullopt;
};

/// What a law does from an event on, as far as its error depends on it.
struct LawAtWork {
  std::size_t mode = 0;  ///< of the plant, by its position
  /// |y_c − C_c x̂| of the continuous output that the law holds; nothing where it holds none.
  std::optional<double> innovation = std::nullopt;
};

/// How a certificate bounds the estimation error x − x̂ along flow and events, its norm, each of its
/// entries and the ellipsoid that it lies in: a small hybrid system of its own, driven by the same
/// events as the observer, so that the bounds are functions of them, too.
///
/// Its maps allocate nothing and throw nothing; what they need beside the state they find at
/// `workspace`. Where the events leave the set for which the theorem holds, for example by a time
/// between samples longer than T2, it goes on with what the flow makes of the error at most. A
/// bound of infinity says that nothing is known any more. It stays until the estimate begins anew.
///
/// Where the stamps of jumps may be off, it is about the plant as its jumps are told: at a stamp
/// between a jump and the telling of it, the error is taken of the plant that goes on as if it had
/// not jumped, or had jumped already.
class ErrorBound {
 public:
  ErrorBound() = default;
  ErrorBound(const ErrorBound&) = delete;
  ErrorBound& operator=(const ErrorBound&) = delete;
  virtual ~ErrorBound() = default;

  /// Number of entries of its state.
  virtual Eigen::Index state_size() const = 0;

  /// Number of entries that sample(), state_bounds() and ellipsoid() need in `workspace`.
  virtual Eigen::Index workspace_size() const { return 0; }

  /// The state where the estimate begins (at any time before the first sample).
  virtual void initialize(double* state) const = 0;

  /// The same where |x − x̂| <= error is known of it. @pre error >= 0, finite
  virtual void begin(double error, double* state) const = 0;

  /// The same right after a sample, where only that much is known of it.
  /// @param sensor  as for sample()
  virtual void begin_at_sample(std::size_t sensor, double error, double* state) const {
    static_cast<void>(sensor);
    begin(error, state);
  }

  /// After one of these, where (x − x̂)(x − x̂)ᵀ <= Q is known, too: n x n, symmetric, finite. By
  /// default that is not made use of.
  virtual void narrow(const Eigen::Ref<const Eigen::MatrixXd>& Q, double* state) const {
    static_cast<void>(Q);
    static_cast<void>(state);
  }

  /// Carries the state over `duration` >= 0 [s], the time since the last sample, jump or message
  /// that holds_outputs() is about: the double nearest to a whole number of nanoseconds, so that it
  /// compares with T1 and T2 as they are written. It is not split: GuaranteedBound starts again
  /// from that event.
  virtual void flow(double duration, double* state) const = 0;

  /// At a sample.
  /// @param sensor  its position among the sensors of the plant
  virtual void sample(std::size_t sensor, double* state, double* workspace) const = 0;

  /// Whether the law injects something of a sample until the next one, so that a sample does more
  /// than move x̂.
  virtual bool injects_between_samples() const { return false; }

  /// By how much the stamps of jumps may be off [s].
  virtual double jump_stamp_error() const { return 0.0; }

  /// Whether its theorem lets the plant make several jumps at one time.
  virtual bool lets_jumps_coincide() const { return false; }

  /// Whether look_at() is to be called.
  virtual bool follows_law() const { return false; }

  /// Told where an interval begins, before the flow or jump that follows, once or more often.
  virtual void look_at(const LawAtWork& law, double* state) const {
    static_cast<void>(law);
    static_cast<void>(state);
  }

  /// Whether intervals begin at messages of a continuous output, too, which is held between them.
  virtual bool holds_outputs() const { return false; }

  /// At such a message.
  virtual void output(double* state) const { static_cast<void>(state); }

  /// At a jump of the plant.
  virtual void jump(const JumpMotion& motion, double* state) const = 0;

  /// At a jump of the plant whose outputs, which the law corrects with, did not come: x̂ only takes
  /// the jump map.
  virtual void uncorrected_jump(const JumpMotion& motion, double* state) const {
    jump(motion, state);
  }

  /// At a jump that was told and that the law did not take, so that the plant may have jumped or
  /// not.
  virtual void refused_jump(const JumpMotion& motion, double* state) const { jump(motion, state); }

  /// Whether it bounds what jumps do whose resets wait for a release (see DelayedJumps).
  virtual bool takes_delays() const { return false; }

  /// While a reset x̂⁺ waits, the input changes, and |f(x̂⁺)| with it.
  virtual void change_awaited_speed(double speed, double* state) const {
    static_cast<void>(speed);
    static_cast<void>(state);
  }

  /// x̂ becomes the x̂⁺ that waited.
  virtual void release(double* state) const { static_cast<void>(state); }

  /// The bound on |x − x̂|, units of the state.
  virtual double bound(const double* state) const = 0;

  /// Bounds on |x_j − x̂_j| of each state, in its units; infinite where bound() is. By default
  /// bound() for each: GuaranteedBound takes the smaller one.
  /// @param bounds  n, is written
  virtual void state_bounds(const double* state, double* workspace,
                            Eigen::Ref<Eigen::VectorXd> bounds) const {
    static_cast<void>(workspace);
    bounds.setConstant(bound(state));
  }

  /// The ellipsoid that holds the error: (x − x̂)(x − x̂)ᵀ <= Q, that is (x − x̂)ᵀ Q⁻¹ (x − x̂) <= 1
  /// where Q > 0. By default the ball of radius bound().
  /// @param Q  n x n, symmetric, is written; not finite where the bound is infinite
  virtual void ellipsoid(const double* state, double* workspace,
                         Eigen::Ref<Eigen::MatrixXd> Q) const {
    static_cast<void>(workspace);
    set_to_ball(bound(state), Q);
  }

 protected:
  static void set_to_ball(double radius, Eigen::Ref<Eigen::MatrixXd> Q) {
    Q.setZero();
    Q.diagonal().setConstant(radius * radius);
  }
};

}  // namespace sampled_data_observers
