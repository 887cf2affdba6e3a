#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sampled_data_observers/observer/innovation_watch.h"
#include "sampled_data_observers/runtime/publication_grid.h"
#include "sampled_data_observers/runtime/runtime_setup.h"

namespace sampled_data_observers {

/// What a nodelet and a replay do alike: events in, their statuses and the estimates that are due
/// out. Only where messages come from and go to, and what time it is, differs.
/// To be used by one thread at a time.
class ObserverRuntime {
 public:
  /// @throws std::invalid_argument for options out of range.
  explicit ObserverRuntime(const RuntimeSetup& setup);

  /// Takes in an event that arrived at `now`.
  EventReport receive(const Event& event, Stamp now);

  /// Takes note of what can't be taken in as an event, with the stamp of `event`.
  EventReport reject(const Event& event, EventOutcome outcome, Stamp now);

  /// The next estimate due at `now`, if any: to be called until there is none. With
  /// `publish_on_event` the last one is that of `now`, where an event was used since the last call.
  const Estimate* next_due(Stamp now);

  /// Whether next_due() may give another one at `now`.
  bool is_due(Stamp now) const;

  /// The time at which the estimate after those due at `now` becomes due.
  Stamp next_due_time(Stamp now) const { return grid_.next_due_time(now); }

  /// How long the estimate of a stamp is overdue at `now` [ns].
  Duration lateness(Stamp stamp, Stamp now) const { return now - stamp - setup_.publish_delay; }

  /// The estimate at any stamp; nothing, and why in `reason`, where there is none.
  const Estimate* estimate_at(Stamp stamp, std::string& reason);

  /// Begins to compute the same at `now`. Returns why there is none, or null.
  const char* begin_query(Stamp stamp, Stamp now, EstimateQuery& query) const;

  // Where plants are integrated step by step, what comes after a while without events takes many
  // steps. These go so many of them and change no estimate, so that a caller who shares the runtime
  // can let others have it in between. They return how many are left: see Timeline::approach().

  /// Towards the estimate that next_due() would give.
  std::int64_t approach_next_due(Stamp now, std::int64_t steps) const;
  /// Towards receive() of an event.
  std::int64_t approach(const Event& event, Stamp now, std::int64_t steps) const;
  /// Towards take_over() of this runtime at `now`.
  std::int64_t approach(Stamp now, std::int64_t steps) const {
    return estimator_.approach(now, steps);
  }

  /// Starts again at `now`: from the configured initial estimate where `estimate` is empty.
  /// Returns why nothing was changed, or an empty text.
  std::string restart(Stamp now, const std::vector<double>& estimate);

  /// Starts again at the next sample stamped after `now` (Estimator::restart_at_next_sample()).
  /// Returns why nothing was changed, or an empty text.
  std::string restart_at_next_sample(Stamp now);

  /// Forgets everything, since time went back to `now`: estimates begin again with the first event.
  void start_anew(Stamp now);

  /// Off: no estimates, and every event is rejected as disabled. Switched on again, estimates go on
  /// at `now` (Estimator::resume()), with their bound where no input or jump was rejected.
  void set_enabled(bool enabled, Stamp now);

  /// Off: every event of this sensor is rejected as disabled. Returns why nothing was changed, or
  /// an empty text.
  std::string enable_sensor(const std::string& name, bool enabled);

  /// Goes on at `now` where `other` is, a runtime of the same configuration but for its gains,
  /// which is only to be destroyed afterwards; see Estimator::take_over().
  void take_over(ObserverRuntime& other, Stamp now);

  /// The bound on the error of an estimate as it can be given now (Estimator::bound()).
  PublishedBound bound(const Estimate& estimate) const { return estimator_.bound(estimate, now_); }

  /// Those on its entries (Estimator::state_bounds()).
  void state_bounds(const Estimate& estimate, Eigen::Ref<Eigen::VectorXd> bounds) {
    estimator_.state_bounds(estimate, now_, bounds);
  }

  /// The ellipsoid that holds its error (Estimator::error_ellipsoid()).
  void error_ellipsoid(const Estimate& estimate, Eigen::Ref<Eigen::MatrixXd> Q) {
    estimator_.error_ellipsoid(estimate, now_, Q);
  }

  /// The observer and its events, to be looked at.
  const Estimator& estimator() const { return estimator_; }
  /// What it was made from.
  const RuntimeSetup& setup() const { return setup_; }

  /// What the innovations of a sensor do.
  InnovationTrend innovation_trend(std::size_t sensor) const { return watches_[sensor].trend(); }

 private:
  bool is_enabled(const Event& event) const;
  const char* objection_to_queries() const;
  bool comes_after_bound(const Event& event, const EventReport& report) const;
  bool is_bound_before_gap(const Event& event) const;
  void watch_innovation(const Event& event, EventReport& report);
  void forget_innovations();

  const RuntimeSetup setup_;
  Estimator estimator_;
  PublicationGrid grid_;
  /// The time of the last call that told it.
  Stamp now_ = 0;
  /// The newest stamp of an estimate that was given out with a finite bound.
  Stamp bounded_until_ = 0;
  bool enabled_ = true;
  /// One per sensor.
  std::vector<bool> sensors_enabled_;
  /// One per sensor, of those since the estimate began.
  std::vector<InnovationWatch> watches_;
  /// Whether an event asks for an estimate at once.
  bool event_waits_ = false;
};

}  // namespace sampled_data_observers
