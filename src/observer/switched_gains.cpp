#include "observer/switched_gains.h"

#include <optional>
#include <stdexcept>
#include <string>

#include "linear_algebra/definite_matrix.h"
#include "linear_algebra/matrix_functions.h"
#include "observer/gain_requirement.h"
#include "sampled_data_observers/observer/gain_check.h"

namespace sampled_data_observers {
namespace {

bool is_identity(const VectorMap& map) {
  const AffineMap& affine = *map.affine();
  return affine.M().isIdentity(0.0) && affine.N().isZero(0.0) && affine.c().isZero(0.0);
}

Projection make_projection(const SwitchedGains& gains, const Plant& plant, std::size_t mode) {
  if (!gains.P[mode]) return {};
  const Eigen::MatrixXd& P = *gains.P[mode];
  const PlantMode& of_plant = plant.modes()[mode];
  const std::string where = " of mode " + std::to_string(of_plant.label);
  require_of_gains(P.rows() == plant.states() && P.cols() == plant.states() && P.allFinite(),
                   "projection" + where + ": one row and one column per state");
  require_of_gains((P - P.transpose()).norm() <= 1e-9 * P.norm() && cholesky_root(P).allFinite(),
                   "projection" + where + ": the metric must be symmetric and positive definite");
  require_of_gains(!of_plant.jump || is_identity(*of_plant.jump),
                   "projection" + where + ": its jump map must be the identity");
  return {projection_gain(P, plant.stacked_outputs(mode, SensorTiming::kAtJumps), where),
          projection_gain(P, plant.stacked_outputs(mode, SensorTiming::kContinuous), where)};
}

}  // namespace

Eigen::MatrixXd projection_gain(const Eigen::MatrixXd& P, const Eigen::MatrixXd& H,
                                const std::string& where) {
  if (H.rows() == 0) return {};
  const Eigen::MatrixXd lifted = solve_definite(P, H.transpose());
  const std::optional<Eigen::MatrixXd> gram_inverse = inverse_where_regular(H * lifted);
  require_of_gains(gram_inverse.has_value(),
                   "projection" + where + ": the outputs of the mode are dependent");
  return lifted * *gram_inverse;
}

void check_switched_gains(const SwitchedGains& gains, const Plant& plant) {
  require_of_gains(plant.switches(), "the plant must have several modes (plant/modes)");
  require_of_gains(plant.is_affine(), "all modes of the plant must be affine");
  const std::size_t modes = plant.modes().size();
  const bool corrects_jumps = !gains.L_d.empty() || !gains.metrics.empty();
  const auto fits = [modes](std::size_t size) { return size == 0 || size == modes; };
  require_of_gains(fits(gains.L_c.size()) && fits(gains.L_d.size()) && fits(gains.P.size()) &&
                       fits(gains.metrics.size()),
                   "one gain per mode of the plant");
  require_of_gains(!gains.L_c.empty() || corrects_jumps || !gains.P.empty(),
                   "at least one of L_c, L_d, metric and projection");
  require_of_gains(gains.L_d.empty() || gains.metrics.empty(),
                   "one of L_d and metric, which stands for an L_d");
  const bool continuous = plant.outputs(SensorTiming::kContinuous) > 0;
  const bool at_jumps = plant.outputs(SensorTiming::kAtJumps) > 0;
  require_of_gains(gains.L_c.empty() || continuous,
                   "L_c needs a sensor that is measured continuously");
  require_of_gains(gains.L_d.empty() || at_jumps, "L_d needs a sensor that is measured at jumps");
  require_of_gains(gains.metrics.empty() || at_jumps,
                   "metric needs a sensor that is measured at jumps");
  require_of_gains(!continuous || !gains.L_c.empty() || !gains.P.empty(),
                   "sensors that are measured continuously need L_c or projection");
  require_of_gains(!at_jumps || corrects_jumps || !gains.P.empty(),
                   "sensors that are measured at jumps need L_d, metric or projection");
  for (const std::vector<Eigen::MatrixXd>& L_c : gains.L_c) {
    check_gains("L_c", L_c, plant, SensorTiming::kContinuous);
  }
  for (const std::vector<std::shared_ptr<const VectorMap>>& L_d : gains.L_d) {
    require_of_gains(L_d.size() == plant.sensors().size(), "L_d: one gain per sensor");
    for (std::size_t i = 0; i < plant.sensors().size(); ++i) {
      const Sensor& sensor = plant.sensors()[i];
      if (sensor.timing != SensorTiming::kAtJumps) continue;
      require_of_gains(
          L_d[i] && L_d[i]->size() == plant.states() * sensor.outputs(),
          "L_d of sensor '" + sensor.name + "': one row per state, one column per output");
    }
  }
}

std::vector<MetricGain> make_metric_gains(SwitchedGains& gains, const Plant& plant) {
  check_switched_gains(gains, plant);
  std::vector<MetricGain> all;
  const Eigen::Index n = plant.states();
  for (std::size_t mode = 0; mode < gains.metrics.size(); ++mode) {
    const PlantMode& of_plant = plant.modes()[mode];
    const std::string where = " of mode " + std::to_string(of_plant.label);
    gains.metrics[mode] = checked_positive_definite("metric" + where, gains.metrics[mode], n);
    const Eigen::MatrixXd A_d = of_plant.jump ? of_plant.jump->affine()->M()
                                              : Eigen::MatrixXd(Eigen::MatrixXd::Identity(n, n));
    try {
      all.emplace_back(of_plant.flow->affine()->M(), A_d,
                       plant.stacked_outputs(mode, SensorTiming::kAtJumps), gains.metrics[mode]);
    } catch (const std::invalid_argument& fault) {
      throw std::invalid_argument("metric" + where + ": " + fault.what());
    }
  }
  return all;
}

std::vector<Projection> make_projections(const SwitchedGains& gains, const Plant& plant) {
  std::vector<Projection> projections;
  for (std::size_t mode = 0; mode < gains.P.size(); ++mode) {
    projections.push_back(make_projection(gains, plant, mode));
  }
  return projections;
}

}  // namespace sampled_data_observers
