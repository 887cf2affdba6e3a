#include "observer/switched_observer.h"

#include <algorithm>
#include <utility>

#include "sampled_data_observers/linear_algebra/ordered_product.h"

namespace sampled_data_observers {
namespace {

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

}  // namespace

SwitchedObserver::SwitchedObserver(const ObserverContext& context, SwitchedGains gains)
    : PlantObserver(context, {SensorTiming::kContinuous, SensorTiming::kAtJumps}),
      gains_(std::move(gains)),
      metric_gains_(make_metric_gains(gains_, plant())) {
  projections_ = make_projections(gains_, plant());
  build_flow();
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
    if (!gains_.metrics.empty()) all.add("metric/" + label, gains_.metrics[mode]);
    if (!gains_.P.empty() && gains_.P[mode]) all.add("projection/" + label, *gains_.P[mode]);
  }
  return all;
}

bool SwitchedObserver::flow_is_affine() const {
  return gains_.L_c.empty() || !plant().has_angles(SensorTiming::kContinuous);
}

void SwitchedObserver::derivative(const Held& held, const double* s, double* ds,
                                  double* workspace) const {
  PlantObserver::derivative(held, s, ds, workspace);
  if (!gains_.L_c.empty()) add_innovations(gains_.L_c[held.mode], held, s, ds, workspace);
}

void SwitchedObserver::jump(const Held& held, std::size_t, const JumpOutputs& outputs,
                            double* state, double* workspace) const {
  double* correction = correction_.of(workspace);
  project(held, outputs, state, workspace);
  compute_correction(held, outputs, state, correction, workspace);
  apply_plant_jump(held, state, workspace);
  for (Eigen::Index i = 0; i < n(); ++i) state[i] += correction[i];
}

void SwitchedObserver::compute_correction(const Held& held, const JumpOutputs& outputs,
                                          const double* state, double* correction,
                                          double* workspace) const {
  std::fill_n(correction, n(), 0.0);
  if (!metric_gains_.empty()) {
    return correct_by_metric(held, outputs, state, correction, workspace);
  }
  if (gains_.L_d.empty()) return;
  double* innovation = innovation_.of(workspace);
  double* L_d = L_d_.of(workspace);
  const double tau = since_jump(state) * 1e-9;
  for (const std::size_t i : sensors_of(SensorTiming::kAtJumps)) {
    const double* y_d = outputs.of(i);
    if (y_d == nullptr) continue;
    const Eigen::Index m = plant().sensors()[i].outputs();
    compute_innovation(plant(), held.mode, i, y_d, state, held.u, innovation);
    gains_.L_d[held.mode][i]->evaluate(&tau, nullptr, L_d);
    for (Eigen::Index row = 0; row < n(); ++row) {
      for (Eigen::Index col = 0; col < m; ++col) {
        correction[row] += L_d[row * m + col] * innovation[col];
      }
    }
  }
}

Eigen::Index SwitchedObserver::metric_workspace() const {
  Eigen::Index largest = 0;
  for (const MetricGain& gain : metric_gains_) largest = std::max(largest, gain.workspace_size());
  return largest;
}

void SwitchedObserver::correct_by_metric(const Held& held, const JumpOutputs& outputs,
                                         const double* state, double* correction,
                                         double* workspace) const {
  if (!all_known(outputs)) return;
  double* innovations = innovations_.of(workspace);
  for (const std::size_t i : sensors_of(SensorTiming::kAtJumps)) {
    compute_innovation(plant(), held.mode, i, outputs.of(i), state, held.u,
                       innovations + output_offset(i));
  }
  double* L_d = metric_L_d_.of(workspace);
  metric_gains_[held.mode].evaluate(static_cast<Duration>(since_jump(state)), L_d,
                                    metric_workspace_.of(workspace));
  add_product(L_d, n(), plant().outputs(SensorTiming::kAtJumps), innovations, correction);
}

bool SwitchedObserver::all_known(const JumpOutputs& outputs) const {
  const std::vector<std::size_t>& sensors = sensors_of(SensorTiming::kAtJumps);
  return std::all_of(sensors.begin(), sensors.end(),
                     [&](std::size_t i) { return outputs.of(i) != nullptr; });
}

void SwitchedObserver::project(const Held& held, const JumpOutputs& outputs, double* state,
                               double* workspace) const {
  if (projections_.empty()) return;
  const Projection& projection = projections_[held.mode];
  const bool at_jumps = projection.at_jumps.size() > 0;
  // Never on y_c in place of y_d, which is another projection.
  if (at_jumps ? !all_known(outputs) : projection.continuous.size() == 0 || held.y_c == nullptr) {
    return;
  }
  double* innovations = innovations_.of(workspace);
  for (const std::size_t i :
       sensors_of(at_jumps ? SensorTiming::kAtJumps : SensorTiming::kContinuous)) {
    const Eigen::Index first = output_offset(i);
    const double* y = at_jumps ? outputs.of(i) : held.y_c + first;
    compute_innovation(plant(), held.mode, i, y, state, held.u, innovations + first);
  }
  add_product(at_jumps ? projection.at_jumps : projection.continuous, innovations, state);
}

}  // namespace sampled_data_observers
