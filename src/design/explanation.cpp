#include "sampled_data_observers/design/explanation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "paragraphs.h"
#include "sampled_data_observers/certificate/matrix_functions.h"
#include "sampled_data_observers/design/design_method.h"
#include "sampled_data_observers/design/observability.h"

namespace sampled_data_observers {
namespace {

/// Times between jumps, of T1 to T2, at which the pair at jumps is looked at.
constexpr int kTimes = 101;

/// Why no observer whatever can converge, and what would change that.
struct Obstacle {
  std::string name;
  std::string why;
  std::string remedy;
};

std::string seconds(double value) { return brief(value) + " s"; }

std::string fate(const Mode& mode, TimeDomain domain) {
  const double real = mode.eigenvalue.real();
  const double modulus = std::abs(mode.eigenvalue);
  if (domain == TimeDomain::kDiscrete) {
    if (modulus == 0.0) return "is gone after the jump";
    return (mode.decays(domain) ? "shrinks, by " : "does not shrink: by ") + brief(modulus) +
           " at each jump";
  }
  if (real < 0.0) return "decays, time constant " + seconds(-1.0 / real);
  if (real > 0.0) return "grows, doubles in " + seconds(std::log(2.0) / real);
  const Eigen::Index once = mode.eigenvalue.imag() == 0.0 ? 1 : 2;
  return mode.directions.cols() > once ? "stays, or grows like a power of time" : "stays";
}

double spectral_abscissa(const Eigen::MatrixXd& A) { return modes_of(A).front().eigenvalue.real(); }

double spectral_radius(const Eigen::MatrixXd& A) {
  double radius = 0.0;
  for (const Mode& mode : modes_of(A)) radius = std::max(radius, std::abs(mode.eigenvalue));
  return radius;
}

class Explanation {
 public:
  explicit Explanation(const CertificateSubject& subject)
      : subject_(subject), plant_(subject.plant) {}

  std::string text() {
    say_what_it_is();
    for (const ModeMatrices& mode : plant_.modes) {
      mode_name_ = plant_.modes.size() > 1 ? ", mode " + std::to_string(mode.label) : "";
      say_modes("FLOW" + mode_name_ + (plant_.is_linear() ? "" : ", linear part"), mode.A,
                TimeDomain::kContinuous);
      if (mode.C.rows() > 0) say_sampled_output(mode);
      if (mode.C_c.rows() > 0) say_continuous_output(mode);
      if (mode.A_d) {
        say_modes("JUMPS" + mode_name_ + " (linear part A_d)", *mode.A_d, TimeDomain::kDiscrete);
        if (mode.C_d.rows() > 0) say_output_at_jumps(mode);
        say_dwell_times(mode);
      }
    }
    if (!plant_.is_linear()) say_nonlinearity();
    say_methods();
    if (obstacles_.empty()) say_what_to_try();
    return verdict() + out_.text();
  }

 private:
  bool has_times() const { return subject_.T2 > 0.0; }
  std::string times() const {
    return "[T1, T2] = [" + brief(subject_.T1) + ", " + brief(subject_.T2) + "] s";
  }
  /// Else jumps or other modes may show what one flow does not.
  bool only_flows() const { return !plant_.jumps() && plant_.modes.size() == 1; }
  std::string moved(const Mode& mode) const {
    return states_moved(mode.directions, plant_.state_names);
  }

  void say_what_it_is() {
    out_.heading("PLANT");
    std::string names;
    for (const std::string& name : plant_.state_names) names += (names.empty() ? "" : ", ") + name;
    const ModeMatrices& mode = plant_.mode();
    out_.paragraph(std::to_string(plant_.states()) + " states: " + names);
    out_.paragraph(
        std::string(plant_.is_linear() ? "linear flow" : "Lipschitz flow") +
        (plant_.modes.size() > 1 ? " in " + std::to_string(plant_.modes.size()) + " modes" : "") +
        (plant_.jumps() ? ", with jumps" : ", no jumps") + "; outputs: " +
        std::to_string(mode.C.rows()) + " sampled, " + std::to_string(mode.C_c.rows()) +
        " continuous, " + std::to_string(mode.C_d.rows()) + " at jumps");
    out_.paragraph(has_times() ? "times between events: " + times()
                               : "times between events: not given (--T1, --T2 or design/sampling)");
  }

  void say_modes(const std::string& heading, const Eigen::MatrixXd& A, TimeDomain domain) {
    out_.heading(heading);
    const std::vector<std::size_t> widths = {26, 26};
    out_.row({"eigenvalue", "moves", "by itself"}, widths);
    for (const Mode& mode : modes_of(A)) {
      const Eigen::Index once = mode.eigenvalue.imag() == 0.0 ? 1 : 2;
      const Eigen::Index times = mode.directions.cols() / once;
      out_.row({brief(mode.eigenvalue) + (times > 1 ? ", " + std::to_string(times) + " times" : ""),
                moved(mode), fate(mode, domain)},
               widths);
    }
  }

  /// @return whether what is unseen decays
  bool say_unseen(const std::vector<Mode>& unseen, TimeDomain domain) {
    bool all_decay = true;
    for (const Mode& mode : unseen) {
      out_.bullet("unseen: the mode " + brief(mode.eigenvalue) + ", which moves " + moved(mode) +
                  "; it " + fate(mode, domain));
      all_decay = all_decay && mode.decays(domain);
    }
    return all_decay;
  }

  void say_sampled_output(const ModeMatrices& mode) {
    out_.heading("SAMPLED OUTPUT y = C x" + mode_name_);
    const std::vector<Mode> unseen = unseen_modes(mode.A, mode.C);
    if (unseen.empty()) {
      out_.paragraph("(A, C) is observable, of order " +
                     std::to_string(*observability_order(mode.A, mode.C)) +
                     ": so many values, y and its derivatives, determine the state.");
    } else {
      const bool detectable = is_detectable(mode.A, mode.C, TimeDomain::kContinuous);
      out_.paragraph(std::string("(A, C) is not observable") +
                     (detectable ? ", but detectable: what y does not show decays by itself."
                                 : ", and not detectable."));
      if (!say_unseen(unseen, TimeDomain::kContinuous) && only_flows()) {
        obstacles_.push_back(
            {"not detectable",
             "the sampled output never shows a mode of the flow that does not decay" + mode_name_,
             "measure something that the unseen modes move"});
      }
    }
    say_samples(mode);
  }

  void say_samples(const ModeMatrices& mode) {
    if (has_times()) {
      double least = std::numeric_limits<double>::infinity();
      double where = 0.0;
      for (int i = 0; i < kTimes; ++i) {
        const double tau = subject_.T1 + (subject_.T2 - subject_.T1) * i / (kTimes - 1);
        const double value = sampled_observability(mode.A, mode.C, tau);
        if (value < least) {
          least = value;
          where = tau;
        }
      }
      out_.paragraph(
          "Samples tau apart, (e^(A tau), C): least singular value of their "
          "observability matrix, " +
          std::string(unseen_modes(mode.A, mode.C).empty() ? "" : "on the states that y shows, ") +
          "over " + times() + ": " + brief(least) + ", at tau = " + seconds(where) + ".");
    }
    const double beat = longest_beat(mode.A);
    const std::vector<PathologicalInterval> all =
        pathological_intervals(mode.A, mode.C, std::max(subject_.T2, beat));
    if (all.empty()) {
      out_.paragraph(beat == 0.0 ? "There are no pathological intervals: no two eigenvalues of A "
                                   "differ in their imaginary part only."
                                 : "There are no pathological intervals: samples at any constant "
                                   "interval show all that the flow shows.");
      return;
    }
    std::vector<PathologicalInterval> within;
    for (const PathologicalInterval& interval : all) {
      if (has_times() && subject_.T1 <= interval.tau && interval.tau <= subject_.T2) {
        within.push_back(interval);
      }
    }
    if (within.empty()) {
      out_.paragraph(
          "Pathological intervals, at which samples show less than the flow: the first "
          "is tau = " +
          seconds(all.front().tau) + (has_times() ? "; none in " + times() : "") + ".");
      return;
    }
    out_.paragraph("Pathological intervals in " + times() + ", at which samples show less than " +
                   "the flow:");
    constexpr std::size_t kShown = 8;
    for (std::size_t i = 0; i < std::min(kShown, within.size()); ++i) {
      out_.bullet("tau = " + seconds(within[i].tau) + ": nothing is seen of a combination of " +
                  states_moved(within[i].directions, plant_.state_names) + ", which " +
                  (within[i].decays ? "decays" : "does not decay"));
    }
    if (within.size() > kShown) {
      out_.bullet("and " + std::to_string(within.size() - kShown) + " more");
    }
    const auto fatal = std::find_if(within.begin(), within.end(),
                                    [](const PathologicalInterval& one) { return !one.decays; });
    if (fatal == within.end() || !only_flows()) return;
    obstacles_.push_back({"not detectable at tau = " + seconds(fatal->tau),
                          "samples that come exactly every " + seconds(fatal->tau) + ", which " +
                              times() + " allows, don't show something that does not decay",
                          "choose [T1, T2] without " + seconds(fatal->tau) +
                              " (such as T2 below the first "
                              "pathological interval, " +
                              seconds(all.front().tau) + "), or sample another output as well"});
  }

  void say_continuous_output(const ModeMatrices& mode) {
    out_.heading("CONTINUOUS OUTPUT y_c = C_c x" + mode_name_);
    const std::vector<Mode> unseen = unseen_modes(mode.A, mode.C_c);
    if (unseen.empty()) {
      out_.paragraph("The flow is strongly differentially observable of order " +
                     std::to_string(*observability_order(mode.A, mode.C_c)) +
                     (plant_.is_linear() ? "" : ", in its linear part") +
                     ": a high-gain observer can forget as fast as wanted.");
      return;
    }
    out_.paragraph(
        "The flow is not strongly differentially observable of any order: high-gain "
        "observers don't apply.");
    if (say_unseen(unseen, TimeDomain::kContinuous)) {
      out_.paragraph(
          "It is detectable: a flow-based observer is possible, no faster than what is "
          "unseen.");
    } else {
      out_.paragraph("It is not detectable: no flow-based observer.");
    }
  }

  void say_output_at_jumps(const ModeMatrices& mode) {
    out_.heading("OUTPUT AT JUMPS y_d = C_d x" + mode_name_);
    const std::vector<Mode> unseen = unseen_modes(*mode.A_d, mode.C_d);
    if (unseen.empty()) {
      out_.paragraph("Jumps alone, (A_d, C_d): observable.");
    } else {
      out_.paragraph("Jumps alone, (A_d, C_d): not observable.");
      say_unseen(unseen, TimeDomain::kDiscrete);
    }
    if (!has_times()) return;
    std::vector<double> undetectable;
    double least = std::numeric_limits<double>::infinity();
    double where = subject_.T1;
    for (int i = 0; i < kTimes; ++i) {
      const double tau = subject_.T1 + (subject_.T2 - subject_.T1) * i / (kTimes - 1);
      const DiscretePair pair = pair_at_jumps(mode.A, *mode.A_d, mode.C_d, tau);
      if (!is_detectable(pair.F, pair.H, TimeDomain::kDiscrete)) undetectable.push_back(tau);
      const double margin = detectability_margin(pair.F, pair.H, TimeDomain::kDiscrete);
      if (margin < least) {
        least = margin;
        where = tau;
      }
    }
    if (undetectable.empty()) {
      out_.paragraph("Flow and jumps together, (A_d e^(A tau), C_d e^(A tau)): detectable at all " +
                     std::to_string(kTimes) + " values of tau looked at in " + times() +
                     (std::isfinite(least)
                          ? "; least margin " + brief(least) + ", at tau = " + seconds(where) + "."
                          : ", where everything decays by itself."));
      return;
    }
    out_.paragraph("Flow and jumps together, (A_d e^(A tau), C_d e^(A tau)): NOT detectable at " +
                   std::to_string(undetectable.size()) + " of " + std::to_string(kTimes) +
                   " values of tau looked at in " + times() +
                   ", such as tau = " + seconds(undetectable.front()) + ":");
    const DiscretePair pair = pair_at_jumps(mode.A, *mode.A_d, mode.C_d, undetectable.front());
    say_unseen(unseen_modes(pair.F, pair.H), TimeDomain::kDiscrete);
    if (mode.C_c.rows() > 0 || mode.C.rows() > 0 || plant_.modes.size() > 1) return;
    obstacles_.push_back({"not detectable at tau = " + seconds(undetectable.front()),
                          "jumps that come exactly every " + seconds(undetectable.front()) +
                              " don't show something that does not decay",
                          "measure more at jumps, or add a continuous output"});
  }

  /// Conditions (C) of bernard2022 with a quadratic Lyapunov function, in terms of the error, not
  /// of its square.
  void say_dwell_times(const ModeMatrices& mode) {
    out_.heading("TIMES BETWEEN JUMPS" + mode_name_);
    const double at_jump = spectral_radius(*mode.A_d);
    const double in_flow = spectral_abscissa(mode.A);
    if (mode.C_c.rows() > 0) {
      const double needed = has_times() && at_jump > 1.0 ? std::log(at_jump) / subject_.T1 : 0.0;
      out_.paragraph(
          "Flow-based (gain on y_c, jumps copied): the error must shrink in flow by more than it "
          "grows at a jump, bernard2022 (C1). Jumps multiply it by " +
          brief(at_jump) + " or more in the long run" +
          (at_jump <= 1.0 ? ", so that any rate of decay in flow may do."
           : has_times()  ? ": at jumps T1 apart, that takes a rate of decay of more than " +
                               brief(needed) + " 1/s."
                         : "."));
      const std::vector<Mode> unseen = unseen_modes(mode.A, mode.C_c);
      if (!unseen.empty() && has_times() && -unseen.front().eigenvalue.real() <= needed) {
        out_.bullet("what y_c does not show decays at " + brief(-unseen.front().eigenvalue.real()) +
                    " 1/s only: (22) can't hold; a longer T1 or another output is needed");
      }
    }
    if (mode.C_d.rows() > 0) {
      const double grown = has_times() ? std::exp(in_flow * subject_.T2) : 0.0;
      out_.paragraph(
          "Jump-based (gain on y_d, flow copied): the error must shrink at a jump by more than it "
          "grows in flow, bernard2022 (C2)" +
          (has_times() && in_flow > 0.0
               ? ". Flow multiplies it by about " + brief(grown) + " in T2."
           : in_flow > 0.0 ? "; there must be a longest time T2."
                           : ". Flow does not multiply it exponentially."));
      double unseen_factor = 0.0;
      for (const Mode& unseen : unseen_modes(*mode.A_d, mode.C_d)) {
        unseen_factor = std::max(unseen_factor, std::abs(unseen.eigenvalue));
      }
      if (unseen_factor * std::exp(in_flow * subject_.T2) >= 1.0) {
        out_.bullet("what y_d does not show of the jumps is multiplied by " + brief(unseen_factor) +
                    " at each: (26), which takes flow and jumps one by one, can't hold; (32) and "
                    "(36), which take them together, may");
      }
    }
    if (mode.C_c.rows() == 0 && mode.C_d.rows() == 0) {
      out_.paragraph(
          "Nothing is measured continuously or at jumps: methods for jumping plants "
          "have nothing to correct the estimate with.");
    }
  }

  void say_nonlinearity() {
    out_.heading("NONLINEARITY G psi(S x)");
    out_.paragraph(plant_.lipschitz_constant
                       ? "Lipschitz constant " + brief(*plant_.lipschitz_constant) +
                             ", which the methods of ferrante2019 rest on."
                       : "No plant/lipschitz_constant: the methods of ferrante2019 need it.");
    out_.paragraph(plant_.vertices.empty()
                       ? "No plant/vertices: the methods of etienne2019 need them."
                       : std::to_string(plant_.vertices.size()) +
                             " vertices, which the methods of etienne2019 rest on.");
    out_.paragraph(
        "What is said above is of the linear part A alone: psi may make it better or "
        "worse, and the methods allow for the worst.");
  }

  void say_methods() {
    out_.heading("METHODS");
    const std::vector<std::size_t> widths = {34};
    for (const DesignMethod* method : design_methods()) {
      const std::string why_not = objection_to(*method);
      if (!why_not.empty()) {
        out_.row({method->name(), "no: " + why_not}, widths);
        continue;
      }
      std::string objectives;
      for (const Objective objective : method->objectives(subject_)) {
        objectives += (objectives.empty() ? "" : ", ") + std::string(to_string(objective));
      }
      out_.row({method->name(), "applies: " + objectives}, widths);
      ++applicable_;
    }
  }

  /// Why a method can't serve; empty where nothing is against it.
  std::string objection_to(const DesignMethod& method) const {
    try {
      method.require_applicable(subject_);
    } catch (const std::invalid_argument& fault) {
      return fault.what();
    }
    return obstacles_.empty() ? "" : obstacles_.front().name;
  }

  /// What stands before all else: what makes the rest pointless.
  std::string verdict() const {
    if (obstacles_.empty()) return "";
    Paragraphs text;
    text.heading("NO OBSERVER CAN CONVERGE");
    for (const Obstacle& obstacle : obstacles_) {
      text.bullet(obstacle.why);
      text.bullet("to change that: " + obstacle.remedy);
    }
    return text.text() + "\n";
  }

  void say_what_to_try() {
    out_.heading("WHAT TO TRY");
    if (applicable_ == 0) {
      out_.bullet("no method is about this plant; see above what each asks for");
      return;
    }
    out_.bullet(
        "nothing found here forbids a design; whether a method finds one, `design "
        "synthesize` tells");
    if (!has_times()) out_.bullet("give the times between events, by --T1 and --T2");
    if (!plant_.jumps()) {
      out_.bullet(
          "`design synthesize --objective max-T2` tells how far apart samples may come, "
          "`design sweep` what longer times cost");
    }
    if (plant_.N.cols() == 0) {
      out_.bullet(
          "min-gamma needs design/N, by which the disturbance enters, and design/C_p, what "
          "of the error counts");
    }
    for (const ModeMatrices& mode : plant_.modes) {
      const auto all = pathological_intervals(mode.A, mode.C, longest_beat(mode.A));
      if (mode.C.rows() == 0 || all.empty()) continue;
      out_.bullet("a T2 near the first pathological interval, " + seconds(all.front().tau) +
                  ", makes gains large and proofs hard to find: stay well below");
      break;
    }
  }

  const CertificateSubject& subject_;
  const PlantMatrices& plant_;
  std::string mode_name_;
  std::vector<Obstacle> obstacles_;
  std::size_t applicable_ = 0;
  Paragraphs out_;
};

}  // namespace

std::string explain(const CertificateSubject& subject) { return Explanation(subject).text(); }

}  // namespace sampled_data_observers
