#include "design/timer_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "certificate/timer_dependent.h"
#include "design/run_time_figures.h"

namespace sampled_data_observers {
namespace {

constexpr int kFirstCells = 4;
constexpr int kFirstCellsOfSeveral = 2;
constexpr double kWorthwhile = 0.99;
/// Entries of P at all nodes of a grid.
constexpr Eigen::Index kMostEntries = 450;
/// A cell is active where a condition has a margin of at most so many times the least.
constexpr double kActive = 3.0;

/// Of a theorem about timers and a subject; nothing for other theorems.
std::optional<TimerDependentFunction> a_function(const Theorem& theorem,
                                                 const CertificateSubject& subject) {
  if (theorem.name() == "timer_dependent_switched") return functions_of_modes(subject).front();
  return timer_dependent_function(theorem, subject);
}

bool is_small_enough(const TimerDependentFunction& function, std::size_t modes) {
  const Eigen::Index N = function.system().size;
  const auto matrices = static_cast<Eigen::Index>(modes * function.grid().size());
  return matrices * N * (N + 1) / 2 <= kMostEntries;
}

/// For each timer the intervals between nodes that are to be halved.
using Marks = std::vector<std::vector<bool>>;

Marks all_marked(const TensorGrid& grid, bool value) {
  Marks marks;
  for (std::size_t timer = 0; timer < grid.dimensions(); ++timer) {
    marks.emplace_back(grid.nodes(timer).size() - 1, value);
  }
  return marks;
}

Marks active_intervals(const TensorGrid& grid, const Certificate& certificate) {
  const std::vector<Condition> conditions = certificate.theorem->conditions(certificate.subject);
  const std::vector<ConditionCheck> checks = check(conditions, certificate.values);
  const auto cells = cells_of(grid);
  std::vector<double> margins(cells.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    if (!conditions[i].cell) continue;
    double& margin = margins[*conditions[i].cell];
    margin = std::min(margin, checks[i].margin());
  }
  const double least = *std::min_element(margins.begin(), margins.end());
  Marks marks = all_marked(grid, false);
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    if (margins[cell] > kActive * least) continue;
    for (std::size_t timer = 0; timer < grid.dimensions(); ++timer) {
      marks[timer][grid.position(cells[cell].front().node, timer)] = true;
    }
  }
  return marks;
}

CertificateSubject halved(CertificateSubject subject, const TensorGrid& grid, const Marks& marks) {
  subject.timer_nodes.clear();
  for (std::size_t timer = 0; timer < grid.dimensions(); ++timer) {
    const std::vector<double>& before = grid.nodes(timer);
    std::vector<double> nodes = {before.front()};
    for (std::size_t i = 0; i + 1 < before.size(); ++i) {
      if (marks[timer][i]) nodes.push_back((before[i] + before[i + 1]) / 2.0);
      nodes.push_back(before[i + 1]);
    }
    subject.timer_nodes.push_back(std::move(nodes));
  }
  return subject;
}

/// What an objective makes least: gamma, the final error, or what is made largest, less than 0.
double cost_of(const Design& design, Objective objective, const ErrorAssumptions& assumptions) {
  const Certificate& certificate = design.certificate;
  const Theorem& theorem = *certificate.theorem;
  switch (objective) {
    case Objective::kMinGamma:
      return theorem.gain_figure(certificate.values).value;
    case Objective::kMaxT2:
      return -certificate.subject.T2;
    case Objective::kMinT1:
      return certificate.subject.T1;
    case Objective::kMaxDecay:
      return -theorem.decay_figure(certificate.values).value;
    case Objective::kMinFinalError:
      return final_error(theorem, certificate.subject, certificate.values, assumptions);
    case Objective::kFeasible:
      break;
  }
  return 0.0;
}

/// Whether a function that falls at events, too, may well prove a smaller final error: a fall in
/// flow counts for T1 alone, which is little where the events may come much later.
bool may_fall_at_events(const Theorem& theorem, const CertificateSubject& subject,
                        Objective objective) {
  return objective == Objective::kMinFinalError && theorem.takes_fall_at_events() &&
         times_of_timers(subject).size() == 1 && 0.0 < subject.T1 && 2.0 * subject.T1 < subject.T2;
}

Design solve_refined(const Theorem& theorem, const CertificateSubject& subject, Objective objective,
                     const ErrorAssumptions& assumptions, const SolveOnGrid& solve) {
  const bool has_grid = a_function(theorem, subject).has_value();
  if (!has_grid || !subject.timer_nodes.empty()) return solve(subject, nullptr);
  std::optional<Design> best;
  double least = std::numeric_limits<double>::infinity();
  std::size_t attempts = 0;
  double seconds = 0.0;
  CertificateSubject next =
      with_cells(subject, times_of_timers(subject).size() > 1 ? kFirstCellsOfSeveral : kFirstCells);
  while (true) {
    const TensorGrid grid(next.timer_nodes);
    Marks marks = all_marked(grid, true);
    std::optional<DesignError> failure;
    try {
      Design found = solve(next, best ? &*best : nullptr);
      found.attempts += attempts;
      found.seconds += seconds;
      attempts = found.attempts;
      seconds = found.seconds;
      const double value = cost_of(found, objective, assumptions);
      const bool is_worthwhile = !best || value < least - (1.0 - kWorthwhile) * std::abs(least);
      if (value < least || !best) {
        const TensorGrid found_grid(found.certificate.subject.timer_nodes);
        // Where a search has made T2 as short as T1, nodes are missing.
        if (found_grid.size() == grid.size()) {
          marks = active_intervals(found_grid, found.certificate);
        }
        best = std::move(found);
        least = value;
      }
      best->attempts = attempts;
      best->seconds = seconds;
      if (!is_worthwhile) return *best;
    } catch (const DesignError& error) {
      if (best) return *best;
      failure = error;
    }
    next = halved(next, grid, marks);
    if (is_small_enough(*a_function(theorem, next), next.plant.modes.size())) continue;
    if (failure) throw DesignError(*failure);
    return *best;
  }
}

}  // namespace

Design solve_on_refined_cells(const Theorem& theorem, const CertificateSubject& subject,
                              Objective objective, const ErrorAssumptions& assumptions,
                              bool has_rate, const SolveOnGrid& solve) {
  const auto refined = [&](const CertificateSubject& own) {
    return solve_refined(theorem, own, objective, assumptions, solve);
  };
  if (has_rate || subject.falls_at_events || !may_fall_at_events(theorem, subject, objective)) {
    return refined(subject);
  }
  CertificateSubject falling = subject;
  falling.falls_at_events = true;
  std::optional<Design> best;
  std::optional<DesignError> failure;
  std::size_t attempts = 0;
  double seconds = 0.0;
  for (const CertificateSubject& own : {subject, falling}) {
    try {
      Design found = refined(own);
      attempts += found.attempts;
      seconds += found.seconds;
      if (!best ||
          cost_of(found, objective, assumptions) < cost_of(*best, objective, assumptions)) {
        best = std::move(found);
      }
    } catch (const DesignError& error) {
      if (!failure) failure = error;
    }
  }
  if (!best) throw DesignError(*failure);
  best->attempts = attempts;
  best->seconds = seconds;
  return *best;
}

}  // namespace sampled_data_observers
