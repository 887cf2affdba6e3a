#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "sampled_data_observers/hybrid/split_flow.h"
#include "sampled_data_observers/hybrid/timeline.h"
#include "sampled_data_observers/observer/observer_law.h"
#include "sampled_data_observers/runtime/event_report.h"
#include "sampled_data_observers/runtime/sensor_sampling.h"

namespace sampled_data_observers {

/// The largest value that an event may carry: no plant has a larger one, and sums of such stay
/// finite.
constexpr double kLargestValue = 1e100;

/// Whether all values are finite and not beyond kLargestValue.
bool is_admissible(const Eigen::Ref<const Eigen::VectorXd>& values);

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
  /// Whose state it is: another law's where the gains were changed after `stamp`. It lives as long
  /// as the estimator keeps that part of its history.
  const ObserverLaw* law = nullptr;
};

/// The bound on the error of an estimate as it can be given: none where something is a reason to
/// withhold a finite one.
PublishedBound published_bound(const Estimate& estimate, BoundLoss withheld);

/// The bounds on its entries, infinite where `bound` is. The workspace is that of its law;
/// `bounds`, one for each estimated state, is written.
/// @pre estimate.law->has_bound()
void published_state_bounds(const Estimate& estimate, const PublishedBound& bound,
                            double* workspace, Eigen::Ref<Eigen::VectorXd> bounds);

/// An estimate that is computed in parts (Estimator::begin_query()), so that others may use the
/// estimator meanwhile.
class EstimateQuery {
 public:
  /// Goes on by so many steps of the integration. Returns whether the estimate is there.
  /// @pre no other thread uses the estimator
  bool proceed(std::int64_t steps);

  /// @pre proceed() returned true. Needs the estimator no more.
  const Estimate& estimate() const { return estimate_; }
  /// Its bound, as it could be given when the query began.
  PublishedBound bound() const { return published_bound(estimate_, withheld_); }
  /// The bounds on its entries, likewise; as published_state_bounds().
  void state_bounds(Eigen::Ref<Eigen::VectorXd> bounds) const;

 private:
  friend class Estimator;

  std::shared_ptr<const ObserverLaw> law_;
  SplitFlow flow_;
  Estimate estimate_;
  BoundLoss withheld_ = BoundLoss::kNone;
};

/// One observer at work: admits events, keeps them in a Timeline and answers for any time in its
/// window. Where it took over another one, that one's events, law and timeline go on being part of
/// its history: late events of before are applied by the law of their time. It knows time only from
/// its arguments, so it does the same live and from a bag. To be used by one thread at a time.
/// Allocates nothing after construction.
class Estimator {
 public:
  /// How events are admitted and kept.
  struct Options {
    /// How far back events are kept, and how many.
    Timeline::Limits history;
    /// What intervals are compared with, in the report of each event.
    SensorSampling sampling;
    /// How far a stamp may lie after the time of its arrival [ns], >= 0.
    Duration future_tolerance = 0;
    /// How long after their stamps inputs and jumps may come [ns], >= 0; 0 where they are taken to
    /// be there at once.
    Duration latency = 0;
    /// By how much the stamps of jumps may be off [ns], >= 0.
    Duration jump_stamp_error = 0;
    /// Where the estimate begins, > 0; nothing: with the first event.
    std::optional<Stamp> start = std::nullopt;
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
  /// no stamp or one in the future; with the number of a jump. Rejected samples were not taken.
  void note_rejected(const Event& event, Stamp now);

  /// The bound on the error of an estimate as it can be given at `now`: none while inputs or jumps
  /// of before its stamp may still come, and none where a jump may have been before it although its
  /// stamp is a later one (jump_stamp_error). So it is a function of the events up to that much
  /// after its stamp: that a later number tells of a lost jump takes no bound of before away here
  /// (see begin_query() and is_before_gap()).
  PublishedBound bound(const Estimate& estimate, Stamp now) const;

  /// The bounds on the entries of an estimate, as published_state_bounds(); likewise at `now`.
  /// @pre the estimate was made by this estimator, and is not older than a take-over
  void state_bounds(const Estimate& estimate, Stamp now, Eigen::Ref<Eigen::VectorXd> bounds);

  /// The ellipsoid that holds its error (StateBound::error_ellipsoid()), likewise.
  void error_ellipsoid(const Estimate& estimate, Stamp now, Eigen::Ref<Eigen::MatrixXd> Q);

  /// The estimate at `stamp` from all events taken in; `estimate` is written for kOk and kHeld.
  /// @pre `estimate` was made by make_estimate() of at(stamp)
  Timeline::Query estimate_at(Stamp stamp, Estimate& estimate) const;

  /// The same in memory of its own, valid until the next use of any kind.
  Timeline::Query estimate_at(Stamp stamp, const Estimate*& estimate);

  /// Whether the next jump behind `stamp` shows by its number that one was lost, which may have
  /// been before `stamp`.
  bool is_before_gap(Stamp stamp) const;

  /// Begins to compute the estimate of estimate_at(), to the same bits, with its bound at `now`:
  /// none where is_before_gap(). kOk stands for kHeld as well.
  Timeline::Query begin_query(Stamp stamp, Stamp now, EstimateQuery& query) const;

  /// Goes on computing towards the estimate at `stamp` for so many steps of the integration, which
  /// changes no estimate. Returns how many are left: see Timeline::approach().
  std::int64_t approach(Stamp stamp, std::int64_t steps) const;

  /// The estimator that answers for `stamp`: this one, or one that it took over.
  const Estimator& at(Stamp stamp) const;

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

  /// Goes on from the estimate of `other`, an estimator of the same plant with another law, at
  /// `stamp` or, where that is later, at its newest event: what is held, the mode, rest, what gates
  /// are, and what is known of jumps and of the error stay; all else begins. The estimate remains
  /// that of the other law up to there, and events of before may come as late as ever; but for
  /// those up to the change before the kEarlierLaws last ones. Where jumps are delayed, one of
  /// before whose release lies behind is released where the new law begins.
  ///
  /// @param other  only to be destroyed afterwards, which frees much memory
  /// @param stamp  not before that of the take-over before
  void take_over(Estimator& other, Stamp stamp);

  /// How many estimators that were taken over are kept.
  static constexpr int kEarlierLaws = 3;

  /// Forgets everything: as new.
  void clear();

  /// The earliest stamp at which there is an estimate now.
  std::optional<Stamp> earliest() const;

 private:
  std::optional<EventOutcome> objection(const Event& event, Stamp now) const;
  void mark_what_is_unseen(EventKind kind, std::uint32_t index, Stamp stamp);
  void insert_rejected(EventKind kind, std::uint32_t index, Stamp stamp);
  BoundLoss withheld(Stamp stamp, Stamp now) const;
  bool is_before_jump(Stamp stamp) const;
  std::optional<bool> shows_gap_behind(Stamp stamp) const;
  bool prepare_restart(Estimator& from, Stamp stamp);
  void begin(Stamp stamp);
  void begin_at(const Event& sample);
  DwellCheck dwell_check_at(Stamp stamp);
  void look_at_innovation(const Event& measured, EventReport& report);
  bool has_earlier() const;
  bool is_earlier(Stamp stamp) const;
  EventReport submit_earlier(Event event, Stamp now);
  bool prepare_take_over();
  void go_on_from_earlier();
  void learn_input(const Event& input);
  void miss_input(int channel, Stamp stamp);
  bool lacks_an_input() const;
  Estimator& responsible_for(Stamp stamp);
  double* workspace_of(const ObserverLaw& law);

  std::shared_ptr<const ObserverLaw> law_;
  Options options_;
  Timeline timeline_;
  Estimate before_restart_;
  Eigen::VectorXd restart_state_;
  Eigen::VectorXd workspace_;
  Eigen::VectorXd innovation_;
  /// That of an error that is taken over; no rows where there is no bound.
  Eigen::MatrixXd ellipsoid_;
  bool awaits_sample_ = false;
  /// Whether `sampling` is about jumps.
  bool is_sampled_;
  /// Whether something else than samples may come late.
  bool has_other_events_;
  /// For each channel of inputs: stamp of the last that was rejected, until a later one is there:
  /// no start knows it.
  std::vector<std::optional<Stamp>> input_unknown_since_;
  /// Where the estimate began last: jumps of before play no part.
  std::optional<Stamp> began_at_;
  /// What estimate_at() gives out.
  Estimate answer_;
  /// What was taken over last, and when; without a stamp it is of no use any more.
  std::unique_ptr<Estimator> earlier_;
  std::optional<Stamp> taken_over_at_;
};

}  // namespace sampled_data_observers
