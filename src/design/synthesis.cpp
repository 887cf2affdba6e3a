#include "sampled_data_observers/design/synthesis.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

#include "sampled_data_observers/design/analysis.h"
#include "sampled_data_observers/design/packing.h"
#include "sampled_data_observers/design/parameter_search.h"
#include "sampled_data_observers/design/request_error.h"
#include "sampled_data_observers/design/require_detectable.h"
#include "sampled_data_observers/design/workers.h"

namespace sampled_data_observers {
namespace {

constexpr double kBisectionRatio = 1.001;
constexpr int kMaxHalvings = 30;
/// What is still feasible for so much more than was asked for has no largest value worth finding.
constexpr int kMaxDoublings = 10;

std::string packed(const DesignCandidate& candidate) {
  Packer packer;
  packer.add(candidate.values);
  packer.add(candidate.margin);
  packer.add(candidate.cost);
  packer.add(candidate.solver);
  packer.add(candidate.message);
  return packer.bytes();
}

DesignCandidate unpacked(const WorkerOutcome& outcome) {
  DesignCandidate candidate;
  switch (outcome.status) {
    case WorkerOutcome::Status::kDone: {
      Unpacker unpacker(outcome.result);
      candidate.values = unpacker.matrices();
      candidate.margin = unpacker.number();
      candidate.cost = unpacker.number();
      candidate.solver = unpacker.text();
      candidate.message = unpacker.text();
      break;
    }
    case WorkerOutcome::Status::kThrew:
      candidate.message = outcome.result;
      break;
    case WorkerOutcome::Status::kTimedOut:
      candidate.message = "the solver took longer than the time limit";
      break;
    case WorkerOutcome::Status::kCrashed:
      candidate.message = "the solver's process died";
      break;
  }
  return candidate;
}

class Synthesis {
 public:
  Synthesis(const DesignMethod& method, const DesignProblem& problem,
            const SynthesisOptions& options)
      : method_(method), problem_(problem), options_(options) {
    require_sense();
  }

  Design run() {
    const auto start = std::chrono::steady_clock::now();
    switch (problem_.objective) {
      case Objective::kFeasible:
      case Objective::kMinGamma:
        search(problem_.subject, problem_.given, problem_.objective, SearchGoal::kLeastCost);
        break;
      case Objective::kMaxT2:
        maximize(problem_.subject.T2, [this](double T2) {
          CertificateSubject subject = problem_.subject;
          subject.T2 = T2;
          subject.T1 = std::min(subject.T1, T2);
          return search(subject, problem_.given, Objective::kFeasible, SearchGoal::kAnySolution);
        });
        break;
      case Objective::kMaxDecay:
        maximize(starting_decay(), [this](double decay) {
          Parameters given = problem_.given;
          given[method_.decay_parameter()] = decay;
          return search(problem_.subject, given, Objective::kFeasible, SearchGoal::kAnySolution);
        });
        break;
    }
    if (!best_) throw DesignError(explanation());
    best_->seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    best_->attempts = attempts_;
    best_->objective = problem_.objective;
    return *best_;
  }

 private:
  void require_sense() const {
    try {
      method_.require_applicable(problem_.subject);
    } catch (const std::invalid_argument& fault) {
      throw RequestError(method_.name() + " is not for this plant: " + fault.what());
    }
    require_detectable(problem_.subject.plant);
    const std::vector<DesignParameter> known = method_.parameters(problem_.subject);
    for (const auto& [name, value] : problem_.given) {
      parameter_named(known, name);
      if (!std::isfinite(value)) {
        throw RequestError("parameter " + name + ": expected a finite number");
      }
    }
    for (const std::string& name : problem_.searched) {
      if (!parameter_named(known, name).search) {
        throw RequestError(method_.name() + " can't search for " + name + ": give a number");
      }
    }
    const auto objectives = method_.objectives(problem_.subject);
    if (std::find(objectives.begin(), objectives.end(), problem_.objective) == objectives.end()) {
      throw cannot_serve(method_, problem_.subject, problem_.objective);
    }
  }

  const DesignParameter& parameter_named(const std::vector<DesignParameter>& known,
                                         const std::string& name) const {
    std::string names;
    for (const DesignParameter& parameter : known) {
      if (parameter.name == name) return parameter;
      names += (names.empty() ? "" : ", ") + parameter.name;
    }
    throw RequestError(method_.name() + " has no parameter '" + name + "'; it has " + names);
  }

  double starting_decay() const {
    const auto given = problem_.given.find(method_.decay_parameter());
    if (given != problem_.given.end() && given->second > 0.0) return given->second;
    return 0.1 / problem_.subject.T2;
  }

  /// Tries all that is left open. Whether there is a verified design; the best one goes to best_.
  bool search(const CertificateSubject& subject, const Parameters& given, Objective objective,
              SearchGoal goal) {
    Parameters fixed;
    std::vector<NamedRange> ranges;
    for (const DesignParameter& parameter : method_.parameters(subject)) {
      const auto own = given.find(parameter.name);
      if (own != given.end()) {
        fixed[parameter.name] = own->second;
      } else if (parameter.search &&
                 (!parameter.default_value || problem_.searched.count(parameter.name) > 0)) {
        ranges.push_back({parameter.name, *parameter.search});
      } else if (parameter.default_value) {
        fixed[parameter.name] = *parameter.default_value;
      }
    }
    std::optional<Design> found;
    double found_cost = std::numeric_limits<double>::infinity();
    attempts_ += search_parameters(ranges, goal, [&](const std::vector<Parameters>& choices) {
      std::vector<Parameters> whole = choices;
      for (Parameters& parameters : whole) parameters.insert(fixed.begin(), fixed.end());
      const std::vector<DesignCandidate> candidates = attempt_all(subject, whole, objective);
      std::vector<double> costs;
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        const DesignCandidate& candidate = candidates[i];
        ++messages_[candidate.is_verified() ? "verified" : candidate.message];
        const double cost =
            candidate.is_verified() ? candidate.cost : std::numeric_limits<double>::infinity();
        costs.push_back(cost);
        if (!(cost < found_cost)) continue;
        found_cost = cost;
        found = as_design(subject, whole[i], candidate);
      }
      return costs;
    });
    if (found) best_ = std::move(found);
    return best_.has_value() && std::isfinite(found_cost);
  }

  std::vector<DesignCandidate> attempt_all(const CertificateSubject& subject,
                                           const std::vector<Parameters>& choices,
                                           Objective objective) {
    WorkerOptions worker;
    worker.jobs = options_.jobs;
    worker.time_limit = options_.time_limit;
    std::size_t finished = attempts_;
    worker.on_outcome = [&](std::size_t, const WorkerOutcome&) {
      if (options_.on_progress) options_.on_progress(method_.name(), ++finished);
    };
    const auto outcomes = run_in_workers(
        choices.size(),
        [&](std::size_t i) { return packed(method_.attempt(subject, choices[i], objective)); },
        worker);
    std::vector<DesignCandidate> candidates;
    for (const WorkerOutcome& outcome : outcomes) candidates.push_back(unpacked(outcome));
    return candidates;
  }

  Design as_design(const CertificateSubject& subject, const Parameters& parameters,
                   const DesignCandidate& candidate) const {
    Design design;
    design.method = method_.name();
    design.observer_type = method_.observer_type();
    design.certificate = {&method_.theorem(), subject, candidate.values};
    design.parameters = parameters;
    design.margin = candidate.margin;
    design.solver = candidate.solver;
    return design;
  }

  /// Largest value for which `feasible` holds, by doubling or halving from `start` and bisection.
  template <class Feasible>
  void maximize(double start, const Feasible& feasible) {
    double low = start;
    int halvings = 0;
    while (!feasible(low)) {
      if (++halvings > kMaxHalvings) return;
      low /= 2.0;
    }
    double high = 2.0 * low;
    for (int doublings = 0; halvings == 0 && feasible(high);) {
      low = high;
      high *= 2.0;
      if (++doublings < kMaxDoublings) continue;
      best_->has_no_maximum = true;
      return;
    }
    while (high / low > kBisectionRatio) {
      const double middle = std::sqrt(low * high);
      (feasible(middle) ? low : high) = middle;
    }
  }

  std::string explanation() const {
    std::ostringstream text;
    text << method_.name() << " found no design that " << method_.theorem().name()
         << " accepts, in " << attempts_ << (attempts_ == 1 ? " attempt:" : " attempts:");
    for (const auto& [message, count] : messages_) {
      text << "\n  " << count << " x " << (message.empty() ? "not verified" : message);
    }
    text << "\nA shorter T2, a smaller rate of convergence or a larger bound on the gain may help; "
            "`design explain` tells whether the plant can be observed from such samples at all.";
    return text.str();
  }

  const DesignMethod& method_;
  const DesignProblem& problem_;
  const SynthesisOptions& options_;
  std::optional<Design> best_;
  std::map<std::string, std::size_t> messages_;
  std::size_t attempts_ = 0;
};

}  // namespace

Design search_design(const DesignMethod& method, const DesignProblem& problem,
                     const SynthesisOptions& options) {
  return Synthesis(method, problem, options).run();
}

Design synthesize(const DesignMethod& method, const DesignProblem& problem,
                  const SynthesisOptions& options) {
  return prove_further(search_design(method, problem, options), options);
}

}  // namespace sampled_data_observers
