#include "sampled_data_observers/hybrid/timeline.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace sampled_data_observers {
namespace {

Timeline::Limits checked(Timeline::Limits limits) {
  if (limits.history <= 0) throw std::invalid_argument("Timeline: history must be positive");
  if (limits.max_events == 0) throw std::invalid_argument("Timeline: max_events must be positive");
  return limits;
}

/// Finite, and far enough from the largest number that the next flow or reset is finite as well: a
/// state that could not be corrected any more would be as bad as an infinite one.
bool is_usable(const Timeline::ConstStateRef& state) {
  constexpr double kLargest = 1e150;
  return state.allFinite() && state.cwiseAbs().maxCoeff() <= kLargest;
}

}  // namespace

Timeline::Timeline(std::shared_ptr<const HybridSystem> system, Limits limits)
    : system_(std::move(system)),
      limits_(checked(limits)),
      // One slot more than events kept: a new event is put in order before the oldest goes.
      slots_(limits.max_events + 1),
      values_(system_->max_event_size(), static_cast<Eigen::Index>(slots_.size())),
      states_(system_->state_size(), static_cast<Eigen::Index>(slots_.size())),
      order_(slots_.size()),
      base_state_(system_->state_size()),
      base_samples_(system_->sensors()),
      workspace_(system_->workspace_size()) {
  cursor_.state.resize(system_->state_size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    slots_[i].event.values = values_.col(static_cast<Eigen::Index>(i)).data();
  }
  system_->initialize(base_state_.data());
}

Timeline::InsertReport Timeline::insert(const Event& event) {
  InsertReport report;
  const std::size_t position = position_after(event);
  report.previous = previous(position, event);
  if (position > 0 && compare(slot(position - 1).event, event) == 0) {
    report.insertion = Insertion::kDuplicate;
    return report;
  }
  if (is_before_window(event.stamp)) {
    report.insertion = Insertion::kBeforeWindow;
    return report;
  }
  report.rewound = size_ - position;
  report.insertion = report.rewound == 0 ? Insertion::kAppended : Insertion::kRewound;
  open_position(position, event);
  apply(position);
  report.effect = slot(position).effect;
  for (std::size_t later = position + 1; later < size_; ++later) apply(later);

  const Stamp horizon = slot(size_ - 1).event.stamp - limits_.history;
  while (size_ > limits_.max_events || slot(0).event.stamp < horizon) forget_oldest();
  return report;
}

Timeline::Query Timeline::state_at(Stamp stamp, StateRef state, EventCounts& counts) const {
  std::size_t position = size_;
  while (position > 0 && slot(position - 1).event.stamp > stamp) --position;

  if (position > 0) {
    state = state_after(position - 1);
    counts = slot(position - 1).counts;
    flow_from(order(position - 1), stamp - slot(position - 1).event.stamp, state);
  } else if (!base_stamp_) {
    return size_ == 0 ? Query::kNoEvent : Query::kBeforeStart;
  } else if (*base_stamp_ > stamp) {
    return base_is_restart_ ? Query::kBeforeStart : Query::kBeforeWindow;
  } else {
    state = base_state_;
    counts = base_counts_;
    flow_from(base_origin(), stamp - *base_stamp_, state);
  }
  if (is_usable(state)) return Query::kOk;
  if (position > 0) {
    state = state_after(position - 1);
  } else {
    state = base_state_;
  }
  system_->hold(state.data());
  return Query::kHeld;
}

void Timeline::restart(Stamp stamp, ConstStateRef state) {
  first_ = 0;
  size_ = 0;
  cursor_.origin.reset();
  base_stamp_ = stamp;
  base_is_restart_ = true;
  base_counts_ = EventCounts{};
  base_state_ = state;
  std::fill(base_samples_.begin(), base_samples_.end(), std::nullopt);
  base_jump_.reset();
}

void Timeline::rebase(Stamp stamp, ConstStateRef state) {
  std::size_t forgotten = 0;
  while (forgotten < size_ && slot(forgotten).event.stamp <= stamp) ++forgotten;
  const std::size_t first = ring_index(forgotten);
  const std::size_t kept = size_ - forgotten;
  restart(stamp, state);
  first_ = first;
  size_ = kept;
  for (std::size_t position = 0; position < size_; ++position) apply(position);
}

void Timeline::clear() {
  system_->initialize(base_state_.data());
  restart(0, base_state_);
  base_stamp_.reset();
  base_is_restart_ = false;
}

std::optional<Stamp> Timeline::earliest() const {
  if (base_stamp_) return base_stamp_;
  if (size_ > 0) return slot(0).event.stamp;
  return std::nullopt;
}

std::optional<Stamp> Timeline::earliest_insertion() const {
  std::optional<Stamp> earliest;
  if (base_stamp_) earliest = *base_stamp_ + 1;
  if (size_ > 0) {
    earliest = std::max(earliest.value_or(0), slot(size_ - 1).event.stamp - limits_.history);
  }
  return earliest;
}

/// The position behind all events that come before `event` or equal it.
std::size_t Timeline::position_after(const Event& event) const {
  // Most events are the newest or nearly so: a search from the end beats a bisection.
  std::size_t position = size_;
  while (position > 0 && compare(slot(position - 1).event, event) > 0) --position;
  return position;
}

bool Timeline::is_before_window(Stamp stamp) const {
  if (base_stamp_ && stamp <= *base_stamp_) return true;
  return size_ > 0 && stamp < slot(size_ - 1).event.stamp - limits_.history;
}

void Timeline::open_position(std::size_t position, const Event& event) {
  const std::size_t free_slot = order(size_);
  for (std::size_t i = size_; i > position; --i) order(i) = order(i - 1);
  order(position) = free_slot;
  ++size_;
  if (cursor_.origin == free_slot) cursor_.origin.reset();
  const double* values = slots_[free_slot].event.values;
  values_.col(static_cast<Eigen::Index>(free_slot)).head(event.size) = event.vector();
  slots_[free_slot].event = event;
  slots_[free_slot].event.values = values;
}

/// Carries `state`, which holds after the event in slot `origin`, over `duration`.
void Timeline::flow_from(std::size_t origin, Duration duration, StateRef state) const {
  const Duration step = system_->flow_step();
  if (duration > system_->flow_horizon()) {
    state.setConstant(std::numeric_limits<double>::quiet_NaN());
    return;
  }
  if (step == 0 || duration < step) {
    system_->flow(duration, state.data(), workspace_.data());
    return;
  }
  const Duration whole = duration - duration % step;
  if (cursor_.origin != origin || cursor_.reached > whole) {
    cursor_.origin = origin;
    cursor_.reached = 0;
    cursor_.state = state;
  }
  system_->flow(whole - cursor_.reached, cursor_.state.data(), workspace_.data());
  cursor_.reached = whole;
  state = cursor_.state;
  system_->flow(duration - whole, state.data(), workspace_.data());
}

/// Computes the state after the event at `position`, and what it rests on, from what stands before
/// it.
void Timeline::apply(std::size_t position) {
  Slot& current = slots_[order(position)];
  current.counts = position == 0 ? base_counts_ : slot(position - 1).counts;
  if (current.event.kind != EventKind::kRejected) ++current.counts.events;
  current.effect = reset(position);
  if (!took_effect(current.effect)) return;
  if (current.event.kind == EventKind::kJump) ++current.counts.jumps;
  if (current.event.kind == EventKind::kSample) {
    ++current.counts.samples;
    current.counts.last_sample = current.event.stamp;
  }
}

Effect Timeline::reset(std::size_t position) {
  const Event& event = slot(position).event;
  if (cursor_.origin == order(position)) cursor_.origin.reset();
  auto state = state_after(position);
  const bool is_first = position == 0;
  const Stamp now = event.stamp;
  const auto restore = [&] {
    if (is_first) {
      state = base_state_;
    } else {
      state = state_after(position - 1);
    }
  };
  const auto flow = [&] {
    if (!is_first) {
      flow_from(order(position - 1), now - slot(position - 1).event.stamp, state);
    } else if (base_stamp_) {
      flow_from(base_origin(), now - *base_stamp_, state);
    }
  };
  const auto hold = [&] {
    restore();
    system_->hold(state.data());
  };
  restore();
  flow();
  const bool flow_is_finite = is_usable(state);
  if (!flow_is_finite) hold();
  const Effect effect = system_->reset(event, state.data(), workspace_.data());
  if (!took_effect(effect) || is_usable(state)) return effect;
  if (flow_is_finite) {
    restore();
    flow();
  } else {
    hold();
  }
  // The plant has jumped all the same.
  if (event.kind == EventKind::kJump) system_->hold(state.data());
  return Effect::kNotFinite;
}

void Timeline::forget_oldest() {
  const Event& oldest = slot(0).event;
  if (oldest.kind == EventKind::kSample && took_effect(slot(0).effect)) {
    base_samples_[static_cast<std::size_t>(oldest.channel)] = oldest.stamp;
  }
  if (oldest.kind == EventKind::kJump && took_effect(slot(0).effect)) base_jump_ = oldest.stamp;
  if (cursor_.origin == base_origin()) cursor_.origin.reset();
  base_stamp_ = slot(0).event.stamp;
  base_is_restart_ = false;
  base_counts_ = slot(0).counts;
  base_state_ = state_after(0);
  first_ = ring_index(1);
  --size_;
}

std::optional<Stamp> Timeline::previous(std::size_t position, const Event& event) const {
  const bool is_sample = event.kind == EventKind::kSample;
  if (!is_sample && event.kind != EventKind::kJump) return std::nullopt;
  while (position > 0) {
    const Event& earlier = slot(--position).event;
    const bool is_alike =
        earlier.kind == event.kind && (!is_sample || earlier.channel == event.channel);
    if (is_alike && earlier.stamp < event.stamp && took_effect(slot(position).effect)) {
      return earlier.stamp;
    }
  }
  return is_sample ? base_samples_[static_cast<std::size_t>(event.channel)] : base_jump_;
}

}  // namespace sampled_data_observers
