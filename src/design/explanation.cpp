#include "design/explanation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "design/design_method.h"
#include "design/explanation_parts.h"
#include "design/observability.h"

namespace sampled_data_observers {
namespace {

/// From this share of a pathological interval on, T2 is close to it.
constexpr double kClose = 0.8;

/// The method to begin with: the first of these that applies.
struct Recommendation {
  const char* method;
  const char* why;
};
constexpr Recommendation kRecommendations[] = {
    {"bernard2022_equation36",
     "it takes flow and jumps together, for the gain at jumps that the times between them need"},
    {"bernard2022_equation15", "it uses both the continuous output and that at jumps"},
    {"bernard2022_equation22", "it corrects in flow, and jumps are copied"},
    {"bernard2022_section7_3_2", "it knows that the mode changes with every switch"},
    {"bernard2022_example7_1", "it corrects in flow, in each mode by its own gain"},
    {"sferlazza2019_algorithm1",
     "a gain that knows the time since the last sample reaches the longest times and fastest "
     "rates"},
    {"ferrante2019_alternating",
     "of the paper's methods it finds the least gain from the disturbance; "
     "timer_dependent_constant_gain finds a smaller one for most plants"},
    {"etienne2019_proposition2", "it needs no Lipschitz constant, and bounds what noise does"},
};

class Explanation {
 public:
  explicit Explanation(const CertificateSubject& subject) : c_(subject) {}

  std::string text() {
    say_what_it_is();
    for (const ModeMatrices& mode : c_.plant.modes) {
      c_.mode_name = c_.plant.modes.size() > 1 ? ", mode " + std::to_string(mode.label) : "";
      say_modes(c_, "FLOW" + c_.mode_name + (c_.plant.is_linear() ? "" : ", linear part"), mode.A,
                TimeDomain::kContinuous);
      if (mode.C.rows() > 0) say_sampled_output(c_, mode);
      if (mode.C_c.rows() > 0) say_continuous_output(c_, mode);
      if (mode.A_d) {
        say_modes(c_, "JUMPS" + c_.mode_name + " (linear part A_d)", *mode.A_d,
                  TimeDomain::kDiscrete);
        if (mode.C_d.rows() > 0) say_output_at_jumps(c_, mode);
        say_dwell_times(c_, mode);
      }
    }
    if (c_.plant.lipschitz_jump && !c_.plant.mode().A_d) {
      c_.out.heading("JUMPS");
      c_.out.paragraph("By formulas, Lipschitz constant " +
                       brief(c_.plant.lipschitz_jump->constant) +
                       ": the methods of bernard2022_corollary4_1 need no more.");
    }
    if (!c_.plant.is_linear()) say_nonlinearity();
    say_methods();
    if (c_.obstacles.empty()) say_least_gain(c_);
    if (c_.obstacles.empty()) say_what_to_try();
    return verdict() + c_.out.text();
  }

 private:
  void say_what_it_is() {
    c_.out.heading("PLANT");
    std::string names;
    for (const std::string& name : c_.plant.state_names)
      names += (names.empty() ? "" : ", ") + name;
    const ModeMatrices& mode = c_.plant.mode();
    c_.out.paragraph(std::to_string(c_.plant.states()) + " states: " + names);
    c_.out.paragraph(
        std::string(c_.plant.is_linear() ? "linear flow" : "Lipschitz flow") +
        (c_.plant.modes.size() > 1 ? " in " + std::to_string(c_.plant.modes.size()) + " modes"
                                   : "") +
        (c_.plant.jumps() ? ", with jumps" : ", no jumps") + "; outputs: " +
        std::to_string(mode.C.rows()) + " sampled, " + std::to_string(mode.C_c.rows()) +
        " continuous, " + std::to_string(mode.C_d.rows()) + " at jumps");
    c_.out.paragraph(c_.has_times_of_sensors() ? "times between samples: " + times_of_sensors(c_)
                     : c_.has_times()
                         ? "times between events: " + c_.times()
                         : "times between events: not given (--T1, --T2 or design/sampling)");
    if (c_.plant.flow_vertices.empty()) return;
    c_.out.paragraph(
        "What follows is of the mean of the " + std::to_string(c_.plant.flow_vertices.size()) +
        " plant/jacobian_vertices; the methods that depend on timers are for all flows "
        "in their hull.");
  }

  void say_nonlinearity() {
    c_.out.heading("NONLINEARITY G psi(S x)");
    c_.out.paragraph(c_.plant.lipschitz_constant
                         ? "Lipschitz constant " + brief(*c_.plant.lipschitz_constant) +
                               ", which the methods of ferrante2019 rest on."
                         : "No plant/lipschitz_constant: the methods of ferrante2019 need it.");
    c_.out.paragraph(c_.plant.vertices.empty()
                         ? "No plant/vertices: the methods of etienne2019 need them."
                         : std::to_string(c_.plant.vertices.size()) +
                               " vertices, which the methods of etienne2019 rest on.");
    c_.out.paragraph(
        "What is said above is of the linear part A alone: psi may make it better or "
        "worse, and the methods allow for the worst.");
  }

  /// Those that apply, one below the other, then the others by what they are about.
  void say_methods() {
    c_.out.heading("METHODS");
    std::vector<std::pair<std::string, std::string>> others;  // reason, names
    const auto add_other = [&others](const std::string& why_not, const std::string& name) {
      for (auto& [reason, names] : others) {
        if (reason != why_not) continue;
        names += ", " + name;
        return;
      }
      others.emplace_back(why_not, name);
    };
    for (const DesignMethod* method : design_methods()) {
      const std::string why_not = objection_to(*method);
      if (why_not.empty()) {
        say_applicable(*method);
      } else {
        add_other(why_not, method->name());
      }
    }
    if (others.empty()) return;
    c_.out.paragraph(applicable_.empty() ? "No method applies:" : "The others do not:");
    for (const auto& [reason, names] : others) c_.out.bullet(reason + ": " + names);
  }

  void say_applicable(const DesignMethod& method) {
    std::string objectives;
    for (const Objective objective : method.objectives(c_.subject)) {
      objectives += (objectives.empty() ? "" : ", ") + std::string(to_string(objective));
    }
    const std::vector<std::size_t> widths = {38};
    c_.out.row({method.name(), "applies: " + objectives}, widths);
    applicable_.push_back(method.name());
  }

  /// Why a method can't serve; empty where nothing is against it.
  std::string objection_to(const DesignMethod& method) const {
    try {
      method.require_applicable(c_.subject);
      require_subject(method.theorem(), c_.subject);
    } catch (const std::invalid_argument& fault) {
      return fault.what();
    }
    return c_.obstacles.empty() ? "" : c_.obstacles.front().name;
  }

  /// What stands before all else: what makes the rest pointless.
  std::string verdict() const {
    if (c_.obstacles.empty()) return "";
    Paragraphs text;
    text.heading("NO OBSERVER CAN CONVERGE");
    for (const Obstacle& obstacle : c_.obstacles) {
      text.bullet(obstacle.why);
      text.bullet("to change that: " + obstacle.remedy);
    }
    return text.text() + "\n";
  }

  void say_what_to_try() {
    c_.out.heading("WHAT TO TRY");
    if (applicable_.empty()) {
      c_.out.bullet("no method is about this plant; see above what each asks for");
      return;
    }
    c_.out.bullet(
        "nothing found here forbids a design; whether a method finds one, `design "
        "synthesize` tells");
    say_recommendation();
    if (!c_.has_times()) c_.out.bullet("give the times between events, by --T1 and --T2");
    if (!c_.plant.jumps()) {
      const bool is_one_sensor = c_.plant.sampled.size() < 2;
      c_.out.bullet(
          std::string(
              "`design synthesize --objective max-T2` tells how far apart samples may come") +
          (is_one_sensor ? ", `design sweep` what longer times cost" : ""));
    }
    if (c_.plant.N.cols() == 0) {
      c_.out.bullet(
          "min-gamma needs design/N, by which the disturbance enters, and design/C_p, what "
          "of the error counts");
    }
    for (const ModeMatrices& mode : c_.plant.modes) say_nearest_pathology(mode);
  }

  /// Only where T2 comes close: designs for longer or much shorter times work well.
  void say_nearest_pathology(const ModeMatrices& mode) {
    if (mode.C.rows() == 0 || !c_.has_longest() || c_.has_several_sensors()) return;
    for (const PathologicalInterval& interval :
         pathological_intervals(mode.A, mode.C, c_.subject.T2 / kClose)) {
      if (interval.decays || interval.tau <= c_.subject.T2) continue;
      c_.out.bullet("T2 is close to the pathological interval " + seconds(interval.tau) +
                    ": expect large gains, and proofs that are hard to find; a shorter T2 costs "
                    "less");
      return;
    }
  }

  void say_recommendation() {
    if (applicable_.empty()) return;
    for (const Recommendation& candidate : kRecommendations) {
      // Its guarantee is about plants without disturbance.
      if (c_.plant.N.cols() > 0 && candidate.method == std::string("sferlazza2019_algorithm1")) {
        continue;
      }
      if (std::find(applicable_.begin(), applicable_.end(), candidate.method) ==
          applicable_.end()) {
        continue;
      }
      c_.out.bullet(
          std::string("begin with `design synthesize` without --method, which takes the best of "
                      "several, or with --method ") +
          candidate.method + ": " + candidate.why);
      return;
    }
  }

  ExplanationContext c_;
  std::vector<std::string> applicable_;
};

}  // namespace

std::string explain(const CertificateSubject& subject) { return Explanation(subject).text(); }

double longest_looked_at(const CertificateSubject& subject) {
  constexpr double kTypicalTimes = 10.0;
  return std::isfinite(subject.T2) ? subject.T2 : kTypicalTimes * time_scale(subject);
}

}  // namespace sampled_data_observers
