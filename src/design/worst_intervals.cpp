#include "design/worst_intervals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace sampled_data_observers {
namespace {

/// Where the events come from, and the times between them [s], in whole nanoseconds.
struct IrregularSource {
  bool jumps = false;
  std::size_t sensor = 0;
  std::vector<double> intervals;  // shortest first
};

std::optional<IrregularSource> irregular_source(const CertificateSubject& subject) {
  constexpr double kTicks = 1e9;  // in a second
  constexpr double kSameTick = 1e-3;
  constexpr int kIntervals = 9;
  if (subject.dwell_time || subject.sensor_times.size() > 1) return std::nullopt;
  const bool own = !subject.sensor_times.empty();
  const double T1 = own ? subject.sensor_times.front().T1 : subject.T1;
  const double T2 = own ? subject.sensor_times.front().T2 : subject.T2;
  if (!(T1 > 0.0) || !std::isfinite(T2) || !(T1 < T2)) return std::nullopt;
  IrregularSource source;
  source.jumps = subject.plant.jumps();
  if (!subject.plant.sampled.empty()) source.sensor = subject.plant.sampled.front().position;
  const double first = std::ceil(T1 * kTicks - kSameTick);
  const double last = std::floor(T2 * kTicks + kSameTick);
  for (int i = 0; i < kIntervals; ++i) {
    source.intervals.push_back(std::round(first + (last - first) * i / (kIntervals - 1)) / kTicks);
  }
  return source;
}

}  // namespace

std::optional<double> worst_intervals_final_error(const Theorem& theorem,
                                                  const CertificateSubject& subject,
                                                  const NamedMatrices& values,
                                                  const ErrorAssumptions& assumptions) {
  constexpr int kMostEvents = 100000;
  constexpr double kSettled = 1e-9;
  constexpr int kLooks = 16;
  const std::optional<IrregularSource> source = irregular_source(subject);
  if (!source) return std::nullopt;
  ErrorAssumptions in_the_end = assumptions;
  in_the_end.initial_error = 0.0;
  const auto bound = theorem.error_bound(subject, values, in_the_end);
  if (!bound || bound->follows_law()) return std::nullopt;

  std::vector<double> workspace(static_cast<std::size_t>(bound->workspace_size()));
  const auto bound_of = [&](const std::vector<double>& state) {
    const double value = bound->bound(state.data());
    return std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
  };
  std::vector<double> state(static_cast<std::size_t>(bound->state_size()));
  bound->initialize(state.data());
  double before = 0.0;
  for (int event = 0; event < kMostEvents; ++event) {
    std::vector<double> worst;
    double largest = -1.0;
    for (const double interval : source->intervals) {
      std::vector<double> next = state;
      bound->flow(interval, next.data());
      if (source->jumps) {
        bound->jump({}, next.data());  // none is told twice, or at a wrong time
      } else {
        bound->sample(source->sensor, next.data(), workspace.data());
      }
      if (bound_of(next) <= largest) continue;
      largest = bound_of(next);
      worst = std::move(next);
    }
    state = std::move(worst);
    if (std::isinf(largest) || std::abs(largest - before) <= kSettled * largest) break;
    before = largest;
  }
  double largest = bound_of(state);
  for (int look = 1; look <= kLooks; ++look) {
    std::vector<double> flown = state;
    bound->flow(source->intervals.back() * look / kLooks, flown.data());
    largest = std::max(largest, bound_of(flown));
  }
  return largest;
}

}  // namespace sampled_data_observers
