#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "sampled_data_observers/hybrid/timeline.h"
#include "sampled_data_observers/observer/observer_law.h"
#include "sampled_data_observers/runtime/event_report.h"

namespace sampled_data_observers {

/// The largest value that an event may carry: no plant has a larger one, and sums of such stay
/// finite.
constexpr double kLargestValue = 1e100;

/// Whether all values are finite and not beyond kLargestValue.
bool is_admissible(const Eigen::Ref<const Eigen::VectorXd>& values);

/// The bounds T1 <= T2 on the time between samples, or between jumps where there are no samples,
/// for which the gains were designed [ns].
struct SamplingBounds {
  Duration T1 = 0;  ///< the shortest, > 0
  Duration T2 = 0;  ///< the longest
};

/// An estimate and what it rests on.
struct Estimate {
  /// Of the time at which it holds.
  Stamp stamp = 0;
  /// The whole state of the law; its first law.estimate_size() entries are the estimate.
  Eigen::VectorXd state;
  /// The events with a stamp up to this one.
  EventCounts counts;
  /// Whether the last finite state is given, with what events of `stamp` made of it, because the
  /// flow to `stamp` is not finite.
  bool held = false;
};

/// One observer at work: admits events, keeps them in a Timeline and answers for any time in its
/// window. It knows time only from its arguments, so it does the same live and from a bag.
/// To be used by one thread at a time. Allocates nothing after construction.
class Estimator {
 public:
  /// How events are admitted and kept.
  struct Options {
    /// How far back events are kept, and how many.
    Timeline::Limits history;
    /// What intervals are compared with, in the report of each event.
    SamplingBounds sampling;
    /// How far a stamp may lie after the time of its arrival [ns], >= 0.
    Duration future_tolerance = 0;
    /// How long after their stamps inputs and jumps may come [ns], >= 0; 0 where they are taken to
    /// be there at once.
    Duration latency = 0;
  };

  /// @throws std::invalid_argument for options out of range.
  Estimator(std::shared_ptr<const ObserverLaw> law, const Options& options);

  /// The observer that it runs.
  const ObserverLaw& law() const { return *law_; }

  /// Admits an event that arrived at `now`. Whatever it holds, the estimate stays finite.
  /// @pre the plant has events of this kind and sensor
  EventReport submit(const Event& event, Stamp now);

  /// Takes note of something that was rejected before it was an event. What is known of a rejected
  /// input or jump, in submit() too, goes into the timeline as an event of kind kRejected, where
  /// the law minds: at its stamp, or as near to it as events can be taken in; at `now` where it has
  /// no stamp or one in the future. Rejected samples were not taken.
  void note_rejected(const Event& event, Stamp now);

  /// The bound on the error of an estimate as it can be given at `now`: none while inputs or jumps
  /// of before its stamp may still come.
  PublishedBound bound(const Estimate& estimate, Stamp now) const;

  /// The estimate at `stamp` from all events taken in; `estimate` is written for kOk and kHeld.
  /// @pre estimate.state.size() == law().state_size()
  Timeline::Query estimate_at(Stamp stamp, Estimate& estimate) const;

  /// An Estimate of the right size.
  Estimate make_estimate() const;

  /// Forgets all events and starts again at `stamp` from the configured initial estimate; the input
  /// that holds at `stamp` goes on holding.
  void restart(Stamp stamp);

  /// The same from a given estimate (law().estimate_size() entries, finite).
  void restart(Stamp stamp, Timeline::ConstStateRef estimate);

  /// Forgets all events; there is no estimate until the next sample stamped after `stamp`. That one
  /// starts the estimate, just before its stamp, from the configured initial estimate moved the
  /// least so that it fits the sample (ObserverLaw::fit_to()).
  void restart_at_next_sample(Stamp stamp);

  /// Whether there is no estimate yet since restart_at_next_sample().
  bool awaits_sample() const { return awaits_sample_; }

  /// Goes on at `stamp` after a time whose samples were not taken: from the estimate as it flows
  /// without them, with its bound. Inputs and jumps of that time are to be told as rejected.
  void resume(Stamp stamp);

  /// Goes on at `stamp` from the estimate of `other`, an estimator of the same plant with another
  /// law: what is held and the mode stay, and what is known of its error; all else of the law's
  /// state begins.
  void take_over(Estimator& other, Stamp stamp);

  /// Forgets everything: as new.
  void clear();

  /// The earliest stamp at which there is an estimate now.
  std::optional<Stamp> earliest() const;

 private:
  std::optional<EventOutcome> objection(const Event& event, Stamp now) const;
  void insert_rejected(EventKind kind, Stamp stamp);
  bool prepare_restart(Estimator& from, Stamp stamp);
  void begin(Stamp stamp);
  void begin_at(const Event& sample);
  double innovation_of(const Event& measured);

  std::shared_ptr<const ObserverLaw> law_;
  Options options_;
  Timeline timeline_;
  Estimate before_restart_;
  Eigen::VectorXd restart_state_;
  Eigen::VectorXd workspace_;
  Eigen::VectorXd innovation_;
  bool awaits_sample_ = false;
  /// Whether `sampling` is about jumps.
  bool is_sampled_;
  /// Whether something else than samples may come late.
  bool has_other_events_;
  /// Stamp of the last rejected input, until a later one is there: no start knows it.
  std::optional<Stamp> input_unknown_since_;
  /// Where the estimate began last: jumps of before play no part.
  std::optional<Stamp> began_at_;
};

}  // namespace sampled_data_observers
