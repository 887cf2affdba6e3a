#include "design/explained_trajectory.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>

#include "design/linearized_trajectory.h"
#include "design/paragraphs.h"
#include "linear_algebra/matrix_functions.h"
#include "plant/differentiation.h"

namespace sampled_data_observers {
namespace {

/// Of the largest singular value: what may be rounding.
constexpr double kRounding = 1e-12;
constexpr std::size_t kStretchesWithoutJumps = 10;

std::string at(double t) { return " at t = " + brief(t) + " s"; }

/// Steps [first, end)
struct Stretch {
  std::size_t first = 0;
  std::size_t end = 0;
};

class TrajectoryExplanation {
 public:
  TrajectoryExplanation(const Plant& plant, const std::vector<TrajectoryStep>& steps)
      : plant_(plant), steps_(steps), linear_(linearize(plant, steps)) {}

  std::string text(const TrajectoryCoordinates* coordinates) {
    say_trajectory();
    say_flow();
    say_between_jumps();
    if (!intervals_.empty()) say_over_jumps();
    if (coordinates != nullptr) say_coordinates(*coordinates);
    return out_.text();
  }

 private:
  void say_trajectory() {
    std::size_t first = 0;
    double shortest = std::numeric_limits<double>::infinity();
    double longest = 0.0;
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      if (!steps_[k].jumps) continue;
      intervals_.push_back({first, k + 1});
      first = k + 1;
    }
    for (std::size_t i = 1; i < intervals_.size(); ++i) {
      const double length = end_of(intervals_[i]) - steps_[intervals_[i].first].t;
      shortest = std::min(shortest, length);
      longest = std::max(longest, length);
    }
    out_.heading("TRAJECTORY");
    out_.paragraph("of " + brief(end_of({0, steps_.size()}) - steps_.front().t) + " s, with " +
                   std::to_string(intervals_.size()) + " jumps" +
                   (intervals_.size() > 1
                        ? ", " + brief(shortest) + " to " + brief(longest) + " s apart"
                        : ""));
    out_.paragraph(
        "What follows is about the linearization along it: estimates, and about this trajectory "
        "alone. States count in units of their largest values on it, and so do outputs.");
  }

  void say_flow() {
    out_.heading("FLOW");
    double growth = -std::numeric_limits<double>::infinity();
    double decay = std::numeric_limits<double>::infinity();
    double fastest = 0.0;
    double t_growth = 0.0;
    double t_fastest = 0.0;
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      if (!linear_[k].A.allFinite()) continue;
      const Eigen::VectorXcd eigenvalues = eigenvalues_of(linear_[k].A);
      const double largest = eigenvalues.real().maxCoeff();
      if (largest > growth) t_growth = steps_[k].t;
      growth = std::max(growth, largest);
      decay = std::min(decay, largest);
      if (eigenvalues.cwiseAbs().maxCoeff() > fastest) t_fastest = steps_[k].t;
      fastest = std::max(fastest, eigenvalues.cwiseAbs().maxCoeff());
    }
    out_.bullet("the largest real part of the eigenvalues of its Jacobian lies between " +
                brief(decay) + " and " + brief(growth) + " 1/s, which it has" + at(t_growth));
    out_.bullet("the fastest has the modulus " + brief(fastest) + " 1/s" + at(t_fastest) +
                ": plant/integration/step should be well below " + brief(1.0 / fastest) + " s");
  }

  /// Where flow alone must show the state: from each jump to the next.
  void say_between_jumps() {
    out_.heading("WHAT OUTPUTS SHOW BETWEEN JUMPS");
    if (plant_.outputs(SensorTiming::kContinuous) + plant_.outputs(SensorTiming::kSampled) == 0) {
      out_.bullet("there are none");
      return;
    }
    std::vector<Stretch> stretches = intervals_;
    if (stretches.empty()) {
      for (std::size_t i = 0; i < kStretchesWithoutJumps; ++i) {
        stretches.push_back({steps_.size() * i / kStretchesWithoutJumps,
                             steps_.size() * (i + 1) / kStretchesWithoutJumps});
      }
    }
    say_worst(stretches, false);
  }

  void say_over_jumps() {
    out_.heading("WHAT OUTPUTS SHOW OVER JUMPS, those at the jumps included");
    const auto n = static_cast<std::size_t>(plant_.states());
    for (std::size_t jumps = 1; jumps <= std::min(n + 1, intervals_.size()); ++jumps) {
      std::vector<Stretch> stretches;
      for (std::size_t i = 0; i + jumps <= intervals_.size(); ++i) {
        stretches.push_back({intervals_[i].first, intervals_[i + jumps - 1].end});
      }
      say_worst(stretches, true,
                "over " + std::to_string(jumps) + (jumps == 1 ? " jump" : " jumps"));
    }
  }

  /// The one of them in which the outputs show least.
  void say_worst(const std::vector<Stretch>& stretches, bool with_jumps,
                 const std::string& where = "") {
    std::optional<Visibility> worst;
    double begin = 0.0;
    double end = 0.0;
    std::size_t beyond = 0;
    std::size_t unseen = 0;
    for (const Stretch& stretch : stretches) {
      if (stretch.first >= stretch.end) continue;
      const Visibility here = visibility(steps_, linear_, stretch.first, stretch.end, with_jumps);
      if (!std::isfinite(here.largest)) {
        ++beyond;
        continue;
      }
      if (here.least <= kRounding * here.largest) ++unseen;
      if (worst && here.least >= worst->least) continue;
      worst = here;
      begin = steps_[stretch.first].t;
      end = end_of(stretch);
    }
    const std::string prefix = where.empty() ? "" : where + ": ";
    if (beyond > 0) {
      out_.bullet(prefix + std::to_string(beyond) +
                  " stretches can't be told, in which errors grow beyond all numbers");
    }
    if (!worst) return;
    const std::string moved = states_moved(worst->direction, plant_.state_names());
    const std::string when = "from " + brief(begin) + " to " + brief(end) + " s";
    if (worst->least <= kRounding * worst->largest) {
      out_.bullet(prefix + "NOT ALL in " + std::to_string(unseen) + " of " +
                  std::to_string(stretches.size()) + " stretches: " + when +
                  " nothing (that could be told from rounding) of a direction which moves " +
                  moved);
      return;
    }
    out_.bullet(prefix + "all of the state. Least, " + when + ", what moves " + moved +
                ": an error of the size of the state changes the outputs by " +
                brief(worst->least) + " of theirs");
  }

  void say_coordinates(const TrajectoryCoordinates& coordinates) {
    out_.heading("JACOBIAN OF THE COORDINATES T OF THE GAINS");
    double least = std::numeric_limits<double>::infinity();
    double t_least = 0.0;
    std::vector<double> relative;
    std::vector<double> changes;
    double last_sign = 0.0;
    std::size_t last_mode = steps_.front().mode;
    for (const TrajectoryStep& step : steps_) {
      const VectorMap& T = *coordinates.T[step.mode];
      const Eigen::Index n = plant_.states();
      Eigen::MatrixXd J(T.size(), n);
      Eigen::VectorXd workspace(n + 2 * T.size());
      differentiate(T, step.begin.data(), step.u.data(), coordinates.scales, J.data(),
                    workspace.data());
      J = coordinates.powers.asDiagonal() * J;
      J *= coordinates.scales.asDiagonal();
      if (!J.allFinite()) continue;
      relative.push_back(singular_values(J)(std::min(T.size(), n) - 1) /
                         size_of_outputs(J, coordinates.outputs));
      if (relative.back() < least) t_least = step.t;
      least = std::min(least, relative.back());
      if (T.size() != n) continue;
      const double sign = sign_of_determinant(J);
      if (sign * last_sign < 0.0 && step.mode == last_mode) changes.push_back(step.t);
      last_sign = sign;
      last_mode = step.mode;
    }
    if (relative.empty()) {
      out_.bullet("it has no value anywhere on the trajectory");
      return;
    }
    std::nth_element(relative.begin(),
                     relative.begin() + static_cast<std::ptrdiff_t>(relative.size() / 2),
                     relative.end());
    out_.bullet(
        "its least singular value over the size of its first row, in units of the saturations and "
        "of ell: " +
        brief(least) + at(t_least) + ", and " + brief(relative[relative.size() / 2]) +
        " as the median");
    if (!changes.empty()) {
      std::string times;
      for (std::size_t i = 0; i < std::min<std::size_t>(changes.size(), 5); ++i) {
        times += (i == 0 ? "" : ", ") + brief(changes[i]);
      }
      out_.bullet("SINGULAR on the trajectory: its determinant changes its sign " +
                  std::to_string(changes.size()) + " times, first at t = " + times +
                  " s. The state is not told there by these derivatives of the output");
    }
    out_.bullet(
        "for the original form: gains/damping of the size of that median, or a few times it");
  }

  /// |ĵ_1| of a DampedInverse
  static double size_of_outputs(const Eigen::MatrixXd& J,
                                const std::vector<Eigen::Index>& outputs) {
    double sum = 0.0;
    for (const Eigen::Index i : outputs) sum += J.row(i).squaredNorm();
    return std::sqrt(sum / static_cast<double>(outputs.size()));
  }

  static double sign_of_determinant(const Eigen::MatrixXd& J) {
    double negative = 1.0;
    // The product of the eigenvalues: complex ones come in pairs, whose product is positive.
    const Eigen::VectorXcd eigenvalues = eigenvalues_of(J);
    for (Eigen::Index i = 0; i < eigenvalues.size(); ++i) {
      if (eigenvalues(i).imag() == 0.0 && eigenvalues(i).real() < 0.0) negative = -negative;
    }
    return negative;
  }

  double end_of(const Stretch& stretch) const {
    const TrajectoryStep& last = steps_[stretch.end - 1];
    return last.t + last.duration;
  }

  const Plant& plant_;
  const std::vector<TrajectoryStep>& steps_;
  const std::vector<LinearizedStep> linear_;
  /// From each jump, or the start, up to the next jump.
  std::vector<Stretch> intervals_;
  Paragraphs out_;
};

}  // namespace

std::string explain_trajectory(const Plant& plant, const std::vector<TrajectoryStep>& steps,
                               const TrajectoryCoordinates* coordinates) {
  return TrajectoryExplanation(plant, steps).text(coordinates);
}

}  // namespace sampled_data_observers
