#include "observer/switched_observer.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "sampled_data_observers/linear_algebra/ordered_product.h"
#include "sampled_data_observers/observer/gain_check.h"

namespace sampled_data_observers {
namespace {

void require(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument(what);
}

/// Scratch of the maps: a correction of x̂, innovations of all sensors, the entries of one gain.
Eigen::Index scratch_size(const Plant& plant) {
  return plant.states() + plant.outputs(SensorTiming::kAtJumps) +
         plant.outputs(SensorTiming::kContinuous) + plant.states() * plant.max_outputs();
}

/// The output matrices of all sensors of a timing in a mode, one below the other.
Eigen::MatrixXd stacked_outputs(const Plant& plant, std::size_t mode, SensorTiming timing) {
  Eigen::MatrixXd H(plant.outputs(timing), plant.states());
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < plant.sensors().size(); ++i) {
    const Sensor& sensor = plant.sensors()[i];
    if (sensor.timing != timing) continue;
    H.middleRows(row, sensor.outputs()) = plant.modes()[mode].outputs[i]->affine()->M();
    row += sensor.outputs();
  }
  return H;
}

bool is_identity(const VectorMap& map) {
  const AffineMap& affine = *map.affine();
  return affine.M().isIdentity(0.0) && affine.N().isZero(0.0) && affine.c().isZero(0.0);
}

/// The n x m gain that a map of τ gives row by row; without entries where it depends on τ.
Eigen::MatrixXd constant_gain(const VectorMap& map, Eigen::Index n) {
  const AffineMap* affine = map.affine();
  if (affine == nullptr || !affine->M().isZero(0.0)) return {};
  Eigen::MatrixXd gain(n, affine->c().size() / n);
  for (Eigen::Index i = 0; i < affine->c().size(); ++i) {
    gain(i / gain.cols(), i % gain.cols()) = affine->c()(i);
  }
  return gain;
}

/// P⁻¹ Hᵀ (H P⁻¹ Hᵀ)⁻¹; empty where H has no rows.
Eigen::MatrixXd projection_gain(const Eigen::MatrixXd& P, const Eigen::MatrixXd& H,
                                const std::string& where) {
  if (H.rows() == 0) return {};
  const Eigen::MatrixXd lifted = P.llt().solve(H.transpose());
  const Eigen::FullPivLU<Eigen::MatrixXd> gram(H * lifted);
  require(gram.isInvertible(), "projection" + where + ": the outputs of the mode are dependent");
  return lifted * gram.inverse();
}

}  // namespace

SwitchedObserver::SwitchedObserver(const ObserverContext& context, SwitchedGains gains)
    : PlantObserver(context, {0, 0, 0, scratch_size(*context.plant)},
                    {SensorTiming::kContinuous, SensorTiming::kAtJumps}),
      gains_(std::move(gains)) {
  check();
  for (std::size_t mode = 0; mode < gains_.P.size(); ++mode) {
    projections_.push_back(make_projection(mode));
  }
  build_flow();
}

void SwitchedObserver::check() const {
  require(plant().switches(), "the plant must have several modes (plant/modes)");
  require(plant().is_affine(), "all modes of the plant must be affine");
  const std::size_t modes = plant().modes().size();
  const auto fits = [modes](std::size_t size) { return size == 0 || size == modes; };
  require(fits(gains_.L_c.size()) && fits(gains_.L_d.size()) && fits(gains_.P.size()),
          "one gain per mode of the plant");
  require(!gains_.L_c.empty() || !gains_.L_d.empty() || !gains_.P.empty(),
          "at least one of L_c, L_d and projection");
  const bool continuous = plant().outputs(SensorTiming::kContinuous) > 0;
  const bool at_jumps = plant().outputs(SensorTiming::kAtJumps) > 0;
  require(gains_.L_c.empty() || continuous, "L_c needs a sensor that is measured continuously");
  require(gains_.L_d.empty() || at_jumps, "L_d needs a sensor that is measured at jumps");
  require(!continuous || !gains_.L_c.empty() || !gains_.P.empty(),
          "sensors that are measured continuously need L_c or projection");
  require(!at_jumps || !gains_.L_d.empty() || !gains_.P.empty(),
          "sensors that are measured at jumps need L_d or projection");
  for (const std::vector<Eigen::MatrixXd>& L_c : gains_.L_c) {
    check_gains("L_c", L_c, plant(), SensorTiming::kContinuous);
  }
  for (const std::vector<std::shared_ptr<const VectorMap>>& L_d : gains_.L_d) {
    require(L_d.size() == sensors(), "L_d: one gain per sensor");
    for (std::size_t i = 0; i < sensors(); ++i) {
      const Sensor& sensor = plant().sensors()[i];
      if (sensor.timing != SensorTiming::kAtJumps) continue;
      require(L_d[i] && L_d[i]->size() == n() * sensor.outputs(),
              "L_d of sensor '" + sensor.name + "': one row per state, one column per output");
    }
  }
}

LawGains SwitchedObserver::gains() const {
  LawGains all;
  for (std::size_t mode = 0; mode < plant().modes().size(); ++mode) {
    const std::string label = std::to_string(plant().modes()[mode].label);
    if (!gains_.L_c.empty()) {
      all.add("L_c/" + label, gains_.L_c[mode], plant(), SensorTiming::kContinuous);
    }
    if (!gains_.L_d.empty()) {
      std::vector<Eigen::MatrixXd> L_d;
      for (const auto& map : gains_.L_d[mode]) {
        L_d.push_back(map ? constant_gain(*map, n()) : Eigen::MatrixXd());
      }
      all.add("L_d/" + label, L_d, plant(), SensorTiming::kAtJumps);
    }
    if (!gains_.P.empty() && gains_.P[mode]) all.add("projection/" + label, *gains_.P[mode]);
  }
  return all;
}

SwitchedObserver::Projection SwitchedObserver::make_projection(std::size_t mode) const {
  if (!gains_.P[mode]) return {};
  const Eigen::MatrixXd& P = *gains_.P[mode];
  const PlantMode& of_plant = plant().modes()[mode];
  const std::string where = " of mode " + std::to_string(of_plant.label);
  require(P.rows() == n() && P.cols() == n() && P.allFinite(),
          "projection" + where + ": one row and one column per state");
  require((P - P.transpose()).norm() <= 1e-9 * P.norm() && P.llt().info() == Eigen::Success,
          "projection" + where + ": the metric must be symmetric and positive definite");
  require(!of_plant.jump || is_identity(*of_plant.jump),
          "projection" + where + ": its jump map must be the identity");
  return {projection_gain(P, stacked_outputs(plant(), mode, SensorTiming::kAtJumps), where),
          projection_gain(P, stacked_outputs(plant(), mode, SensorTiming::kContinuous), where)};
}

bool SwitchedObserver::flow_is_affine() const {
  const auto wraps = [this](const Sensor& sensor) {
    return !gains_.L_c.empty() && sensor.timing == SensorTiming::kContinuous &&
           std::count(sensor.angular.begin(), sensor.angular.end(), true) > 0;
  };
  return std::none_of(plant().sensors().begin(), plant().sensors().end(), wraps);
}

void SwitchedObserver::derivative(const Held& held, const double* s, double* ds,
                                  double* workspace) const {
  PlantObserver::derivative(held, s, ds, workspace);
  if (gains_.L_c.empty() || held.y_c == nullptr) return;
  for (std::size_t i = 0; i < sensors(); ++i) {
    if (plant().sensors()[i].timing != SensorTiming::kContinuous) continue;
    compute_innovation(plant(), held.mode, i, held.y_c + continuous_offset(i), s, held.u,
                       workspace);
    add_product(gains_.L_c[held.mode][i], workspace, ds);
  }
}

void SwitchedObserver::jump(const Held& held, std::size_t next, const JumpOutputs& outputs,
                            double* state, double* workspace) const {
  static_cast<void>(next);
  double* correction = workspace + n();  // behind what apply_plant_jump() uses
  double* scratch = correction + n();
  project(held, outputs, state, scratch);
  compute_correction(held, outputs, state, correction, scratch);
  apply_plant_jump(held, state, workspace);
  for (Eigen::Index i = 0; i < n(); ++i) state[i] += correction[i];
}

void SwitchedObserver::compute_correction(const Held& held, const JumpOutputs& outputs,
                                          const double* state, double* correction,
                                          double* scratch) const {
  std::fill_n(correction, n(), 0.0);
  if (gains_.L_d.empty()) return;
  double* innovation = scratch;
  double* gain = innovation + plant().max_outputs();
  const double tau = since_jump(state) * 1e-9;
  for (std::size_t i = 0; i < sensors(); ++i) {
    const Sensor& sensor = plant().sensors()[i];
    if (sensor.timing != SensorTiming::kAtJumps || outputs.known[i] == 0.0) continue;
    const Eigen::Index m = sensor.outputs();
    compute_innovation(plant(), held.mode, i, outputs.y_d + jump_output_offset(i), state, held.u,
                       innovation);
    gains_.L_d[held.mode][i]->evaluate(&tau, nullptr, gain);
    for (Eigen::Index row = 0; row < n(); ++row) {
      for (Eigen::Index col = 0; col < m; ++col) {
        correction[row] += gain[row * m + col] * innovation[col];
      }
    }
  }
}

bool SwitchedObserver::all_known(const JumpOutputs& outputs) const {
  for (std::size_t i = 0; i < sensors(); ++i) {
    const bool measures = plant().sensors()[i].timing == SensorTiming::kAtJumps;
    if (measures && outputs.known[i] == 0.0) return false;
  }
  return true;
}

void SwitchedObserver::project(const Held& held, const JumpOutputs& outputs, double* state,
                               double* scratch) const {
  if (projections_.empty()) return;
  const Projection& projection = projections_[held.mode];
  const bool at_jumps = projection.at_jumps.size() > 0 && all_known(outputs);
  if (!at_jumps && (projection.continuous.size() == 0 || held.y_c == nullptr)) return;
  const SensorTiming timing = at_jumps ? SensorTiming::kAtJumps : SensorTiming::kContinuous;
  const double* y = at_jumps ? outputs.y_d : held.y_c;
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < sensors(); ++i) {
    const Sensor& sensor = plant().sensors()[i];
    if (sensor.timing != timing) continue;
    compute_innovation(plant(), held.mode, i, y + row, state, held.u, scratch + row);
    row += sensor.outputs();
  }
  add_product(at_jumps ? projection.at_jumps : projection.continuous, scratch, state);
}

}  // namespace sampled_data_observers
