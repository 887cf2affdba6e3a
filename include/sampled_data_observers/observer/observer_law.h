#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "sampled_data_observers/hybrid/hybrid_system.h"
#include "sampled_data_observers/observer/bound_loss.h"
#include "sampled_data_observers/observer/law_gains.h"

namespace sampled_data_observers {

/// An observer as a hybrid system: a flow map between events and reset maps at them, over one state
/// vector whose first entries are the estimate.
///
/// A law is built once from a valid configuration and is const ever after; see HybridSystem for
/// what its maps may and may not do. An observer type derives from PlantObserver, which brings what
/// all observers of a plant share.
class ObserverLaw : public HybridSystem {
 public:
  /// Names of the estimated states, in the order of the state vector.
  virtual const std::vector<std::string>& estimate_names() const = 0;

  /// What it computes with beside its plant. By default nothing, so that no certificate can be
  /// about it.
  virtual LawGains gains() const { return {}; }

  /// Number of estimated states: the first entries of the state vector.
  Eigen::Index estimate_size() const { return static_cast<Eigen::Index>(estimate_names().size()); }

  /// Whether the law knows the mode that a jump event names. @pre event_size() accepts the event
  virtual bool knows_mode(const Event& event) const = 0;

  /// What is held in a state: the input, and behind it the continuous outputs. For laws of one
  /// plant it has one form.
  virtual const double* held_part(const double* state) const = 0;

  /// Takes over what is held, as held_part() of a law of the same plant gives it.
  virtual void keep_held(const double* part, double* state) const = 0;

  /// The mode that holds in a state, as its position among the plant's.
  virtual double mode_of(const double* state) const = 0;

  /// Takes over a mode, as mode_of() of a law of the same plant gives it.
  virtual void keep_mode(double mode, double* state) const = 0;

  /// Moves the estimate of an initialized state the least (in the norm |·|) so that it fits a
  /// sample of a sensor whose output is affine in the state; leaves it where it is for other
  /// outputs.
  virtual void fit_to(const Event& sample, double* state, double* workspace) const = 0;

  /// Sets the estimate (estimate_size() entries, which may be the state's own) of an initialized
  /// state.
  virtual void start_from(const double* estimate, double* state) const = 0;

  /// The covariance of the estimate in a state, a symmetric matrix of estimate_size() rows; null
  /// where the law has none.
  virtual const double* covariance(const double* state) const {
    static_cast<void>(state);
    return nullptr;
  }

  /// The innovation y − h(x̂, u) of a sample, angles wrapped: event.size entries.
  virtual void innovation(const Event& sample, const double* state, double* innovation) const = 0;

  /// The Mahalanobis distance √(νᵀ S⁻¹ ν) of a sample's innovation ν, whose covariance is S; NaN
  /// where the law has no covariance.
  virtual double mahalanobis_distance(const Event& sample, const double* state,
                                      double* workspace) const {
    static_cast<void>(sample);
    static_cast<void>(state);
    static_cast<void>(workspace);
    return std::numeric_limits<double>::quiet_NaN();
  }

  /// A guaranteed bound on the norm |x − x̂| of the estimate's error in a state, units of the state:
  /// infinite where what it rests on did not hold, NaN where the law gives none.
  virtual double error_bound(const double* state) const {
    static_cast<void>(state);
    return std::numeric_limits<double>::quiet_NaN();
  }

  /// Why error_bound() is infinite in a state.
  virtual BoundLoss bound_loss(const double* state) const {
    static_cast<void>(state);
    return BoundLoss::kNone;
  }

  /// Takes over what is known of the error of the estimate of a state that begins, for laws that
  /// give a bound on it.
  virtual void keep_bound(const PublishedBound& bound, double* state) const {
    static_cast<void>(bound);
    static_cast<void>(state);
  }

  /// Whether a state of the estimate stands at a bound that the law keeps it within.
  virtual bool is_saturated(const double* state) const {
    static_cast<void>(state);
    return false;
  }

  /// Whether a jump's reset waits for a release event (see DelayedJumps).
  virtual bool delays_jumps() const { return false; }
};

}  // namespace sampled_data_observers
