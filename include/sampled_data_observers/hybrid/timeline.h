#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "sampled_data_observers/hybrid/hybrid_system.h"

namespace sampled_data_observers {

class SplitFlow;

/// What a state rests on, counted since the start (or the last restart).
struct EventCounts {
  /// Of all kinds, with or without effect.
  std::uint64_t events = 0;
  /// Samples that took effect.
  std::uint64_t samples = 0;
  /// Jumps that took effect.
  std::uint64_t jumps = 0;
  /// The sum of the digests of all events, of rejected ones too: by which it is told whether two
  /// states rest on the same ones, in whatever order they came.
  std::uint64_t digest = 0;
  /// Stamp of the newest sample among them.
  std::optional<Stamp> last_sample;
};

/// A bounded log of events in stamp order, each with the state after it, over one HybridSystem.
///
/// The state at time t is a pure function of the system, of the limits and of the set of events
/// with stamp <= t that were taken in: an event that comes late, but inside the history window, is
/// put where it belongs and the later ones are applied again. Equal stamps are ordered by
/// compare(Event, Event). Queries change nothing.
///
/// Before its first event the system is in its initial state; the first event's stamp is therefore
/// the earliest time at which there is a state, unless the timeline begins at a stated one
/// (begin()). The number of a rejected jump begins no state where that is all that the system minds
/// of it: until another event begins one at an earlier stamp, it is kept without effect. The window
/// reaches `history` back from the newest event, or less when more than `max_events` events lie in
/// it.
///
/// A flow or reset whose result is not finite, or beyond 1e150, is skipped: the last good state is
/// held, and only its timers go on. A state counts as held until a flow over some time succeeds
/// again, whatever events do to it. That, too, is a function of the events alone. A sample or jump
/// without effect counts as an event only.
///
/// A jump that a withdrawal is about has no effect, whichever of them comes first: the system does
/// not see it, only the withdrawal.
///
/// Everything is allocated by the constructor; afterwards nothing is.
class Timeline {
 public:
  /// Where a state is written: state_size() entries.
  using StateRef = Eigen::Ref<Eigen::VectorXd>;
  /// A state that is read: state_size() entries.
  using ConstStateRef = Eigen::Ref<const Eigen::VectorXd>;

  /// How much is remembered.
  struct Limits {
    /// Length of the history window [ns], > 0.
    Duration history = 0;
    /// Number of events kept, >= 1.
    std::size_t max_events = 0;
  };

  /// What became of an event.
  enum class Insertion {
    kAppended,      ///< newest of all
    kRewound,       ///< put before `rewound` later events, which were applied again
    kDuplicate,     ///< the same event is there already; nothing changed
    kBeforeWindow,  ///< older than the history window; nothing changed
  };

  /// What became of an event, and what it changed.
  struct InsertReport {
    /// The following mean something for kAppended and kRewound only.
    Insertion insertion = Insertion::kAppended;
    /// Number of later events that were applied again.
    std::size_t rewound = 0;
    /// Of the event itself.
    Effect effect = Effect::kApplied;
    /// For a sample: stamp of the newest one of the same sensor before it that took effect; for a
    /// jump: of the newest jump.
    std::optional<Stamp> previous;
  };

  /// Whether there is a state at a stamp.
  enum class Query {
    kOk,
    kHeld,         ///< the flow to this stamp is not finite: the last finite state, with what
                   ///< events of this stamp made of it
    kNoEvent,      ///< nothing was taken in yet
    kBeforeStart,  ///< before the first event or the restart
    kBeforeWindow  ///< older than the history window
  };

  /// @throws std::invalid_argument for a limit out of range.
  Timeline(std::shared_ptr<const HybridSystem> system, Limits limits);

  // Events point into the timeline's own memory, which a move keeps and a copy would not.
  Timeline(const Timeline&) = delete;
  Timeline& operator=(const Timeline&) = delete;
  /// What was moved from may only be destroyed or assigned to.
  Timeline(Timeline&&) = default;
  /// What was moved from may only be destroyed or assigned to.
  Timeline& operator=(Timeline&&) = default;

  /// Takes in one event. The values are copied.
  /// @pre system.accepts(event); all values finite
  InsertReport insert(const Event& event);

  /// The same for an event and one that is to follow it: both are taken in, or none. The report is
  /// about the first one.
  /// @pre as of insert() for both; compare(event, companion) < 0
  InsertReport insert(const Event& event, const Event& companion);

  /// The state at `stamp` from all events with a stamp up to and including it.
  /// `state` (system.state_size() entries) and `counts` are written for kOk and kHeld only.
  Query state_at(Stamp stamp, StateRef state, EventCounts& counts) const;

  /// Begins a flow that leads to the state of state_at(), and to the same bits, so that it can be
  /// computed in parts and while the timeline goes on. `flow` and `counts` are written for kOk
  /// only, which stands for kHeld as well: the flow will tell.
  Query begin_flow(Stamp stamp, SplitFlow& flow, EventCounts& counts) const;

  /// Goes so many flow_step()s of the system towards the state at `stamp`, which changes no state.
  /// Returns how many are left then to state_at(), or to an event of that stamp at the end of the
  /// log. They may become more where other stamps are asked for meanwhile, and events taken in.
  std::int64_t approach(Stamp stamp, std::int64_t steps) const;

  /// Forgets all events; the initial state holds at `stamp`, until an event of that stamp or a
  /// later one. Earlier events are before the window.
  void begin(Stamp stamp);

  /// Forgets all events; `state` holds at `stamp`, and events up to `stamp` are before the window.
  /// It may be one that was `held`.
  void restart(Stamp stamp, ConstStateRef state, bool held = false);

  /// Forgets the events up to `stamp`, at which `state` holds, and applies the later ones again.
  /// They are counted from `stamp` on. The state may be one that was `held`.
  void rebase(Stamp stamp, ConstStateRef state, bool held = false);

  /// Takes in what another timeline keeps without a state yet, as far as this one's system minds
  /// it.
  void take_unbegun(const Timeline& other);

  /// Forgets everything: as new.
  void clear();

  /// The earliest stamp at which there is a state now.
  std::optional<Stamp> earliest() const;

  /// Stamp of the newest event in the log; nothing where it is empty.
  std::optional<Stamp> newest() const;

  /// Whether the log has a jump, taken or rejected and not withdrawn, with a stamp in (after,
  /// until].
  bool has_jump(Stamp after, Stamp until) const;

  /// States of the log.
  struct Around {
    const double* before;  ///< after the newest event up to a stamp, or where the log begins
    const double* after;   ///< after the first jump, withdrawal or rejected number behind it
  };

  /// Those around `stamp`; nothing where none is behind it. Valid until the timeline changes.
  std::optional<Around> around_next_jump(Stamp stamp) const;

  /// The earliest stamp at which an event can be taken in now; nothing where any can.
  std::optional<Stamp> earliest_insertion() const;

  /// Number of events in the log now.
  std::size_t size() const { return size_; }

 private:
  struct Slot {
    Event event;
    std::uint64_t digest = 0;  ///< of the event
    EventCounts counts;
    Effect effect = Effect::kApplied;
    /// Whether the state was held and not flowed to the event.
    bool held = false;
    /// Whether there is a state: not for the numbers of rejected jumps before all other events.
    bool begun = false;
  };

  /// What the base is.
  enum class Base {
    kInitial,   ///< the initial state, at no time: it holds where the first event comes
    kStart,     ///< the initial state at its stamp, before events of that
    kRestart,   ///< a given state at its stamp
    kForgotten  ///< the newest event that was forgotten
  };

  std::size_t ring_index(std::size_t position) const {
    const std::size_t index = first_ + position;
    return index < order_.size() ? index : index - order_.size();
  }
  std::size_t& order(std::size_t position) { return order_[ring_index(position)]; }
  std::size_t order(std::size_t position) const { return order_[ring_index(position)]; }
  Slot& slot(std::size_t position) { return slots_[order(position)]; }
  const Slot& slot(std::size_t position) const { return slots_[order(position)]; }
  Stamp stamp(std::size_t position) const { return slot(position).event.stamp; }
  auto state_after(std::size_t position) {
    return states_.col(static_cast<Eigen::Index>(order(position)));
  }
  auto state_after(std::size_t position) const {
    return states_.col(static_cast<Eigen::Index>(order(position)));
  }

  InsertReport take_in(const Event& event, const Event* companion);
  void set_base(Base base, Stamp stamp, bool held);
  std::size_t position_after(const Event& event) const;
  bool is_before_window(Stamp stamp) const;
  void open_position(std::size_t position, const Event& event);
  bool begins_states(const Event& event) const;
  void apply(std::size_t position);
  Effect reset(std::size_t position);
  bool is_withdrawn(std::size_t position) const;
  bool withdraws_any(std::size_t position) const;
  Query find(Stamp at, std::size_t& position) const;
  void flow_from(std::size_t position, Duration duration, StateRef state) const;
  void flow_to(std::size_t position, Duration whole, const ConstStateRef& state) const;
  void forget_oldest();
  /// Where an event of its kind and sensor has its place in newest_; nothing for kinds that have
  /// none.
  std::optional<Eigen::Index> family_of(const Event& event) const;
  std::optional<Stamp> previous(std::size_t position, const Event& event) const;

  std::shared_ptr<const HybridSystem> system_;
  Limits limits_;

  /// One slot, one column of values, of states and of newest_ each for the base and every event;
  /// `order_` is a ring of slot numbers: the base at position 0, the events behind it in their
  /// order, then the free ones.
  std::vector<Slot> slots_;
  Eigen::MatrixXd values_;
  Eigen::MatrixXd states_;
  /// Stamps of the newest sample of each sensor and of the newest jump that took effect, up to the
  /// event of the column.
  Eigen::Matrix<Stamp, Eigen::Dynamic, Eigen::Dynamic> newest_;
  std::vector<std::size_t> order_;
  std::size_t first_ = 0;
  /// Number of events.
  std::size_t size_ = 0;
  Base base_ = Base::kInitial;

  /// Scratch of the maps; it makes even queries a matter of one thread at a time.
  mutable Eigen::VectorXd workspace_;

  /// How far the flow from one event was computed already, where flows may be split: the slot of
  /// that event, a whole number of flow steps, the state there.
  struct Cursor {
    std::optional<std::size_t> origin;
    Duration reached = 0;
    Eigen::VectorXd state;
  };
  mutable Cursor cursor_;
};

}  // namespace sampled_data_observers
