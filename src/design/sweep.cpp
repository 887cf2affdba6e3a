#include "design/sweep.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <set>

#include "design/packing.h"
#include "design/rank_tasks.h"
#include "design/request_error.h"
#include "design/synthesis.h"
#include "design/workers.h"

namespace sampled_data_observers {
namespace {

struct Task {
  const DesignMethod* method = nullptr;
  double T2 = 0.0;
};

std::vector<Task> tasks_of(const SweepRequest& request) {
  std::vector<Task> tasks;
  for (const double T2 : request.T2) {
    for (const DesignMethod* method : request.methods) tasks.push_back({method, T2});
  }
  return tasks;
}

/// The numbers of those that are not done.
std::vector<std::size_t> remaining(const std::vector<Task>& tasks, const SweepOptions& options) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const bool is_done = options.is_done && options.is_done(tasks[i].method->name(), tasks[i].T2);
    if (!is_done) numbers.push_back(i);
  }
  return numbers;
}

CertificateSubject subject_at(const SweepRequest& request, double T2) {
  CertificateSubject subject = request.subject;
  subject.T2 = T2;
  return subject;
}

Parameters known_to(const DesignMethod& method, const CertificateSubject& subject,
                    const Parameters& given) {
  Parameters known;
  for (const DesignParameter& parameter : method.parameters(subject)) {
    const auto found = given.find(parameter.name);
    if (found != given.end()) known.insert(*found);
  }
  return known;
}

GuaranteedFigure figure_of(const Theorem& theorem, Objective objective,
                           const NamedMatrices& values) {
  return objective == Objective::kMinGamma ? theorem.gain_figure(values)
                                           : theorem.decay_figure(values);
}

double value_of(const Design& design) {
  return figure_of(*design.certificate.theorem, design.objective, design.certificate.values).value;
}

void pack(const Parameters& parameters, Packer& packer) {
  NamedMatrices matrices;
  for (const auto& [name, value] : parameters) matrices[name] = scalar_matrix(value);
  packer.add(matrices);
}

Parameters unpack_parameters(Unpacker& unpacker) {
  Parameters parameters;
  for (const auto& [name, value] : unpacker.matrices()) parameters[name] = value(0, 0);
  return parameters;
}

/// In a worker process: the design of a task, or why there is none.
std::string solve(const Task& task, const SweepRequest& request, const SynthesisOptions& options) {
  DesignProblem problem;
  problem.subject = subject_at(request, task.T2);
  problem.given = known_to(*task.method, problem.subject, request.given);
  problem.objective = request.objective;
  Packer packer;
  try {
    const Design design = synthesize(*task.method, problem, options);
    packer.add(std::string());
    packer.add(design.certificate.values);
    pack(design.parameters, packer);
    packer.add(design.margin);
    packer.add(static_cast<std::int64_t>(design.proved_conditions));
    packer.add(design.solver);
    packer.add(static_cast<std::int64_t>(design.attempts));
  } catch (const DesignError& error) {
    packer.add(std::string(error.what()));
  }
  return packer.bytes();
}

void report(const Task& task, const SweepRequest& request, const WorkerOutcome& outcome,
            const SweepOptions& options) {
  SweepPoint point;
  point.method = task.method->name();
  point.T2 = task.T2;
  point.seconds = outcome.seconds;
  Unpacker unpacker(outcome.result);
  point.message = unpacker.text();
  if (!point.message.empty()) {
    options.on_point(point, nullptr);
    return;
  }
  Design design;
  design.method = task.method->name();
  design.observer_type = task.method->observer_type();
  design.objective = request.objective;
  design.certificate = {&task.method->theorem(), subject_at(request, task.T2), unpacker.matrices()};
  design.parameters = unpack_parameters(unpacker);
  design.margin = unpacker.number();
  design.proved_conditions = static_cast<std::size_t>(unpacker.integer());
  design.solver = unpacker.text();
  design.attempts = static_cast<std::size_t>(unpacker.integer());
  design.seconds = outcome.seconds;
  point.value = value_of(design);
  point.parameters = design.parameters;
  options.on_point(point, &design);
}

bool serves(const DesignMethod& method, const CertificateSubject& subject, Objective objective) {
  const std::vector<Objective> all = method.objectives(subject);
  return std::find(all.begin(), all.end(), objective) != all.end();
}

}  // namespace

std::string drawn_quantity(const DesignMethod& method, const CertificateSubject& subject,
                           Objective objective) {
  // Of these values the meaning does not depend.
  NamedMatrices values;
  const Theorem& theorem = method.theorem();
  for (const auto& shapes : {theorem.multipliers(subject), theorem.parameters(subject)}) {
    for (const NamedShape& shape : shapes) {
      values[shape.name] = Eigen::MatrixXd::Identity(shape.rows, shape.cols);
    }
  }
  return figure_of(theorem, objective, values).meaning;
}

bool is_better(Objective objective, double first, double second) {
  return objective == Objective::kMinGamma ? first < second : first > second;
}

std::vector<double> sweep_times(double low, double high, std::size_t points) {
  if (low > high || (low == high && points > 1)) {
    char text[96];
    std::snprintf(text, sizeof text, "T2 LOW HIGH: expected LOW < HIGH, found %.9g and %.9g", low,
                  high);
    throw DesignError(text);
  }
  std::vector<double> times;
  for (std::size_t i = 0; i < points; ++i) {
    const double share =
        points == 1 ? 1.0 : static_cast<double>(i) / static_cast<double>(points - 1);
    char text[40];
    std::snprintf(text, sizeof text, "%.6g", low + share * (high - low));
    times.push_back(std::strtod(text, nullptr));
  }
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!(std::isfinite(times[i]) && times[i] > (i == 0 ? 0.0 : times[i - 1]))) {
      throw DesignError("T2 from " + std::to_string(low) + " s to " + std::to_string(high) +
                        " s: expected " + std::to_string(points) +
                        " increasing positive numbers that differ in their first 6 digits");
    }
  }
  return times;
}

std::vector<const DesignMethod*> methods_for(const CertificateSubject& subject,
                                             Objective objective) {
  std::vector<const DesignMethod*> methods;
  for (const DesignMethod* method : design_methods()) {
    if (method->is_special_case()) continue;
    try {
      method->require_applicable(subject);
    } catch (const std::invalid_argument&) {
      continue;
    }
    if (!serves(*method, subject, objective)) continue;
    const bool is_alike =
        methods.empty() || drawn_quantity(*method, subject, objective) ==
                               drawn_quantity(*methods.front(), subject, objective);
    if (is_alike) methods.push_back(method);
  }
  return methods;
}

void require_sense(const SweepRequest& request) {
  const CertificateSubject subject = subject_at(request, request.T2.back());
  for (const DesignMethod* method : request.methods) {
    try {
      method->require_applicable(subject);
    } catch (const std::invalid_argument& fault) {
      throw DesignError(method->name() + " is not for this plant: " + fault.what());
    }
    if (!serves(*method, subject, request.objective)) {
      throw cannot_serve(*method, subject, request.objective);
    }
    const auto quantity = [&](const DesignMethod* of) {
      return drawn_quantity(*of, subject, request.objective);
    };
    const DesignMethod* first = request.methods.front();
    if (quantity(method) == quantity(first)) continue;
    throw DesignError("one sweep draws one quantity, but " + first->name() + " is about the " +
                      quantity(first) + " and " + method->name() + " about the " +
                      quantity(method) + ": sweep them apart");
  }
  for (const auto& [name, value] : request.given) {
    if (!std::isfinite(value))
      throw DesignError("parameter " + name + ": expected a finite number");
    const auto knows = [&, &name = name, &value = value](const DesignMethod* method) {
      return !known_to(*method, subject, {{name, value}}).empty();
    };
    if (std::none_of(request.methods.begin(), request.methods.end(), knows)) {
      throw DesignError("none of the methods has a parameter '" + name + "'");
    }
  }
}

std::size_t remaining_points(const SweepRequest& request, const SweepOptions& options) {
  return remaining(tasks_of(request), options).size();
}

std::size_t run_sweep(const SweepRequest& request, const SweepOptions& options) {
  require_sense(request);
  const std::vector<Task> tasks = tasks_of(request);
  const bool leads = options.ranks == nullptr || options.ranks->rank() == 0;
  const std::vector<std::size_t> numbers =
      leads ? remaining(tasks, options) : std::vector<std::size_t>();
  const std::size_t points = leads ? numbers.size() : tasks.size();
  // Points side by side; where there are more processors, attempts within a point as well.
  SynthesisOptions within;
  within.jobs = points == 0 ? 1U : std::max(1U, options.jobs / static_cast<unsigned>(points));
  within.time_limit = options.time_limit;
  WorkerOptions workers;
  workers.jobs = options.jobs;
  workers.time_limit = std::numeric_limits<double>::infinity();  // each attempt has its own
  workers.is_cancelled = options.is_cancelled;
  std::size_t lost = 0;
  workers.on_outcome = [&](std::size_t i, const WorkerOutcome& outcome) {
    if (outcome.status == WorkerOutcome::Status::kDone) {
      report(tasks[i], request, outcome, options);
    } else {
      ++lost;
    }
  };
  const auto task = [&](std::size_t i) { return solve(tasks[i], request, within); };
  std::size_t given = 0;
  const NextTask next = [&] {
    return given < numbers.size() ? std::optional(numbers[given++]) : std::nullopt;
  };
  if (options.ranks == nullptr) {
    run_tasks(next, task, workers);
  } else if (leads) {
    lead_tasks(*options.ranks, options.request, next, task, workers);
  } else {
    follow_tasks(*options.ranks, options.request, task, workers);
  }
  return lost;
}

std::vector<CurvePoint> best_curves(const std::vector<SweepPoint>& points, Objective objective) {
  std::set<std::string> methods;
  for (const SweepPoint& point : points) methods.insert(point.method);
  std::vector<CurvePoint> curves;
  for (const std::string& method : methods) {
    std::vector<CurvePoint> curve;
    for (const SweepPoint& point : points) {
      if (point.method == method) curve.push_back({method, point.T2, point});
    }
    std::sort(curve.begin(), curve.end(), [](const CurvePoint& first, const CurvePoint& second) {
      return first.T2 < second.T2;
    });
    for (std::size_t i = curve.size(); i-- > 1;) {
      const SweepPoint& longer = curve[i].design;
      SweepPoint& own = curve[i - 1].design;
      if (longer.value && (!own.value || is_better(objective, *longer.value, *own.value))) {
        own = longer;
      }
    }
    curves.insert(curves.end(), curve.begin(), curve.end());
  }
  return curves;
}

}  // namespace sampled_data_observers
