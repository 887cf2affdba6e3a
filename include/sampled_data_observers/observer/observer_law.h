#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "sampled_data_observers/hybrid/hybrid_system.h"
#include "sampled_data_observers/observer/bound_loss.h"

namespace sampled_data_observers {

class PlantObserver;

/// A guaranteed bound on the error of an estimate, kept in the state of a law.
class StateBound {
 public:
  /// A bound on the norm |x − x̂|, units of the state; infinite where what it rests on did not hold.
  virtual double error_bound(const double* state) const = 0;

  /// Why error_bound() is infinite.
  virtual BoundLoss bound_loss(const double* state) const = 0;

  /// Bounds on |x_j − x̂_j| of each estimated state, in its units; infinite where error_bound() is.
  /// By default error_bound() for each. The workspace is the law's; `bounds`, one for each
  /// estimated state, is written.
  virtual void state_bounds(const double* state, double* workspace,
                            Eigen::Ref<Eigen::VectorXd> bounds) const {
    static_cast<void>(workspace);
    bounds.setConstant(error_bound(state));
  }

  /// An ellipsoid that holds the error: (x − x̂)(x − x̂)ᵀ <= Q. By default the ball of error_bound().
  /// The workspace is the law's; Q, with as many rows and columns as estimated states, is written:
  /// with an infinite diagonal where error_bound() is.
  virtual void error_ellipsoid(const double* state, double* workspace,
                               Eigen::Ref<Eigen::MatrixXd> Q) const {
    static_cast<void>(workspace);
    const double radius = error_bound(state);
    Q.setZero();
    Q.diagonal().setConstant(radius * radius);
  }

  /// What keep_bound() of another law is to know. By default what is published.
  virtual PublishedBound known_bound(const double* state) const {
    return {error_bound(state), bound_loss(state)};
  }

  /// Takes over what is known of the error of the estimate of a state that begins.
  virtual void keep_bound(const PublishedBound& bound, double* state) const = 0;

  /// What narrow_bound() of another law is to know. By default the ball of known_bound(). Workspace
  /// and Q as for error_ellipsoid().
  virtual void known_ellipsoid(const double* state, double* workspace,
                               Eigen::Ref<Eigen::MatrixXd> Q) const {
    static_cast<void>(workspace);
    const double radius = known_bound(state).value;
    Q.setZero();
    Q.diagonal().setConstant(radius * radius);
  }

  /// After keep_bound(), takes over what else is known: (x − x̂)(x − x̂)ᵀ <= Q, where that is finite.
  /// By default nothing.
  virtual void narrow_bound(const Eigen::Ref<const Eigen::MatrixXd>& Q, double* state) const {
    static_cast<void>(Q);
    static_cast<void>(state);
  }

  /// Nobody vouches for the estimate any more: see HybridSystem::distrust().
  virtual void give_up(double* state) const = 0;

  /// Whether a jump that was rejected, refused or lost leaves open in which mode a switched plant
  /// is: until a later one takes effect, however often the estimate begins anew meanwhile.
  virtual bool mode_is_open(const double* state) const {
    static_cast<void>(state);
    return false;
  }

  /// That of a state that begins: nothing is known of its error.
  virtual void leave_mode_open(double* state) const { give_up(state); }

  /// Whether it is about plants that may make several jumps at one time.
  virtual bool lets_jumps_coincide() const { return false; }

 protected:
  ~StateBound() = default;
};

/// How the jumps that took effect compare with the times between them that are configured.
enum class DwellCheck : std::uint8_t {
  kNone,    ///< there was no jump
  kWithin,  ///< as they are configured
  kShort,   ///< the time before the jump was too short
  kLong,    ///< it was too long
  kMany,    ///< jumps come too often on average
  kFew      ///< jumps come too seldom on average
};

/// What a law keeps of the times between jumps.
class DwellWatch {
 public:
  /// Of the newest jump.
  virtual DwellCheck dwell_check(const double* state) const = 0;

  /// How often the times left those configured since the start, up to now.
  virtual double dwell_violations(const double* state) const = 0;

 protected:
  ~DwellWatch() = default;
};

/// What a law keeps of the jumps that no event told of.
class JumpWatch {
 public:
  /// How many it noticed since the start.
  virtual double missing_jumps(const double* state) const = 0;

 protected:
  ~JumpWatch() = default;
};

/// An observer as a hybrid system: a flow map between events and reset maps at them, over one state
/// vector whose first entries are the estimate.
///
/// A law is built once from a valid configuration and is const ever after; see HybridSystem for
/// what its maps may and may not do. An observer type derives from PlantObserver, which brings what
/// all observers of a plant share. What is put around it, and changes how it takes its events, is a
/// law, too, whose state begins with the observer's.
class ObserverLaw : public HybridSystem {
 public:
  /// The observer within, which reads a state of this law as its own.
  const PlantObserver& observer() const { return *observer_; }

  /// Names of the estimated states, in the order of the state vector.
  const std::vector<std::string>& estimate_names() const;

  /// Number of estimated states: the first entries of the state vector.
  Eigen::Index estimate_size() const { return static_cast<Eigen::Index>(estimate_names().size()); }

  /// Whether a jump's reset waits for a release event (see DelayedJumps).
  bool delays_jumps() const { return delays_jumps_; }

  /// What a jump leads to whose reset waits, in a state, for its release: a state of observer();
  /// null where none waits.
  virtual const double* awaited(const double* state) const {
    static_cast<void>(state);
    return nullptr;
  }

  /// The mode that follows the last jump that a state was told of, waiting or not, as its position
  /// among the plant's.
  std::size_t told_mode(const double* state) const;

  /// How large the innovation of what a sensor measured is in a state, beside its gate: 1 at the
  /// edge, more outside; NaN where the sensor has no gate.
  virtual double gate_share(const Event& measured, const double* state, double* workspace) const {
    static_cast<void>(measured);
    static_cast<void>(state);
    static_cast<void>(workspace);
    return std::numeric_limits<double>::quiet_NaN();
  }

  /// A guaranteed bound on the norm |x − x̂| of the estimate's error in a state, units of the state:
  /// infinite where what it rests on did not hold, NaN where the law gives none.
  double error_bound(const double* state) const {
    return bound_ != nullptr ? bound_->error_bound(state)
                             : std::numeric_limits<double>::quiet_NaN();
  }

  /// Why error_bound() is infinite in a state.
  BoundLoss bound_loss(const double* state) const {
    return bound_ != nullptr ? bound_->bound_loss(state) : BoundLoss::kNone;
  }

  /// Whether it gives a bound.
  bool has_bound() const { return bound_ != nullptr; }

  /// Bounds on |x_j − x̂_j| of each estimated state: see StateBound.
  /// @pre has_bound()
  void state_bounds(const double* state, double* workspace,
                    Eigen::Ref<Eigen::VectorXd> bounds) const {
    bound_->state_bounds(state, workspace, bounds);
  }

  /// The ellipsoid that holds the error: see StateBound.
  /// @pre has_bound()
  void error_ellipsoid(const double* state, double* workspace,
                       Eigen::Ref<Eigen::MatrixXd> Q) const {
    bound_->error_ellipsoid(state, workspace, Q);
  }

  /// What another law that goes on from the estimate of a state is to know of its error, for its
  /// keep_bound().
  PublishedBound known_bound(const double* state) const {
    return bound_ != nullptr ? bound_->known_bound(state) : PublishedBound{};
  }

  /// Takes over what is known of the error of the estimate of a state that begins, for laws that
  /// give a bound on it.
  void keep_bound(const PublishedBound& bound, double* state) const {
    if (bound_ != nullptr) bound_->keep_bound(bound, state);
  }

  /// What else it is to know, for its narrow_bound(): see StateBound.
  /// @pre has_bound()
  void known_ellipsoid(const double* state, double* workspace,
                       Eigen::Ref<Eigen::MatrixXd> Q) const {
    bound_->known_ellipsoid(state, workspace, Q);
  }

  /// Takes that over, after keep_bound().
  /// @pre has_bound()
  void narrow_bound(const Eigen::Ref<const Eigen::MatrixXd>& Q, double* state) const {
    bound_->narrow_bound(Q, state);
  }

  /// Whether it is open in a state in which mode a switched plant is; always where nobody looks.
  bool mode_is_open(const double* state) const {
    return bound_ == nullptr || bound_->mode_is_open(state);
  }

  /// Takes over that it is open, for laws that give a bound.
  void leave_mode_open(double* state) const {
    if (bound_ != nullptr) bound_->leave_mode_open(state);
  }

  /// Whether a bound is about plants that may make several jumps at one time, so that one told
  /// without a number may be another than one of the same stamp, even where nothing tells them
  /// apart.
  bool lets_jumps_coincide() const { return bound_ != nullptr && bound_->lets_jumps_coincide(); }

  /// How many jumps were noticed in a state that no event told of, since the start; 0 where nothing
  /// looks for them.
  double missing_jumps(const double* state) const {
    return jump_watch_ != nullptr ? jump_watch_->missing_jumps(state) : 0.0;
  }

  /// How many jumps were lost up to a state, as the numbers of the others tell, since the start; 0
  /// where nobody counts.
  double skipped_jumps(const double* state) const {
    return skipped_jumps_ ? skipped_jumps_->of(state) : 0.0;
  }

  /// How often the times between jumps left those configured since the start, up to the time of a
  /// state; 0 where none are.
  double dwell_violations(const double* state) const {
    return dwell_watch_ != nullptr ? dwell_watch_->dwell_violations(state) : 0.0;
  }

  /// How the newest jump of a state compares with the times configured; kNone where none are.
  DwellCheck dwell_check(const double* state) const {
    return dwell_watch_ != nullptr ? dwell_watch_->dwell_check(state) : DwellCheck::kNone;
  }

  /// Whether an estimate may come to rest.
  bool can_rest() const { return at_rest_.has_value(); }

  /// Whether the estimate of a state is at rest, where it does not flow (see RestingEstimate).
  bool is_at_rest(const double* state) const { return at_rest_ && at_rest_->of(state); }

  /// Whether times between jumps are configured.
  bool watches_dwell_times() const { return dwell_watch_ != nullptr; }

  void distrust(double* state) const final {
    if (bound_ != nullptr) bound_->give_up(state);
  }

 protected:
  /// For the observer itself.
  explicit ObserverLaw(const PlantObserver* observer) : observer_(observer) {}

  /// For a law around another one: it begins with all that one is, and says what it changes.
  ObserverLaw(const ObserverLaw&) = default;

  /// To be called where a law gives a bound.
  void set_bound(const StateBound* bound) { bound_ = bound; }
  /// To be called where a law looks for jumps that are missing.
  void set_jump_watch(const JumpWatch* watch) { jump_watch_ = watch; }
  /// To be called where a law counts the jumps that were lost, there.
  void set_skipped_jumps(NumberSlot slot) { skipped_jumps_ = slot; }
  /// To be called where a law keeps, there, whether its estimate is at rest.
  void set_at_rest(FlagSlot slot) { at_rest_ = slot; }
  /// To be called where a law watches the times between jumps.
  void set_dwell_watch(const DwellWatch* watch) { dwell_watch_ = watch; }
  /// To be called where a law delays jumps.
  void set_delays_jumps() { delays_jumps_ = true; }

 private:
  const PlantObserver* observer_;
  const StateBound* bound_ = nullptr;
  const JumpWatch* jump_watch_ = nullptr;
  const DwellWatch* dwell_watch_ = nullptr;
  std::optional<NumberSlot> skipped_jumps_;
  std::optional<FlagSlot> at_rest_;
  bool delays_jumps_ = false;
};

}  // namespace sampled_data_observers
