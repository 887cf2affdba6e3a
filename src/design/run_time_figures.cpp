#include "design/run_time_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace sampled_data_observers {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A bound that samples, or jumps of the plant, drive at intervals in turn.
class Run {
 public:
  Run(const ErrorBound& bound, bool jumps, std::vector<double> intervals)
      : bound_(bound),
        jumps_(jumps),
        intervals_(std::move(intervals)),
        then_(static_cast<std::size_t>(bound.state_size())),
        workspace_(static_cast<std::size_t>(bound.workspace_size())) {
    bound.initialize(then_.data());
  }

  /// Over one interval and its sample. @return the largest bound
  double advance() {
    const double interval = intervals_[next_++ % intervals_.size()];
    double largest = bound(then_);
    for (const double fraction : {0.25, 0.5, 0.75, 1.0}) {
      now_ = then_;
      bound_.flow(fraction == 1.0 ? interval : fraction * interval, now_.data());
      largest = std::max(largest, bound(now_));
    }
    if (jumps_) {
      bound_.jump({}, now_.data());  // none is told twice, or at a wrong time
    } else {
      bound_.sample(0, now_.data(), workspace_.data());
    }
    then_ = now_;
    time_ += interval;
    return std::max(largest, bound(then_));
  }

  double time() const { return time_; }

 private:
  /// What is no number bounds nothing.
  double bound(const std::vector<double>& state) const {
    const double value = bound_.bound(state.data());
    if (std::isnan(value)) return kInfinity;
    return value;
  }

  const ErrorBound& bound_;
  bool jumps_;
  std::vector<double> intervals_;
  std::vector<double> then_;
  std::vector<double> now_;
  std::vector<double> workspace_;
  std::size_t next_ = 0;
  double time_ = 0.0;
};

double final_bound(const ErrorBound& bound, bool jumps, const std::vector<double>& intervals) {
  constexpr int kMaxCycles = 200000;
  constexpr double kSettled = 1e-9;
  Run run(bound, jumps, intervals);
  double before = 0.0;
  for (int cycle = 0; cycle < kMaxCycles; ++cycle) {
    double largest = 0.0;
    for (std::size_t i = 0; i < intervals.size(); ++i) largest = std::max(largest, run.advance());
    if (!(largest < kInfinity) || std::abs(largest - before) <= kSettled * largest) return largest;
    before = largest;
  }
  return before;
}

void add_start(const ErrorBound& bound, bool jumps, const std::vector<double>& intervals,
               RunTimeFigures& figures) {
  constexpr int kMaxSamples = 1000000;
  Run run(bound, jumps, intervals);
  for (int i = 0; i < kMaxSamples; ++i) {
    const double largest = run.advance();
    if (std::isinf(largest)) break;
    figures.factor_on_start = std::max(figures.factor_on_start, largest);
    if (largest > 0.01) continue;
    figures.time_to_hundredth = std::max(figures.time_to_hundredth, run.time());
    return;
  }
  figures.time_to_hundredth = kInfinity;
}

std::vector<std::vector<double>> worst_intervals(const CertificateSubject& subject) {
  const auto& dwell_time = subject.dwell_time;
  if (dwell_time && dwell_time->kind == DwellTime::Kind::kReverseAverage) {
    // As many jumps as there must be: evenly, or after the longest pause all that it left out.
    std::vector<double> pause(static_cast<std::size_t>(dwell_time->N0) + 1, 0.0);
    pause.front() = (dwell_time->N0 + 1.0) * dwell_time->tau;
    return {{dwell_time->tau}, pause};
  }
  const double T1 = shortest_interval(subject);
  const double T2 = time_scale(subject);
  if (T1 == T2) return {{T1}};
  return {{T1}, {T2}, {T1, T2}};
}

}  // namespace

double shortest_interval(const CertificateSubject& subject) {
  return subject.T1 > 0.0 ? subject.T1 : time_scale(subject);
}

RunTimeFigures run_time_figures(const Theorem& theorem, const CertificateSubject& subject,
                                const NamedMatrices& values, const ErrorAssumptions& assumptions) {
  RunTimeFigures figures;
  figures.final_error = final_error(theorem, subject, values, assumptions);
  ErrorAssumptions start;
  start.initial_error = 1.0;
  const auto bound = theorem.error_bound(subject, values, start);
  for (const auto& intervals : worst_intervals(subject))
    add_start(*bound, subject.plant.jumps(), intervals, figures);
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
  for (const auto& intervals : worst_intervals(subject)) {
    largest = std::max(largest, final_bound(*bound, subject.plant.jumps(), intervals));
  }
  return largest;
}

}  // namespace sampled_data_observers
