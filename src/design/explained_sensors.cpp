// What each of several sampled sensors shows, and what they show together at their own times.
#include <limits>

#include "design/explanation_parts.h"
#include "design/pathological_times.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

Eigen::MatrixXd rows_of(const ModeMatrices& mode, const SampledOutputs& sensor) {
  return mode.C.middleRows(sensor.first, sensor.rows);
}

Eigen::MatrixXd rows_of_others(const ModeMatrices& mode, const SampledOutputs& sensor) {
  Eigen::MatrixXd C(mode.C.rows() - sensor.rows, mode.C.cols());
  C << mode.C.topRows(sensor.first), mode.C.bottomRows(mode.C.rows() - sensor.first - sensor.rows);
  return C;
}

/// The states that have a part in what an output shows.
std::string states_shown(const ExplanationContext& c, const std::vector<Mode>& unseen) {
  const Eigen::Index n = c.plant.states();
  Eigen::MatrixXd hidden(n, 0);
  for (const Mode& mode : unseen) {
    const Eigen::Index before = hidden.cols();
    hidden.conservativeResize(Eigen::NoChange, before + mode.directions.cols());
    hidden.rightCols(mode.directions.cols()) = mode.directions;
  }
  if (hidden.cols() == 0) return "all states";
  if (hidden.cols() == n) return "nothing";
  return states_moved(weakest_directions(hidden.transpose(), n - hidden.cols()),
                      c.plant.state_names);
}

/// The states that the unseen modes move.
std::string states_hidden(const ExplanationContext& c, const std::vector<Mode>& unseen) {
  std::string text;
  for (const Mode& mode : unseen) {
    text += (text.empty() ? "" : "; ") + ("the mode " + brief(mode.eigenvalue)) + ", which moves " +
            c.moved(mode);
  }
  return text;
}

void say_each(ExplanationContext& c, const ModeMatrices& mode) {
  for (const SampledOutputs& sensor : c.plant.sampled) {
    const Eigen::MatrixXd C = rows_of(mode, sensor);
    const std::vector<Mode> unseen = unseen_modes(mode.A, C);
    std::string text = sensor.sensor + " alone shows " + states_shown(c, unseen);
    if (!unseen.empty()) {
      text += is_detectable(mode.A, C, TimeDomain::kContinuous)
                  ? "; what it does not show decays"
                  : "; it leaves unseen " + states_hidden(c, unseen);
    }
    const std::vector<Mode> without = unseen_modes(mode.A, rows_of_others(mode, sensor));
    const std::vector<Mode> anyway = unseen_modes(mode.A, mode.C);
    text += without.size() == anyway.size()
                ? ". The others show as much without it."
                : ". Without it, the others leave unseen " + states_hidden(c, without) + ".";
    c.out.bullet(text);
  }
}

std::string in_words(const ExplanationContext& c, const PathologicalTimes& times) {
  std::string text;
  for (std::size_t i = 0; i < times.tau.size(); ++i) {
    if (!times.tau[i]) continue;
    text += (text.empty() ? "" : " and ") + c.plant.sampled[i].sensor + " every " +
            seconds(*times.tau[i]);
  }
  return text;
}

std::vector<SampledSensor> sensors_of(const ExplanationContext& c, const ModeMatrices& mode) {
  std::vector<SampledSensor> sensors;
  for (std::size_t i = 0; i < c.plant.sampled.size(); ++i) {
    const SamplingTimes any{0.0, std::numeric_limits<double>::infinity()};
    sensors.push_back({rows_of(mode, c.plant.sampled[i]),
                       c.has_times_of_sensors() ? c.subject.sensor_times[i] : any});
  }
  return sensors;
}

void say_together(ExplanationContext& c, const ModeMatrices& mode) {
  const std::vector<PathologicalTimes> all =
      pathological_times_of_sensors(mode.A, sensors_of(c, mode));
  const std::string where = c.has_times_of_sensors() ? "inside of their times" : "at all";
  if (longest_beat(mode.A) == 0.0) {
    c.out.paragraph(
        "There are no pathological intervals: no two eigenvalues of A differ in their imaginary "
        "part only.");
    return;
  }
  if (all.empty()) {
    c.out.paragraph("There are no pathological intervals " + where +
                    ": sampled each at any constant interval, the sensors together tell all "
                    "modes with simple eigenvalues apart that the flow lets them tell apart.");
    return;
  }
  c.out.paragraph("Pathological intervals " + where +
                  ", at which the sensors, each begun at the worst time, together show less than "
                  "the flow:");
  for (const PathologicalTimes& times : all) {
    const std::string of = states_moved(times.directions, c.plant.state_names);
    c.out.bullet(in_words(c, times) + ": nothing is seen of a combination of " + of + ", which " +
                 (times.decays ? "decays" : "does not decay"));
    if (times.decays || !c.has_times_of_sensors() || !c.only_flows() || mode.C_c.rows() > 0)
      continue;
    c.obstacles.push_back(
        {"not detectable with " + in_words(c, times),
         "samples of " + in_words(c, times) +
             ", which their times allow, don't show something that does not decay",
         "choose times of one of these sensors without such intervals, or sample another output "
         "as well"});
  }
}

}  // namespace

void say_sampled_sensors(ExplanationContext& c, const ModeMatrices& mode) {
  say_each(c, mode);
  say_together(c, mode);
}

std::string times_of_sensors(const ExplanationContext& c) {
  std::string text;
  for (std::size_t i = 0; i < c.subject.sensor_times.size(); ++i) {
    const SamplingTimes& times = c.subject.sensor_times[i];
    text += (text.empty() ? "" : ", ") + c.plant.sampled[i].sensor + " in [T1, T2] = [" +
            brief(times.T1) + ", " + brief(times.T2) + "] s";
  }
  return text;
}

}  // namespace sampled_data_observers
