#include "design/timer_cells.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "certificate/timer_dependent.h"
#include "design/run_time_figures.h"

namespace sampled_data_observers {
namespace {

constexpr int kFirstCells = 4;
constexpr int kFirstCellsOfSeveral = 2;
/// Of each timer, where the function is a sum.
constexpr int kCellsOfSum = 4;
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

/// One kind of function on a growing grid.
class RefinedSearch {
 public:
  RefinedSearch(const Theorem& theorem, CertificateSubject subject, Objective objective,
                const ErrorAssumptions& assumptions, const SolveOnGrid& solve)
      : theorem_(theorem),
        next_(std::move(subject)),
        objective_(objective),
        assumptions_(assumptions),
        solve_(solve),
        refines_(a_function(theorem, next_) && next_.timer_nodes.empty()) {
    if (theorem.sums_over_timers() && next_.timer_nodes.empty()) {
      next_ = with_cells(next_, kCellsOfSum);
    }
    if (!refines_) return;
    const bool has_several = times_of_timers(next_).size() > 1;
    next_ = with_cells(next_, has_several ? kFirstCellsOfSeveral : kFirstCells);
  }

  /// Solves on the next grid.
  /// @throws DesignError  where it was the finest one, and none has a solution
  void advance() {
    std::exception_ptr failure;
    const std::vector<std::vector<double>> nodes = next_.timer_nodes;
    Marks marks = refines_ ? all_marked(TensorGrid(nodes), true) : Marks();
    try {
      is_done_ = !improve(solve_(next_, best_ ? &*best_ : nullptr), marks) || !refines_;
    } catch (const DesignError&) {
      is_done_ = best_ || !refines_;
      failure = std::current_exception();
    }
    if (!is_done_) {
      next_ = halved(next_, TensorGrid(nodes), marks);
      is_done_ = !is_small_enough(*a_function(theorem_, next_), next_.plant.modes.size());
    }
    if (is_done_ && !best_) std::rethrow_exception(failure);
  }

  /// Whether a finer grid is not worth while.
  bool is_done() const { return is_done_; }
  const std::optional<Design>& best() const { return best_; }
  /// Of the best one.
  double cost() const { return cost_; }
  std::size_t attempts() const { return attempts_; }
  double seconds() const { return seconds_; }

 private:
  /// Returns whether the gain is worth a finer grid, and leaves in marks where.
  bool improve(Design found, Marks& marks) {
    attempts_ += found.attempts;
    seconds_ += found.seconds;
    const double cost = cost_of(found, objective_, assumptions_);
    const bool is_worthwhile = !best_ || cost < cost_ - (1.0 - kWorthwhile) * std::abs(cost_);
    if (best_ && !(cost < cost_)) return false;
    if (refines_) {
      const TensorGrid grid(found.certificate.subject.timer_nodes);
      // Where a search has made T2 as short as T1, nodes are missing.
      if (grid.size() == TensorGrid(next_.timer_nodes).size()) {
        marks = active_intervals(grid, found.certificate);
      }
    }
    best_ = std::move(found);
    cost_ = cost;
    return is_worthwhile;
  }

  const Theorem& theorem_;
  CertificateSubject next_;
  Objective objective_;
  const ErrorAssumptions& assumptions_;
  const SolveOnGrid& solve_;
  bool refines_;
  bool is_done_ = false;
  std::optional<Design> best_;
  double cost_ = std::numeric_limits<double>::infinity();
  std::size_t attempts_ = 0;
  double seconds_ = 0.0;
};

}  // namespace

Design solve_on_refined_cells(const Theorem& theorem, const CertificateSubject& subject,
                              Objective objective, const ErrorAssumptions& assumptions,
                              bool has_rate, const SolveOnGrid& solve) {
  std::vector<CertificateSubject> kinds = {subject};
  if (!has_rate && !subject.falls_at_events && may_fall_at_events(theorem, subject, objective)) {
    kinds.push_back(subject);
    kinds.back().falls_at_events = true;
  }
  std::vector<RefinedSearch> searches;
  for (const CertificateSubject& kind : kinds) {
    searches.emplace_back(theorem, kind, objective, assumptions, solve);
  }
  // Which kind is the better one, the first grid on which one has a solution tells.
  RefinedSearch* best = nullptr;
  std::exception_ptr failure;
  while (best == nullptr) {
    for (RefinedSearch& search : searches) {
      if (search.is_done()) continue;
      try {
        search.advance();
      } catch (const DesignError&) {
        if (!failure) failure = std::current_exception();
        continue;
      }
      if (search.best() && (best == nullptr || search.cost() < best->cost())) best = &search;
    }
    const bool is_over = std::all_of(searches.begin(), searches.end(),
                                     [](const RefinedSearch& search) { return search.is_done(); });
    if (best == nullptr && is_over) std::rethrow_exception(failure);
  }
  while (!best->is_done()) best->advance();
  Design design = *best->best();
  design.attempts = 0;
  design.seconds = 0.0;
  for (const RefinedSearch& search : searches) {
    design.attempts += search.attempts();
    design.seconds += search.seconds();
  }
  return design;
}

}  // namespace sampled_data_observers
