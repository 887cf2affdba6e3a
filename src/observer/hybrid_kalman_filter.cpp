#include "observer/hybrid_kalman_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "linear_algebra/definite_matrix.h"
#include "linear_algebra/ordered_linear_algebra.h"

namespace sampled_data_observers {

PlantObserver::Extras HybridKalmanFilter::extras(const Plant& plant) {
  const Eigen::Index n = plant.states();
  Extras result;
  result.constants = n * n;
  const Eigen::Index m = plant.max_outputs();
  // An update takes an innovation and four vectors of n; a flow or a jump n² and, of x̂, n; a
  // distance an innovation, its covariance, and P Cᵀ.
  result.workspace = std::max({m + 4 * n, n * n + n, m + m * m + n * m});
  return result;
}

HybridKalmanFilter::HybridKalmanFilter(const ObserverContext& context,
                                       const KalmanCovariances& covariances)
    : PlantObserver(context, extras(*context.plant),
                    {SensorTiming::kSampled, SensorTiming::kAtJumps}),
      P0_(checked_positive_definite("P0", covariances.P0, n())),
      Q_d_(checked_positive_semidefinite("Q_d", covariances.Q_d, n())) {
  if (!plant().is_affine()) {
    throw std::invalid_argument(
        "this observer takes plants whose flow, jump map and outputs are linear, up to constants");
  }
  const std::vector<Sensor>& all = plant().sensors();
  if (covariances.R.size() != all.size()) throw std::invalid_argument("R: one matrix per sensor");
  for (std::size_t i = 0; i < all.size(); ++i) {
    Eigen::MatrixXd root = checked_positive_definite("R of sensor '" + all[i].name + "'",
                                                     covariances.R[i], all[i].outputs());
    listed_.add("R/" + all[i].name, root);
    factor_cholesky(root.data(), root.rows());
    noise_roots_.push_back(root);
  }
  const Eigen::MatrixXd Q = checked_positive_semidefinite("Q", covariances.Q, n());
  for (const PlantMode& mode : plant().modes()) {
    covariance_flows_.emplace_back(mode.flow->affine()->M(), Q);
    outputs_.emplace_back();
    for (std::size_t i = 0; i < all.size(); ++i) {
      Eigen::MatrixXd C = mode.outputs[i]->affine()->M();
      solve_lower(noise_roots_[i].data(), C.rows(), C.rows(), C.data(), n());
      outputs_.back().emplace_back(C.transpose());
    }
  }
  listed_.add("P0", P0_).add("Q", Q).add("Q_d", Q_d_);
  build_flow();
}

void HybridKalmanFilter::start_from(const double* estimate, double* state) const {
  PlantObserver::start_from(estimate, state);
  std::copy_n(P0_.data(), n() * n(), constants(state));
}

double HybridKalmanFilter::mahalanobis_distance(const Event& sample, const double* state,
                                                double* workspace) const {
  const auto sensor = static_cast<std::size_t>(sample.channel);
  const Eigen::Index m = sample.size;
  double* nu = workspace;
  double* S = nu + m;
  double* PC = S + m * m;
  innovation(sample, state, nu);
  // Where the noise has variance 1, S = I + C P Cᵀ.
  solve_lower(noise_roots_[sensor].data(), m, m, nu, 1);
  const double* C = outputs_[held(state).mode][sensor].data();
  multiply(covariance(state), n(), n(), C, m, PC);
  for (Eigen::Index j = 0; j < m; ++j) {
    for (Eigen::Index i = 0; i < m; ++i) {
      S[j * m + i] = (i == j ? 1.0 : 0.0) + dot(C + i * n(), PC + j * n(), n());
    }
  }
  if (!factor_cholesky(S, m)) return std::numeric_limits<double>::quiet_NaN();
  solve_lower(S, m, m, nu, 1);
  return std::sqrt(dot(nu, nu, m));
}

void HybridKalmanFilter::flow_constants(Duration duration, const Held& held, double* state,
                                        double* workspace) const {
  covariance_flows_[held.mode].apply(duration, constants(state), workspace);
}

void HybridKalmanFilter::sample(std::size_t sensor, const double* y, const Held& held,
                                double* state, double* workspace) const {
  correct(sensor, y, held, state, workspace);
}

void HybridKalmanFilter::jump(const Held& held, std::size_t next, const JumpOutputs& outputs,
                              double* state, double* workspace) const {
  static_cast<void>(next);
  for (std::size_t i = 0; i < sensors(); ++i) {
    if (plant().sensors()[i].timing != SensorTiming::kAtJumps || outputs.known[i] == 0.0) continue;
    correct(i, outputs.y_d + jump_output_offset(i), held, state, workspace);
  }
  apply_plant_jump(held, state, workspace);
  double* P = constants(state);
  const Eigen::Index entries = n() * n();
  const PlantMode& mode = plant().modes()[held.mode];
  if (!mode.jump) {
    for (Eigen::Index i = 0; i < entries; ++i) P[i] += Q_d_.data()[i];
    return;
  }
  const double* A_d = mode.jump->affine()->M().data();
  multiply(A_d, n(), n(), P, n(), workspace);
  std::copy_n(Q_d_.data(), entries, P);
  add_symmetric_product(workspace, A_d, n(), n(), P);
}

/// The update of x̂ and P by the outputs y of a sensor, in Joseph's form.
void HybridKalmanFilter::correct(std::size_t sensor, const double* y, const Held& held,
                                 double* state, double* workspace) const {
  const Eigen::Index m = plant().sensors()[sensor].outputs();
  double* innovation = workspace;
  double* correction = innovation + m;
  double* gain = correction + n();
  double* column = gain + n();  // P c
  double* rest = column + n();  // (I − K c) P c
  double* P = constants(state);

  compute_innovation(plant(), held.mode, sensor, y, state, held.u, innovation);
  solve_lower(noise_roots_[sensor].data(), m, m, innovation, 1);
  for (Eigen::Index i = 0; i < n(); ++i) correction[i] = 0.0;
  for (Eigen::Index output = 0; output < m; ++output) {
    const double* c = outputs_[held.mode][sensor].data() + output * n();
    multiply(P, n(), n(), c, 1, column);
    // Rounding may leave c P cᵀ a little below zero.
    const double variance = 1.0 + std::max(0.0, dot(c, column, n()));
    const double left = innovation[output] - dot(c, correction, n());
    for (Eigen::Index i = 0; i < n(); ++i) {
      gain[i] = column[i] / variance;
      correction[i] += gain[i] * left;
    }
    for (Eigen::Index j = 0; j < n(); ++j) {
      for (Eigen::Index i = 0; i < n(); ++i) P[j * n() + i] -= gain[i] * column[j];
    }
    multiply(P, n(), n(), c, 1, rest);
    for (Eigen::Index j = 0; j < n(); ++j) {
      for (Eigen::Index i = j; i < n(); ++i) {
        P[j * n() + i] += (gain[i] - rest[i]) * gain[j];
      }
    }
    mirror_lower(P, n());
  }
  for (Eigen::Index i = 0; i < n(); ++i) state[i] += correction[i];
}

}  // namespace sampled_data_observers
