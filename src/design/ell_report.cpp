#include <cmath>
#include <string>

#include "design/ell_check.h"
#include "design/paragraphs.h"

namespace sampled_data_observers {
namespace {

/// From this relative error on, a derivative is taken for wrong.
constexpr double kWrong = 1e-3;

std::string named(const Eigen::VectorXd& x, const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += (i == 0 ? "" : ", ") + names[i] + " = " + brief(x(static_cast<Eigen::Index>(i)));
  }
  return text;
}

std::string at_bounds(const Eigen::VectorXd& x, const HighGainObserver& law) {
  std::string states;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const auto bounds = law.saturation().bounds(i);
    if (!bounds || ((*bounds)(0) < x(i) && x(i) < (*bounds)(1))) continue;
    states += (states.empty() ? "" : ", ") + law.plant().state_names()[static_cast<std::size_t>(i)];
  }
  return states;
}

void say_formulas(Paragraphs& out, const EllCheck& check) {
  const Eigen::Index d = check.slopes.size();
  bool is_right = true;
  for (Eigen::Index i = 0; i <= d; ++i) {
    if (check.derivative_errors(i) < kWrong) continue;
    is_right = false;
    const std::string of = i == d   ? "Phi is not the derivative of T_" + std::to_string(d)
                           : i == 0 ? "T_1 is not the output"
                                    : "T_" + std::to_string(i + 1) +
                                          " is not the derivative of T_" + std::to_string(i);
    out.bullet(of + (i == 0 ? "" : " along the flow") + ": off by " +
               brief(check.derivative_errors(i)) + " of its largest value");
  }
  if (is_right) {
    out.bullet("T_1 is the output, each T_i+1 the derivative of T_i, and Phi that of T_" +
               std::to_string(d));
  }
  if (check.regular < check.points) {
    out.bullet(
        "at " + std::to_string(check.points - check.regular) + " of " +
        std::to_string(check.points) +
        " points Theta(T(x)) leads out of the box, or elsewhere: they are left out. The plant "
        "must not come near such states in this mode");
  }
}

void say_jumps(Paragraphs& out, const EllCheck& check) {
  const std::string times = brief(*check.dwell_time) + " s between jumps, or so much on average";
  if (!std::isfinite(check.ell_for_jumps)) {
    out.bullet("no ell of corollary 4.1 for " + times +
               ": the jump map is too steep, or a slope "
               "has no value");
    return;
  }
  out.bullet("ell of corollary 4.1 for " + times +
             ", with these slopes and those of the jump map: " + brief(check.ell_for_jumps) +
             (check.ell >= check.ell_for_jumps
                  ? "; ell is above it: what flow takes of the error outweighs what jumps add"
                  : "; ell is below it: that the error falls from jump to jump is not shown"));
  out.bullet("a jump multiplies V = |error|^2 in its norm by up to " + brief(check.jump_growth) +
             " at this ell");
}

void say_second(Paragraphs& out, const TransformedHighGainObserver& law, const EllCheck& check) {
  if (!check.second) {
    out.bullet("no second equilibrium was found" +
               (check.least_ell ? ", from ell = " + brief(*check.least_ell) + " on" : ""));
    return;
  }
  const std::vector<std::string>& names = law.plant().state_names();
  const std::string bounds = at_bounds(check.second->x_hat, law);
  out.bullet("SECOND EQUILIBRIUM at " + std::to_string(check.points_with_second) +
             " points. While the plant is at " + named(check.second->x, names) +
             ", the estimate may stay at " + named(check.second->x_hat, names) +
             (bounds.empty() ? "" : " (at its bounds: " + bounds + ")"));
  out.bullet(
      check.least_ell
          ? "none was found from ell = " + brief(*check.least_ell) + " on; or take narrower bounds"
          : "a larger ell, up to 1000 times this one, does not end that: take narrower bounds");
}

}  // namespace

std::string ell_report(const TransformedHighGainObserver& law,
                       const std::vector<EllCheck>& checks) {
  Paragraphs out;
  out.heading("ELL ON THE BOX OF THE SATURATIONS (bernard2022, example 4.3)");
  out.paragraph(
      "Estimates from trying points of the box, with the input at zero: what lies between them is "
      "not looked at, and nothing here is a proof.");
  for (const EllCheck& check : checks) {
    out.heading("ell = " + brief(check.ell) +
                (law.plant().switches() ? ", mode " + std::to_string(check.mode) : ""));
    if (check.regular == 0) {
      out.bullet("Theta(T(x)) is in none of " + std::to_string(check.points) +
                 " points a state of the box that T tells again: see Theta, T and the saturations");
      continue;
    }
    say_formulas(out, check);
    std::string slopes;
    for (Eigen::Index i = 0; i < check.slopes.size(); ++i) {
      slopes += (i == 0 ? "" : ", ") + brief(check.slopes(i));
    }
    out.bullet("largest slopes of Phi in z1, z2, ... met: " + slopes);
    out.bullet("ell0 for these slopes: " + brief(check.sufficient_ell) +
               (check.ell > check.sufficient_ell
                    ? "; ell is above it, which suffices where the slopes are right"
                    : "; ell is below it: convergence from everywhere in the box is not shown by "
                      "example 4.3, which is far from sharp"));
    if (check.dwell_time) say_jumps(out, check);
    say_second(out, law, check);
  }
  return out.text();
}

}  // namespace sampled_data_observers
