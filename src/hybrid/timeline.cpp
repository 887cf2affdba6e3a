#include "sampled_data_observers/hybrid/timeline.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "sampled_data_observers/hybrid/split_flow.h"

namespace sampled_data_observers {
namespace {

Timeline::Limits checked(Timeline::Limits limits) {
  if (limits.history <= 0) throw std::invalid_argument("Timeline: history must be positive");
  if (limits.max_events == 0) throw std::invalid_argument("Timeline: max_events must be positive");
  return limits;
}

constexpr Stamp kNever = std::numeric_limits<Stamp>::min();

/// That a jump was rejected.
Event rejection_of(const Event& jump) {
  Event event;
  event.stamp = jump.stamp;
  event.kind = EventKind::kRejected;
  event.rejected = EventKind::kJump;
  event.index = jump.index;
  return event;
}

bool is_rejection_of_jump(const Event& event) {
  return event.kind == EventKind::kRejected && event.rejected == EventKind::kJump;
}

/// Whether a number that was left out may show there.
bool tells_number_of_jump(const Event& event) {
  return event.kind == EventKind::kJump || event.kind == EventKind::kWithdrawal ||
         (is_rejection_of_jump(event) && event.index != 0);
}

/// The last position up to `end` where `holds`, which is so at all before it; 0 where it is so at
/// none. Most are at the end or nearly so: the search begins there, in steps that double.
template <class Predicate>
std::size_t last_where(std::size_t end, const Predicate& holds) {
  std::size_t low = end;
  std::size_t high = end + 1;
  for (std::size_t step = 1; low > 0 && !holds(low); step *= 2) {
    high = low;
    low -= std::min(low, step);
  }
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (holds(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace

Timeline::Timeline(std::shared_ptr<const HybridSystem> system, Limits limits)
    : system_(std::move(system)),
      limits_(checked(limits)),
      // Three slots more than events kept: the base, and a new event with its companion, which are
      // put in order before the oldest go.
      slots_(limits.max_events + 3),
      values_(system_->max_event_size(), static_cast<Eigen::Index>(slots_.size())),
      states_(system_->state_size(), static_cast<Eigen::Index>(slots_.size())),
      newest_(static_cast<Eigen::Index>(system_->sensors()) + 1,
              static_cast<Eigen::Index>(slots_.size())),
      order_(slots_.size()),
      workspace_(system_->workspace_size()) {
  cursor_.state.resize(system_->state_size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    slots_[i].event.values = values_.col(static_cast<Eigen::Index>(i)).data();
  }
  clear();
}

Timeline::InsertReport Timeline::insert(const Event& event) { return take_in(event, nullptr); }

Timeline::InsertReport Timeline::insert(const Event& event, const Event& companion) {
  return take_in(event, &companion);
}

Timeline::InsertReport Timeline::take_in(const Event& event, const Event* companion) {
  InsertReport report;
  const std::size_t position = position_after(event);
  report.previous = previous(position, event);
  if (position > 1 && compare(slot(position - 1).event, event) == 0) {
    report.insertion = Insertion::kDuplicate;
    return report;
  }
  if (is_before_window(event.stamp)) {
    report.insertion = Insertion::kBeforeWindow;
    return report;
  }
  open_position(position, event);
  report.rewound = size_ - position;
  report.insertion = report.rewound == 0 ? Insertion::kAppended : Insertion::kRewound;
  if (companion != nullptr) {
    const std::size_t behind = position_after(*companion);
    if (compare(slot(behind - 1).event, *companion) != 0) open_position(behind, *companion);
  }
  for (std::size_t later = position; later <= size_; ++later) apply(later);
  report.effect = slot(position).effect;
  if (event.kind == EventKind::kWithdrawal) {
    report.effect = withdraws_any(position) ? Effect::kWithdrawal : Effect::kNoSuchJump;
  }

  const Stamp horizon = stamp(size_) - limits_.history;
  while (size_ > limits_.max_events || stamp(1) < horizon) forget_oldest();
  return report;
}

/// Whether there is a state at a stamp, and the position of the newest event up to it.
Timeline::Query Timeline::find(Stamp at, std::size_t& position) const {
  position = last_where(size_, [&](std::size_t candidate) { return stamp(candidate) <= at; });
  if (slot(position).begun && stamp(position) <= at) return Query::kOk;
  if (!slot(size_).begun) return Query::kNoEvent;
  return base_ == Base::kForgotten && slot(0).begun ? Query::kBeforeWindow : Query::kBeforeStart;
}

Timeline::Query Timeline::begin_flow(Stamp at, SplitFlow& flow, EventCounts& counts) const {
  std::size_t position = 0;
  const Query query = find(at, position);
  if (query != Query::kOk) return query;
  flow.begin(system_, at - stamp(position), slot(position).held);
  flow.state() = state_after(position);
  counts = slot(position).counts;
  return query;
}

std::int64_t Timeline::approach(Stamp at, std::int64_t steps) const {
  std::size_t position = 0;
  if (find(at, position) != Query::kOk) return 0;
  const Duration duration = at - stamp(position);
  const Duration whole = whole_steps(*system_, duration);
  if (whole == 0 || duration > system_->flow_horizon()) return 0;
  const bool is_begun = cursor_.origin == order(position) && cursor_.reached <= whole;
  Duration reached = is_begun ? cursor_.reached : 0;
  const Duration step = system_->flow_step();
  reached += std::min<Duration>(steps, (whole - reached) / step) * step;
  flow_to(position, reached, state_after(position));
  return (whole - reached) / step;
}

Timeline::Query Timeline::state_at(Stamp at, StateRef state, EventCounts& counts) const {
  std::size_t position = 0;
  const Query query = find(at, position);
  if (query != Query::kOk) return query;
  state = state_after(position);
  counts = slot(position).counts;
  const Duration duration = at - stamp(position);
  flow_from(position, duration, state);
  if (is_usable(state)) {
    return duration == 0 && slot(position).held ? Query::kHeld : Query::kOk;
  }
  state = state_after(position);
  system_->hold(duration, state.data());
  return Query::kHeld;
}

void Timeline::restart(Stamp stamp, ConstStateRef state, bool held) {
  size_ = 0;
  set_base(Base::kRestart, stamp, held);
  state_after(0) = state;
}

void Timeline::rebase(Stamp at, ConstStateRef state, bool held) {
  std::size_t forgotten = 0;
  while (forgotten < size_ && stamp(forgotten + 1) <= at) ++forgotten;
  first_ = ring_index(forgotten);
  size_ -= forgotten;
  set_base(Base::kRestart, at, held);
  state_after(0) = state;
  for (std::size_t position = 1; position <= size_; ++position) apply(position);
}

void Timeline::clear() {
  size_ = 0;
  set_base(Base::kInitial, 0, false);
  system_->initialize(state_after(0).data());
}

void Timeline::take_unbegun(const Timeline& other) {
  for (std::size_t position = 1; position <= other.size_; ++position) {
    const Event& event = other.slot(position).event;
    if (!other.slot(position).begun && system_->accepts(event)) insert(event);
  }
}

void Timeline::begin(Stamp stamp) {
  clear();
  set_base(Base::kStart, stamp, false);
}

/// A base that nothing came before; its state is still to be set.
void Timeline::set_base(Base base, Stamp stamp, bool held) {
  base_ = base;
  slot(0).event.stamp = stamp;
  slot(0).counts = EventCounts{};
  slot(0).held = held;
  slot(0).begun = base != Base::kInitial;
  newest_.col(static_cast<Eigen::Index>(order(0))).setConstant(kNever);
  cursor_.origin.reset();
}

std::optional<Stamp> Timeline::earliest() const {
  if (slot(0).begun) return stamp(0);
  if (!slot(size_).begun) return std::nullopt;
  return stamp(last_where(size_, [&](std::size_t position) { return !slot(position).begun; }) + 1);
}

std::optional<Stamp> Timeline::newest() const {
  return size_ > 0 ? std::make_optional(stamp(size_)) : std::nullopt;
}

bool Timeline::has_jump(Stamp after, Stamp until) const {
  for (std::size_t position = size_; position > 0 && stamp(position) > after; --position) {
    const Event& event = slot(position).event;
    if (slot(position).effect == Effect::kWithdrawn) continue;
    const bool is_jump = event.kind == EventKind::kJump || is_rejection_of_jump(event);
    if (is_jump && event.stamp <= until) return true;
  }
  return false;
}

std::optional<Stamp> Timeline::earliest_insertion() const {
  std::optional<Stamp> earliest;
  if (base_ != Base::kInitial) earliest = stamp(0) + (base_ == Base::kStart ? 0 : 1);
  if (size_ > 0) earliest = std::max(earliest.value_or(0), stamp(size_) - limits_.history);
  return earliest;
}

std::optional<Timeline::Around> Timeline::around_next_jump(Stamp at) const {
  std::optional<std::size_t> next;
  std::size_t position = size_;
  for (; position > 0 && stamp(position) > at; --position) {
    if (tells_number_of_jump(slot(position).event)) next = position;
  }
  if (!next) return std::nullopt;
  return Around{state_after(position).data(), state_after(*next).data()};
}

/// The position behind the base and all events that come before `event` or equal it.
std::size_t Timeline::position_after(const Event& event) const {
  return 1 + last_where(size_, [&](std::size_t position) {
           return compare(slot(position).event, event) <= 0;
         });
}

bool Timeline::is_before_window(Stamp at) const {
  if (base_ == Base::kStart && at < stamp(0)) return true;
  const bool takes_its_stamp = base_ == Base::kInitial || base_ == Base::kStart;
  if (!takes_its_stamp && at <= stamp(0)) return true;
  return size_ > 0 && at < stamp(size_) - limits_.history;
}

void Timeline::open_position(std::size_t position, const Event& event) {
  ++size_;
  const std::size_t free_slot = order(size_);
  for (std::size_t i = size_; i > position; --i) order(i) = order(i - 1);
  order(position) = free_slot;
  Event& own = slots_[free_slot].event;
  const double* values = own.values;
  // Negative zeros become positive ones: they compare equal, and whichever comes first must not
  // decide which of them the maps see.
  values_.col(static_cast<Eigen::Index>(free_slot)).head(event.numbers().size()) =
      event.numbers().array() + 0.0;
  own = event;
  own.values = values;
  slots_[free_slot].digest = digest(own);
}

/// Carries `state`, which holds after the event at `position`, over `duration`.
void Timeline::flow_from(std::size_t position, Duration duration, StateRef state) const {
  if (duration > system_->flow_horizon()) {
    state.setConstant(std::numeric_limits<double>::quiet_NaN());
    return;
  }
  const Duration whole = whole_steps(*system_, duration);
  if (whole > 0) {
    flow_to(position, whole, state);
    state = cursor_.state;
  }
  system_->flow(duration - whole, state.data(), workspace_.data());
}

/// Moves the cursor over `whole` flow steps from the event at `position`, after which `state`
/// holds.
void Timeline::flow_to(std::size_t position, Duration whole, const ConstStateRef& state) const {
  if (cursor_.origin != order(position) || cursor_.reached > whole) {
    cursor_.origin = order(position);
    cursor_.reached = 0;
    cursor_.state = state;
  }
  system_->flow(whole - cursor_.reached, cursor_.state.data(), workspace_.data());
  cursor_.reached = whole;
}

/// Whether there are states from an event on, if not before it: not for a number alone.
bool Timeline::begins_states(const Event& event) const {
  if (event.kind != EventKind::kRejected) return true;
  Event without_number = event;
  without_number.index = 0;
  return system_->accepts(without_number);
}

/// Computes the state after the event at `position`, and what it rests on, from what stands before
/// it.
void Timeline::apply(std::size_t position) {
  Slot& current = slot(position);
  const Event& event = current.event;
  const auto column = [&](std::size_t at) {
    return newest_.col(static_cast<Eigen::Index>(order(at)));
  };
  current.counts = slot(position - 1).counts;
  column(position) = column(position - 1);
  current.begun = slot(position - 1).begun || begins_states(event);
  if (!current.begun) {
    state_after(position) = state_after(position - 1);
    current.effect = Effect::kApplied;
    current.held = false;
    return;
  }
  if (event.kind != EventKind::kRejected) ++current.counts.events;
  current.counts.digest += current.digest;
  current.effect = reset(position);
  if (!took_effect(current.effect)) return;
  if (const auto family = family_of(event)) column(position)(*family) = event.stamp;
  if (event.kind == EventKind::kJump) ++current.counts.jumps;
  if (event.kind == EventKind::kSample) {
    ++current.counts.samples;
    current.counts.last_sample = event.stamp;
  }
}

Effect Timeline::reset(std::size_t position) {
  const Event& event = slot(position).event;
  if (cursor_.origin == order(position)) cursor_.origin.reset();
  auto state = state_after(position);
  const bool begins = !slot(position - 1).begun;
  const Duration duration = begins ? 0 : event.stamp - stamp(position - 1);
  const auto flow = [&] {
    state = state_after(position - 1);
    flow_from(position - 1, duration, state);
  };
  const auto hold = [&] {
    state = state_after(position - 1);
    system_->hold(duration, state.data());
  };
  flow();
  const bool flow_is_finite = is_usable(state);
  if (!flow_is_finite) hold();
  // A flow over no time proves nothing.
  slot(position).held = duration > 0 ? !flow_is_finite : slot(position - 1).held;
  if (is_withdrawn(position)) return Effect::kWithdrawn;
  const Effect effect = system_->reset(event, state.data(), workspace_.data());
  if (!took_effect(effect) || is_usable(state)) return effect;
  if (flow_is_finite) {
    flow();
  } else {
    hold();
  }
  if (event.kind == EventKind::kJump) {
    // The plant has jumped all the same, and its jump was told.
    system_->distrust(state.data());
    const Event rejection = rejection_of(event);
    if (system_->accepts(rejection)) system_->reset(rejection, state.data(), workspace_.data());
  }
  return Effect::kNotFinite;
}

/// Whether the event at a position is a jump that was taken back; what takes it back stands before
/// it, if only as the base.
bool Timeline::is_withdrawn(std::size_t position) const {
  const Event& jump = slot(position).event;
  if (jump.kind != EventKind::kJump) return false;
  if (base_ == Base::kForgotten && withdraws(slot(0).event, jump)) return true;
  const auto is_of_earlier = [&](std::size_t before) { return stamp(before) < jump.stamp; };
  // Withdrawals stand behind inputs and before all jumps.
  for (std::size_t before = last_where(position - 1, is_of_earlier) + 1; before < position;
       ++before) {
    const Event& event = slot(before).event;
    if (event.kind == EventKind::kJump) break;
    if (withdraws(event, jump)) return true;
  }
  return false;
}

/// Whether there is a jump that the withdrawal at a position is about.
bool Timeline::withdraws_any(std::size_t position) const {
  const Event& withdrawal = slot(position).event;
  for (std::size_t behind = position + 1; behind <= size_; ++behind) {
    if (stamp(behind) != withdrawal.stamp) break;
    if (withdraws(withdrawal, slot(behind).event)) return true;
  }
  return false;
}

/// The oldest event becomes the base.
void Timeline::forget_oldest() {
  first_ = ring_index(1);
  --size_;
  base_ = Base::kForgotten;
}

std::optional<Eigen::Index> Timeline::family_of(const Event& event) const {
  if (event.kind == EventKind::kSample) return event.sensor;
  if (event.kind == EventKind::kJump) return newest_.rows() - 1;
  return std::nullopt;
}

std::optional<Stamp> Timeline::previous(std::size_t position, const Event& event) const {
  const std::optional<Eigen::Index> family = family_of(event);
  if (!family) return std::nullopt;
  const std::size_t before = last_where(
      position - 1, [&](std::size_t candidate) { return stamp(candidate) < event.stamp; });
  const Stamp newest = newest_(*family, static_cast<Eigen::Index>(order(before)));
  return newest == kNever ? std::nullopt : std::make_optional(newest);
}

}  // namespace sampled_data_observers
