#include "design/design_search.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <locale>
#include <optional>
#include <sstream>

#include "certificate/timer_grid.h"
#include "design/attempts.h"
#include "design/final_error.h"
#include "design/methods/sampled_plant.h"
#include "design/parameter_search.h"
#include "design/plant_scaling.h"
#include "design/request_error.h"
#include "design/require_detectable.h"
#include "design/threads.h"

namespace sampled_data_observers {
namespace {

constexpr double kBisectionRatio = 1.001;
constexpr int kMaxHalvings = 30;
/// To tell how much less than what was asked for there is a design for, and how exactly.
constexpr int kMaxHalvingsBelowAsked = 8;
constexpr double kRefusalRatio = 1.01;
/// What is still feasible for so much more than was asked for has no largest value worth finding.
constexpr int kMaxDoublings = 10;
/// Between parameters looked at around the best ones so far, at first and at last, and by how much
/// less what is maximized is enlarged at last.
constexpr double kFirstDistance = 0.24;
constexpr double kLastDistance = 0.02;
constexpr double kLastStep = 4e-4;

/// Parameters that are fixed, and those searched for with their ranges.
struct Choices {
  Parameters fixed;
  std::vector<NamedRange> open;
};

/// A design problem at one value of what is maximized.
struct Trial {
  CertificateSubject subject;
  Parameters given;
};

class DesignSearch {
 public:
  DesignSearch(const DesignMethod& method, const DesignProblem& problem,
               const SynthesisOptions& options)
      : method_(method), problem_(problem), options_(options) {
    require_sense();
  }

  Design run() {
    const auto start = std::chrono::steady_clock::now();
    switch (problem_.objective) {
      case Objective::kFeasible:
      case Objective::kMinGamma:
      case Objective::kMinFinalError:
        search(problem_.subject, problem_.given, problem_.objective,
               problem_.objective == Objective::kMinFinalError ? SearchGoal::kSmallCost
                                                               : SearchGoal::kLeastCost);
        break;
      case Objective::kMaxT2:
        maximize(problem_.subject.T2, !problem_.accepts_less, "T2", [this](double T2) {
          return Trial{with_longest_time(problem_.subject, T2), problem_.given};
        });
        break;
      case Objective::kMinT1:
        minimize_shortest_time();
        break;
      case Objective::kMaxDecay: {
        const std::string decay = method_.decay_parameter();
        const auto given = problem_.given.find(decay);
        const bool is_given = given != problem_.given.end() && given->second > 0.0;
        const double start =
            is_given ? given->second : 0.1 / (is_rate(decay) ? time_scale(problem_.subject) : 1.0);
        maximize(start, is_given && !problem_.accepts_less, decay, [this, &decay](double value) {
          Trial trial{problem_.subject, problem_.given};
          trial.given[decay] = value;
          return trial;
        });
        break;
      }
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
    sampled_data_observers::require_sense(method_, problem_);
    require_detectable(balanced(problem_.subject).plant);
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

  /// Defaults are those of the problem as it was given, whatever is maximized.
  Choices choices_of(const CertificateSubject& subject, const Parameters& given) const {
    Choices choices;
    const bool seeks_rate = problem_.objective == Objective::kMinFinalError;
    if (seeks_rate) {
      choices.fixed[kNoise] = problem_.assumptions.noise;
      choices.fixed[kDisturbance] = problem_.assumptions.disturbance;
    }
    const std::vector<DesignParameter> as_given = method_.parameters(problem_.subject);
    for (const DesignParameter& parameter : method_.parameters(subject)) {
      const auto own = given.find(parameter.name);
      const auto& default_value = parameter_named(as_given, parameter.name).default_value;
      if (own != given.end()) {
        choices.fixed[parameter.name] = own->second;
      } else if (seeks_rate && parameter.name == "mu") {
        choices.open.push_back({parameter.name, final_error_falls(problem_.accepts_slow)});
      } else if (seeks_rate && !subject.falls_at_events &&
                 parameter.name == method_.decay_parameter()) {
        choices.open.push_back({parameter.name, final_error_rates(subject, problem_.assumptions,
                                                                  problem_.accepts_slow)});
      } else if (parameter.search &&
                 (!default_value || problem_.searched.count(parameter.name) > 0)) {
        choices.open.push_back({parameter.name, *parameter.search});
      } else if (default_value) {
        choices.fixed[parameter.name] = *default_value;
      }
    }
    return choices;
  }

  /// Tries all that is left open. Whether there is a proved design; the best one goes to best_.
  bool search(const CertificateSubject& subject, const Parameters& given, Objective objective,
              SearchGoal goal) {
    if (!shows_all(subject)) return false;
    const Choices choices = choices_of(subject, given);
    BestOf best;
    search_parameters(choices.open, goal, [&](const std::vector<Parameters>& open) {
      return attempt_all(subject, choices, open, objective, best);
    });
    return take(best);
  }

  /// The same only for parameters near those of best_: each of them, and of those searched for each
  /// neighbour at this distance, measured in the logarithm where their range is logarithmic.
  bool search_near(const Trial& trial, double distance) {
    if (!shows_all(trial.subject)) return false;
    const Choices choices = choices_of(trial.subject, trial.given);
    std::vector<Parameters> open;
    for (const NamedRange& named : choices.open) {
      open = neighbours(open.empty() ? std::vector<Parameters>{{}} : open, named,
                        best_->parameters.at(named.name), distance);
    }
    if (open.empty()) open = {{}};
    BestOf best;
    attempt_all(trial.subject, choices, open, Objective::kFeasible, best);
    return take(best);
  }

  struct BestOf {
    std::optional<Design> design;
    double cost = std::numeric_limits<double>::infinity();
  };

  bool take(BestOf& best) {
    if (best.design) best_ = std::move(best.design);
    return std::isfinite(best.cost);
  }

  /// Whether no time between samples hides a mode that does not decay.
  bool shows_all(const CertificateSubject& subject) {
    const std::string unseen = undetectable_sampling(balanced(subject));
    if (!unseen.empty()) ++messages_[unseen];
    return unseen.empty();
  }

  std::vector<double> attempt_all(const CertificateSubject& subject, const Choices& choices,
                                  const std::vector<Parameters>& open, Objective objective,
                                  BestOf& best) {
    ThreadOptions threads;
    threads.jobs = options_.jobs;
    threads.time_limit = options_.time_limit;
    std::size_t finished = attempts_;
    threads.on_done = [&] {
      if (options_.on_progress) options_.on_progress(method_.name(), ++finished);
    };
    std::vector<Parameters> whole = open;
    for (Parameters& parameters : whole) {
      parameters.insert(choices.fixed.begin(), choices.fixed.end());
    }
    const std::vector<DesignCandidate> candidates = proved_attempts(
        method_, subject, whole, objective,
        problem_.given.count("gain_bound") > 0 ? GainBound::kGiven : GainBound::kOfScaledPlant,
        threads);
    attempts_ += candidates.size();
    std::vector<double> costs;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const DesignCandidate& candidate = candidates[i];
      ++messages_[candidate.is_verified() ? "verified" : candidate.message];
      costs.push_back(candidate.is_verified() ? candidate.cost
                                              : std::numeric_limits<double>::infinity());
      if (!(costs.back() < best.cost)) continue;
      best.cost = costs.back();
      best.design = as_design(subject, whole[i], candidate);
    }
    return costs;
  }

  Design as_design(const CertificateSubject& subject, const Parameters& parameters,
                   const DesignCandidate& candidate) const {
    Design design;
    design.method = method_.name();
    design.observer_type = method_.observer_type();
    design.certificate = {&method_.theorem(), subject, candidate.values};
    design.parameters = parameters;
    if (candidate.gain_bound > 0.0) design.parameters["gain_bound"] = candidate.gain_bound;
    for (auto& [name, value] : design.parameters) {
      const auto own = candidate.values.find(name);
      if (own != candidate.values.end()) value = own->second(0, 0);
    }
    design.margin = candidate.margin;
    design.proved_conditions = candidate.proved_conditions;
    design.solver = candidate.solver;
    return design;
  }

  /// Largest value for which there is a design, by doubling from `start` and bisection.
  /// @param is_asked  whether less than `start` is no answer
  template <class TrialAt>
  void maximize(double start, bool is_asked, const std::string& what, const TrialAt& trial_at) {
    const auto feasible = [&](double value) {
      const Trial trial = trial_at(value);
      if (best_ && search_near(trial, kFirstDistance)) return true;
      return search(trial.subject, trial.given, Objective::kFeasible, SearchGoal::kAnySolution);
    };
    double low = start;
    int halvings = 0;
    while (!feasible(low)) {
      low /= 2.0;
      const bool is_empty = trial_at(low).subject.T1 > trial_at(low).subject.T2;
      if (is_empty || ++halvings > (is_asked ? kMaxHalvingsBelowAsked : kMaxHalvings)) return;
    }
    double high = 2.0 * low;
    for (int doublings = 0; halvings == 0 && feasible(high);) {
      low = high;
      high *= 2.0;
      if (++doublings < kMaxDoublings) continue;
      best_->search_ended = true;
      return;
    }
    const bool is_refused = is_asked && halvings > 0;
    while (high / low > (is_refused ? kRefusalRatio : kBisectionRatio)) {
      const double middle = std::sqrt(low * high);
      (feasible(middle) ? low : high) = middle;
    }
    if (is_refused) refuse_less_than_asked(what, start, low);
    refine(low, trial_at);
  }

  /// Shortest T1 for which there is a design: 0, or by halving and bisection.
  void minimize_shortest_time() {
    const auto trial_at = [this](double T1) {
      return Trial{with_shortest_time(problem_.subject, T1), problem_.given};
    };
    const auto feasible = [&](double T1) {
      const Trial trial = trial_at(T1);
      return search(trial.subject, trial.given, Objective::kFeasible, SearchGoal::kAnySolution);
    };
    if (applies_to(trial_at(0.0).subject) && feasible(0.0)) return;
    const bool has_any_start = problem_.accepts_less || problem_.subject.T1 == 0.0;
    double high = has_any_start ? problem_.subject.T2 : problem_.subject.T1;
    if (!feasible(high)) return;
    double low = high / 2.0;
    for (int halvings = 1; feasible(low); ++halvings) {
      high = low;
      low /= 2.0;
      if (halvings < kMaxDoublings) continue;
      best_->search_ended = true;
      return;
    }
    while (high / low > kBisectionRatio) {
      const double middle = std::sqrt(low * high);
      (feasible(middle) ? high : low) = middle;
    }
  }

  bool applies_to(const CertificateSubject& subject) const {
    try {
      method_.require_applicable(subject);
      return true;
    } catch (const std::invalid_argument&) {
      return false;
    }
  }

  /// Near the largest value, only parameters near the best ones have a solution, which no grid
  /// meets. So as long as neighbours of the best ones allow a larger value, it goes on from there.
  template <class TrialAt>
  void refine(double value, const TrialAt& trial_at) {
    const Trial first = trial_at(value);
    if (choices_of(first.subject, first.given).open.empty()) return;
    double step = kBisectionRatio - 1.0;
    for (double distance = kFirstDistance; distance > kLastDistance;) {
      if (search_near(trial_at(value * (1.0 + step)), distance)) {
        value *= 1.0 + step;
        step *= 2.0;
      } else if (step > kLastStep) {
        step /= 2.0;
      } else {
        distance /= 2.0;
        step = kBisectionRatio - 1.0;
      }
    }
  }

  [[noreturn]] void refuse_less_than_asked(const std::string& what, double asked, double found) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << method_.name() << " found no design for " << what << " = " << asked
         << " as asked for; the largest " << what << " for which it found one is " << found
         << ". Tried, among others:" << tried();
    throw DesignError(text.str());
  }

  std::string tried() const {
    std::ostringstream text;
    for (const auto& [message, count] : messages_) {
      text << "\n  " << count << " x " << (message.empty() ? "not verified" : message);
    }
    return text.str();
  }

  std::string explanation() const {
    std::ostringstream text;
    text << method_.name() << " found no design that " << method_.theorem().name()
         << " accepts, in " << attempts_ << (attempts_ == 1 ? " attempt:" : " attempts:") << tried()
         << "\nA shorter T2, a smaller rate of convergence or a larger bound on the gain may help; "
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

void require_sense(const DesignMethod& method, const DesignProblem& problem) {
  try {
    method.require_applicable(problem.subject);
    require_subject(method.theorem(), problem.subject);
  } catch (const std::invalid_argument& fault) {
    throw RequestError(method.name() + " is not for this plant: " + fault.what());
  }
}

Design search_design(const DesignMethod& method, const DesignProblem& problem,
                     const SynthesisOptions& options) {
  Design design = DesignSearch(method, problem, options).run();
  if (problem.objective == Objective::kMinFinalError && problem.subject.plant.N.cols() > 0) {
    design.disturbance = problem.assumptions.disturbance;
  }
  return design;
}

}  // namespace sampled_data_observers
