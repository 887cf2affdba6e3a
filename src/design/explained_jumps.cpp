#include <algorithm>
#include <cmath>
#include <limits>

#include "design/explanation_parts.h"

namespace sampled_data_observers {
namespace {

/// Times between events, of T1 to T2, at which pairs are looked at.
constexpr int kJumpTimes = 101;

double spectral_abscissa(const Eigen::MatrixXd& A) { return modes_of(A).front().eigenvalue.real(); }

double spectral_radius(const Eigen::MatrixXd& A) {
  double radius = 0.0;
  for (const Mode& mode : modes_of(A)) radius = std::max(radius, std::abs(mode.eigenvalue));
  return radius;
}

}  // namespace

void say_output_at_jumps(ExplanationContext& c, const ModeMatrices& mode) {
  c.out.heading("OUTPUT AT JUMPS y_d = C_d x" + c.mode_name);
  const std::vector<Mode> unseen = unseen_modes(*mode.A_d, mode.C_d);
  if (unseen.empty()) {
    c.out.paragraph("Jumps alone, (A_d, C_d): observable.");
  } else {
    c.out.paragraph("Jumps alone, (A_d, C_d): not observable.");
    say_unseen(c, unseen, TimeDomain::kDiscrete);
  }
  if (!c.has_times()) return;
  std::vector<double> undetectable;
  double least = std::numeric_limits<double>::infinity();
  double where = c.subject.T1;
  for (int i = 0; i < kJumpTimes; ++i) {
    const double tau = c.subject.T1 + (c.longest() - c.subject.T1) * i / (kJumpTimes - 1);
    const DiscretePair pair = pair_at_jumps(mode.A, *mode.A_d, mode.C_d, tau);
    if (!is_detectable(pair.F, pair.H, TimeDomain::kDiscrete)) undetectable.push_back(tau);
    const double margin = detectability_margin(pair.F, pair.H, TimeDomain::kDiscrete);
    if (margin < least) {
      least = margin;
      where = tau;
    }
  }
  if (undetectable.empty()) {
    c.out.paragraph("Flow and jumps together, (A_d e^(A tau), C_d e^(A tau)): detectable at all " +
                    std::to_string(kJumpTimes) + " values of tau looked at in " + c.times() +
                    (std::isfinite(least)
                         ? "; least margin " + brief(least) + ", at tau = " + seconds(where) + "."
                         : ", where everything decays by itself."));
    return;
  }
  c.out.paragraph("Flow and jumps together, (A_d e^(A tau), C_d e^(A tau)): NOT detectable at " +
                  std::to_string(undetectable.size()) + " of " + std::to_string(kJumpTimes) +
                  " values of tau looked at in " + c.times() +
                  ", such as tau = " + seconds(undetectable.front()) + ":");
  const DiscretePair pair = pair_at_jumps(mode.A, *mode.A_d, mode.C_d, undetectable.front());
  say_unseen(c, unseen_modes(pair.F, pair.H), TimeDomain::kDiscrete);
  if (mode.C_c.rows() > 0 || mode.C.rows() > 0 || c.plant.modes.size() > 1) return;
  c.obstacles.push_back({"not detectable at tau = " + seconds(undetectable.front()),
                         "jumps that come exactly every " + seconds(undetectable.front()) +
                             " don't show something that does not decay",
                         "measure more at jumps, or add a continuous output"});
}

void say_dwell_times(ExplanationContext& c, const ModeMatrices& mode) {
  c.out.heading("TIMES BETWEEN JUMPS" + c.mode_name);
  const double at_jump = spectral_radius(*mode.A_d);
  const double in_flow = spectral_abscissa(mode.A);
  if (mode.C_c.rows() > 0) {
    const bool has_shortest = c.has_times() && c.subject.T1 > 0.0;
    const double needed = has_shortest && at_jump > 1.0 ? std::log(at_jump) / c.subject.T1 : 0.0;
    c.out.paragraph(
        "Flow-based (gain on y_c, jumps copied): the error must shrink in flow by more than it "
        "grows at a jump, bernard2022 (C1). Jumps multiply it by " +
        brief(at_jump) + " or more in the long run" +
        (at_jump <= 1.0 ? ", so that any rate of decay in flow may do."
         : has_shortest ? ": at jumps T1 apart, that takes a rate of decay of more than " +
                              brief(needed) + " 1/s."
                        : "; there must be a shortest time T1, or an average dwell time."));
    const std::vector<Mode> unseen = unseen_modes(mode.A, mode.C_c);
    if (!unseen.empty() && has_shortest && -unseen.front().eigenvalue.real() <= needed) {
      c.out.bullet("what y_c does not show decays at " + brief(-unseen.front().eigenvalue.real()) +
                   " 1/s only: (22) can't hold; a longer T1 or another output is needed");
    }
  }
  if (mode.C_d.rows() > 0) {
    const double grown = c.has_longest() ? std::exp(in_flow * c.longest()) : 0.0;
    c.out.paragraph(
        "Jump-based (gain on y_d, flow copied): the error must shrink at a jump by more than it "
        "grows in flow, bernard2022 (C2)" +
        (c.has_longest() && in_flow > 0.0
             ? ". Flow multiplies it by about " + brief(grown) + " in T2."
         : in_flow > 0.0 ? "; there must be a longest time T2."
                         : ". Flow does not multiply it exponentially."));
    double unseen_factor = 0.0;
    for (const Mode& unseen : unseen_modes(*mode.A_d, mode.C_d)) {
      unseen_factor = std::max(unseen_factor, std::abs(unseen.eigenvalue));
    }
    if (unseen_factor * std::exp(in_flow * c.longest()) >= 1.0) {
      c.out.bullet("what y_d does not show of the jumps is multiplied by " + brief(unseen_factor) +
                   " at each: (26), which takes flow and jumps one by one, can't hold; (32) and "
                   "(36), which take them together, may");
    }
  }
  if (mode.C_c.rows() == 0 && mode.C_d.rows() == 0) {
    c.out.paragraph(
        "Nothing is measured continuously or at jumps: methods for jumping plants "
        "have nothing to correct the estimate with.");
  }
}

}  // namespace sampled_data_observers
