#include "design/run_time_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

constexpr double kWithoutBound = std::numeric_limits<double>::infinity();
constexpr double kNanoseconds = 1e9;  // in a second

/// Events of one sensor, or jumps of the plant, at intervals in turn [s].
struct EventSource {
  std::size_t sensor = 0;  ///< its position among the sensors of the plant
  std::vector<double> intervals;
};
using EventSources = std::vector<EventSource>;

/// A bound that the events of some sources drive.
class Run {
 public:
  /// @param weights  of the states' errors; none for the norm
  Run(const ErrorBound& bound, bool jumps, EventSources sources, const Eigen::VectorXd& weights)
      : bound_(bound),
        jumps_(jumps),
        weights_(weights),
        ellipsoid_(weights.size(), weights.size()),
        sources_(std::move(sources)),
        taken_(sources_.size(), 0),
        then_(static_cast<std::size_t>(bound.state_size())),
        workspace_(static_cast<std::size_t>(bound.workspace_size())) {
    for (const EventSource& source : sources_) left_.push_back(source.intervals.front());
    bound.initialize(then_.data());
  }

  /// Up to the next event and over it. @return the largest bound
  double advance() {
    const auto next =
        static_cast<std::size_t>(std::min_element(left_.begin(), left_.end()) - left_.begin());
    const double interval = left_[next];
    double largest = bound(then_);
    for (const double fraction : {0.25, 0.5, 0.75, 1.0}) {
      now_ = then_;
      bound_.flow(fraction == 1.0 ? interval : fraction * interval, now_.data());
      largest = std::max(largest, bound(now_));
    }
    const EventSource& source = sources_[next];
    if (jumps_) {
      bound_.jump({}, now_.data());  // none is told twice, or at a wrong time
    } else {
      bound_.sample(source.sensor, now_.data(), workspace_.data());
    }
    then_ = now_;
    time_ += interval;
    // Times between events are whole nanoseconds, and so they sum up to T1 and T2 exactly.
    for (double& left : left_) left = std::round((left - interval) * kNanoseconds) / kNanoseconds;
    left_[next] = source.intervals[++taken_[next] % source.intervals.size()];
    return std::max(largest, bound(then_));
  }

  double time() const { return time_; }

 private:
  /// What is no number bounds nothing.
  double bound(const std::vector<double>& state) {
    const double value = bound_.bound(state.data());
    if (std::isnan(value)) return kWithoutBound;
    if (weights_.size() == 0 || !std::isfinite(value)) return value;
    bound_.ellipsoid(state.data(), workspace_.data(), ellipsoid_);
    if (!ellipsoid_.allFinite()) return kWithoutBound;
    const Eigen::MatrixXd weighted = weights_.asDiagonal() * ellipsoid_ * weights_.asDiagonal();
    return std::sqrt(std::max(0.0, max_eigenvalue(weighted)));
  }

  const ErrorBound& bound_;
  bool jumps_;
  Eigen::VectorXd weights_;
  Eigen::MatrixXd ellipsoid_;
  EventSources sources_;
  std::vector<std::size_t> taken_;  // of each source
  std::vector<double> left_;        // until the next of each source [s]
  std::vector<double> then_;
  std::vector<double> now_;
  std::vector<double> workspace_;
  double time_ = 0.0;
};

/// Events until each source has gone through its intervals once.
std::size_t events_of_cycle(const EventSources& sources) {
  const auto sum = [](const EventSource& source) {
    return std::accumulate(source.intervals.begin(), source.intervals.end(), 0.0);
  };
  double longest = 0.0;
  for (const EventSource& source : sources) longest = std::max(longest, sum(source));
  std::size_t events = 0;
  for (const EventSource& source : sources) {
    const double cycles = std::ceil(longest / sum(source));
    events += source.intervals.size() * static_cast<std::size_t>(cycles);
  }
  return events;
}

double final_bound(const ErrorBound& bound, bool jumps, const EventSources& sources,
                   const Eigen::VectorXd& weights) {
  constexpr int kMaxCycles = 200000;
  constexpr double kSettled = 1e-9;
  Run run(bound, jumps, sources, weights);
  const std::size_t events = events_of_cycle(sources);
  double before = 0.0;
  for (int cycle = 0; cycle < kMaxCycles; ++cycle) {
    double largest = 0.0;
    for (std::size_t i = 0; i < events; ++i) largest = std::max(largest, run.advance());
    if (!(largest < kWithoutBound) || std::abs(largest - before) <= kSettled * largest)
      return largest;
    before = largest;
  }
  return before;
}

/// The same of several sources, whose events need not ever meet in the same order again: the
/// largest over a time that doubles until that makes no difference.
double final_bound_of_several(const ErrorBound& bound, bool jumps, const EventSources& sources,
                              const Eigen::VectorXd& weights) {
  constexpr std::size_t kMostEvents = 4000000;
  constexpr double kSettled = 1e-4;
  Run run(bound, jumps, sources, weights);
  double before = 0.0;
  for (std::size_t events = 8 * events_of_cycle(sources); events < kMostEvents; events *= 2) {
    double largest = 0.0;
    for (std::size_t i = 0; i < events; ++i) largest = std::max(largest, run.advance());
    if (!(largest < kWithoutBound) || std::abs(largest - before) <= kSettled * largest) {
      return std::max(largest, before);
    }
    before = largest;
  }
  return before;
}

void add_start(const ErrorBound& bound, bool jumps, const EventSources& sources,
               RunTimeFigures& figures) {
  constexpr int kMaxSamples = 1000000;
  Run run(bound, jumps, sources, {});
  for (int i = 0; i < kMaxSamples; ++i) {
    const double largest = run.advance();
    if (std::isinf(largest)) break;
    figures.factor_on_start = std::max(figures.factor_on_start, largest);
    if (largest > 0.01) continue;
    figures.time_to_hundredth = std::max(figures.time_to_hundredth, run.time());
    return;
  }
  figures.time_to_hundredth = kWithoutBound;
}

/// A time that differs by so many nanoseconds from a whole number of them is that number.
constexpr double kSameTick = 1e-3;

std::vector<EventSources> worst_sources(const CertificateSubject& subject) {
  const auto of_one = [&](std::vector<double> intervals) {
    const auto& sampled = subject.plant.sampled;
    return EventSources{{sampled.empty() ? 0 : sampled.front().position, std::move(intervals)}};
  };
  const auto& dwell_time = subject.dwell_time;
  if (dwell_time && dwell_time->kind == DwellTime::Kind::kReverseAverage) {
    // As many jumps as there must be: evenly, or after the longest pause all that it left out.
    std::vector<double> pause(static_cast<std::size_t>(dwell_time->N0) + 1, 0.0);
    pause.front() = (dwell_time->N0 + 1.0) * dwell_time->tau;
    return {of_one({dwell_time->tau}), of_one(pause)};
  }
  if (!subject.sensor_times.empty()) {
    EventSources soon;
    EventSources late;
    for (std::size_t i = 0; i < subject.sensor_times.size(); ++i) {
      const SamplingTimes& times = subject.sensor_times[i];
      const std::size_t sensor = subject.plant.sampled[i].position;
      const double longest = std::floor(times.T2 * kNanoseconds + kSameTick) / kNanoseconds;
      const double shortest = std::ceil(times.T1 * kNanoseconds - kSameTick) / kNanoseconds;
      soon.push_back({sensor, {times.T1 > 0.0 ? shortest : longest}});
      late.push_back({sensor, {longest}});
    }
    return {soon, late};
  }
  const double T1 = shortest_interval(subject);
  const double T2 = time_scale(subject);
  if (T1 == T2) return {of_one({T1})};
  return {of_one({T1}), of_one({T2}), of_one({T1, T2})};
}

}  // namespace

double shortest_interval(const CertificateSubject& subject) {
  return subject.T1 > 0.0 ? subject.T1 : time_scale(subject);
}

RunTimeFigures run_time_figures(const Theorem& theorem, const CertificateSubject& subject,
                                const NamedMatrices& values, const ErrorAssumptions& assumptions) {
  RunTimeFigures figures;
  CertificateSubject unweighted = subject;
  unweighted.error_weights.resize(0);
  figures.final_error = final_error(theorem, unweighted, values, assumptions);
  ErrorAssumptions start;
  start.initial_error = 1.0;
  const auto bound = theorem.error_bound(subject, values, start);
  for (const EventSources& sources : worst_sources(subject)) {
    add_start(*bound, subject.plant.jumps(), sources, figures);
  }
  return figures;
}

double final_error(const Theorem& theorem, const CertificateSubject& subject,
                   const NamedMatrices& values, const ErrorAssumptions& assumptions) {
  ErrorAssumptions in_the_end = assumptions;
  in_the_end.initial_error = 0.0;
  const auto bound = theorem.error_bound(subject, values, in_the_end);
  if (!bound || bound->follows_law()) {
    throw std::invalid_argument(theorem.name() + " gives no bound on the error before a run");
  }
  double largest = 0.0;
  for (const EventSources& sources : worst_sources(subject)) {
    const auto of_sources = sources.size() > 1 ? final_bound_of_several : final_bound;
    largest = std::max(largest,
                       of_sources(*bound, subject.plant.jumps(), sources, subject.error_weights));
  }
  return largest;
}

}  // namespace sampled_data_observers
