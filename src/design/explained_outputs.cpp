#include <algorithm>
#include <cmath>
#include <limits>

#include "design/explanation_parts.h"

namespace sampled_data_observers {
namespace {

/// Times between events, of T1 to T2, at which pairs are looked at.
constexpr int kTimes = 101;

void say_samples(ExplanationContext& c, const ModeMatrices& mode) {
  const double beat = longest_beat(mode.A);
  const std::vector<PathologicalInterval> all =
      pathological_intervals(mode.A, mode.C, std::max(c.longest(), beat));
  std::vector<PathologicalInterval> within;
  for (const PathologicalInterval& interval : all) {
    if (c.has_times() && c.subject.T1 <= interval.tau && interval.tau <= c.subject.T2) {
      within.push_back(interval);
    }
  }
  if (c.has_times()) {
    std::vector<double> times;
    for (int i = 0; i < kTimes; ++i) {
      times.push_back(c.subject.T1 + (c.longest() - c.subject.T1) * i / (kTimes - 1));
    }
    // Between those the dip may be narrow.
    for (const PathologicalInterval& interval : within) times.push_back(interval.tau);
    double least = std::numeric_limits<double>::infinity();
    double where = 0.0;
    for (const double tau : times) {
      const double value = sampled_observability(mode.A, mode.C, tau);
      if (value < least) {
        least = value;
        where = tau;
      }
    }
    c.out.paragraph(
        "Samples tau apart, (e^(A tau), C): least singular value of their "
        "observability matrix, " +
        std::string(unseen_modes(mode.A, mode.C).empty() ? "" : "on the states that y shows, ") +
        "over " + c.times() + ": " + brief(least) + ", at tau = " + seconds(where) + ".");
  }
  if (all.empty()) {
    c.out.paragraph(beat == 0.0 ? "There are no pathological intervals: no two eigenvalues of A "
                                  "differ in their imaginary part only."
                                : "There are no pathological intervals: samples at any constant "
                                  "interval show all that the flow shows.");
    return;
  }
  if (within.empty()) {
    c.out.paragraph(
        "Pathological intervals, at which samples show less than the flow: the first "
        "is tau = " +
        seconds(all.front().tau) + (c.has_times() ? "; none in " + c.times() : "") + ".");
    return;
  }
  c.out.paragraph("Pathological intervals in " + c.times() + ", at which samples show less than " +
                  "the flow:");
  constexpr std::size_t kShown = 8;
  for (std::size_t i = 0; i < std::min(kShown, within.size()); ++i) {
    c.out.bullet("tau = " + seconds(within[i].tau) + ": nothing is seen of a combination of " +
                 states_moved(within[i].directions, c.plant.state_names) + ", which " +
                 (within[i].decays ? "decays" : "does not decay"));
  }
  if (within.size() > kShown) {
    c.out.bullet("and " + std::to_string(within.size() - kShown) + " more");
  }
  const auto fatal = std::find_if(within.begin(), within.end(),
                                  [](const PathologicalInterval& one) { return !one.decays; });
  if (fatal == within.end() || !c.only_flows() || mode.C_c.rows() > 0) return;
  c.obstacles.push_back({"not detectable at tau = " + seconds(fatal->tau),
                         "samples that come exactly every " + seconds(fatal->tau) + ", which " +
                             c.times() + " allows, don't show something that does not decay",
                         "choose [T1, T2] without " + seconds(fatal->tau) +
                             " (such as T2 below the first "
                             "pathological interval, " +
                             seconds(all.front().tau) + "), or sample another output as well"});
}

}  // namespace

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

void say_modes(ExplanationContext& c, const std::string& heading, const Eigen::MatrixXd& A,
               TimeDomain domain) {
  c.out.heading(heading);
  const std::vector<std::size_t> widths = {26, 26};
  c.out.row({"eigenvalue", "moves", "by itself"}, widths);
  for (const Mode& mode : modes_of(A)) {
    const Eigen::Index once = mode.eigenvalue.imag() == 0.0 ? 1 : 2;
    const Eigen::Index times = mode.directions.cols() / once;
    c.out.row({brief(mode.eigenvalue) + (times > 1 ? ", " + std::to_string(times) + " times" : ""),
               c.moved(mode), fate(mode, domain)},
              widths);
  }
}

bool say_unseen(ExplanationContext& c, const std::vector<Mode>& unseen, TimeDomain domain) {
  bool all_decay = true;
  for (const Mode& mode : unseen) {
    c.out.bullet("unseen: the mode " + brief(mode.eigenvalue) + ", which moves " + c.moved(mode) +
                 "; it " + fate(mode, domain));
    all_decay = all_decay && mode.decays(domain);
  }
  return all_decay;
}

void say_sampled_output(ExplanationContext& c, const ModeMatrices& mode) {
  c.out.heading("SAMPLED OUTPUT y = C x" + c.mode_name);
  const std::vector<Mode> unseen = unseen_modes(mode.A, mode.C);
  if (unseen.empty()) {
    c.out.paragraph("(A, C) is observable, of order " +
                    std::to_string(*observability_order(mode.A, mode.C)) +
                    ": so many values, y and its derivatives, determine the state.");
  } else {
    const bool detectable = is_detectable(mode.A, mode.C, TimeDomain::kContinuous);
    c.out.paragraph(std::string("(A, C) is not observable") +
                    (detectable ? ", but detectable: what y does not show decays by itself."
                                : ", and not detectable."));
    if (!say_unseen(c, unseen, TimeDomain::kContinuous) && c.only_flows() && mode.C_c.rows() == 0) {
      c.obstacles.push_back(
          {"not detectable",
           "the sampled output never shows a mode of the flow that does not decay" + c.mode_name,
           "measure something that the unseen modes move"});
    }
  }
  if (c.has_several_sensors()) {
    say_sampled_sensors(c, mode);
  } else {
    say_samples(c, mode);
  }
}

void say_continuous_output(ExplanationContext& c, const ModeMatrices& mode) {
  c.out.heading("CONTINUOUS OUTPUT y_c = C_c x" + c.mode_name);
  const std::vector<Mode> unseen = unseen_modes(mode.A, mode.C_c);
  if (unseen.empty()) {
    c.out.paragraph("The flow is strongly differentially observable of order " +
                    std::to_string(*observability_order(mode.A, mode.C_c)) +
                    (c.plant.is_linear() ? "" : ", in its linear part") +
                    ": a high-gain observer can forget as fast as wanted.");
    return;
  }
  c.out.paragraph(
      "The flow is not strongly differentially observable of any order: high-gain "
      "observers don't apply.");
  if (say_unseen(c, unseen, TimeDomain::kContinuous)) {
    c.out.paragraph(
        "It is detectable: a flow-based observer is possible, no faster than what is "
        "unseen.");
  } else {
    c.out.paragraph("It is not detectable: no flow-based observer.");
  }
}

}  // namespace sampled_data_observers
