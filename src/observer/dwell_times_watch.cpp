#include "observer/dwell_times_watch.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace sampled_data_observers {
namespace {

double nanoseconds(const DwellTimes::Average& average) { return static_cast<double>(average.tau); }

void require_average(const std::optional<DwellTimes::Average>& average) {
  if (average && (average->tau <= 0 || !(average->N0 >= 1.0))) {
    throw std::invalid_argument("DwellTimesWatch: tau > 0 and N0 >= 1 must hold");
  }
}

}  // namespace

DwellTimesWatch::DwellTimesWatch(std::shared_ptr<const ObserverLaw> law, const DwellTimes& times)
    : LawDecorator(std::move(law)), times_(times) {
  if (times_.shortest < 0 || (times_.longest && *times_.longest < times_.shortest)) {
    throw std::invalid_argument("DwellTimesWatch: 0 <= shortest <= longest must hold");
  }
  require_average(times_.average);
  require_average(times_.reverse_average);
  set_dwell_watch(this);
}

void DwellTimesWatch::initialize(double* state) const {
  law().initialize(state);
  since_.restart(state);
  had_jump_.set(false, state);
  most_.set(0.0, state);
  lack_.set(0.0, state);
  violations_.set(0.0, state);
  check_.set(DwellCheck::kNone, state);
}

void DwellTimesWatch::flow(Duration duration, double* state, double* workspace) const {
  law().flow(duration, state, workspace);
  since_.advance(duration, state);
}

Effect DwellTimesWatch::reset(const Event& event, double* state, double* workspace) const {
  const Effect effect = law().reset(event, state, workspace);
  if (event.kind == EventKind::kJump && took_effect(effect)) take_jump(state);
  return effect;
}

void DwellTimesWatch::take_jump(double* state) const {
  const double since = since_.of(state);
  DwellCheck check = DwellCheck::kWithin;
  if (had_jump_.of(state) && since < static_cast<double>(times_.shortest)) {
    check = DwellCheck::kShort;
  } else if (is_overdue(state)) {
    check = DwellCheck::kLong;
  } else if (are_too_few(state)) {
    check = DwellCheck::kFew;
  }
  if (times_.average) {
    const double tau = nanoseconds(*times_.average);
    most_.set(std::max(0.0, most_.of(state) - since) + tau, state);
    if (check == DwellCheck::kWithin && most_.of(state) > times_.average->N0 * tau) {
      check = DwellCheck::kMany;
    }
  }
  if (times_.reverse_average) {
    const double tau = nanoseconds(*times_.reverse_average);
    lack_.set(std::max(0.0, lack_.of(state) + since - tau), state);
  }
  if (check != DwellCheck::kWithin) violations_.set(violations_.of(state) + 1.0, state);
  check_.set(check, state);
  had_jump_.set(true, state);
  since_.restart(state);
}

/// With the time since the last jump, which is one already where the next is overdue.
double DwellTimesWatch::dwell_violations(const double* state) const {
  return violations_.of(state) + (is_overdue(state) || are_too_few(state) ? 1.0 : 0.0);
}

bool DwellTimesWatch::is_overdue(const double* state) const {
  return times_.longest && since_.of(state) > static_cast<double>(*times_.longest);
}

bool DwellTimesWatch::are_too_few(const double* state) const {
  if (!times_.reverse_average) return false;
  const double tau = nanoseconds(*times_.reverse_average);
  return lack_.of(state) + since_.of(state) > times_.reverse_average->N0 * tau;
}

}  // namespace sampled_data_observers
