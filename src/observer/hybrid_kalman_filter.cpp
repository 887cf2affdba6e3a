#include "observer/hybrid_kalman_filter.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "linear_algebra/ordered_linear_algebra.h"
#include "observer/unit_norm_covariance.h"

namespace sampled_data_observers {
namespace {

/// How far off the first estimate may be: what states usually change by.
Eigen::VectorXd first_deviations(const Eigen::MatrixXd& P0) { return P0.diagonal().cwiseSqrt(); }

bool has_affine_flows(const Plant& plant) {
  return std::all_of(plant.modes().begin(), plant.modes().end(),
                     [](const PlantMode& mode) { return mode.flow->affine() != nullptr; });
}

int checked_iterations(int iterations) {
  if (iterations < 1) throw std::invalid_argument("iterations: at least 1");
  return iterations;
}

}  // namespace

HybridKalmanFilter::HybridKalmanFilter(const ObserverContext& context,
                                       const KalmanCovariances& covariances)
    : PlantObserver(context, {SensorTiming::kSampled, SensorTiming::kAtJumps}),
      matrices_(kalman_matrices(covariances, plant())),
      jacobians_(plant(), first_deviations(matrices_.P0)),
      iterations_(checked_iterations(covariances.iterations)) {
  if (has_affine_flows(plant())) {
    for (const PlantMode& mode : plant().modes()) {
      covariance_flows_.emplace_back(mode.flow->affine()->M(), matrices_.Q);
    }
  }
  for (std::size_t i = 0; i < sensors(); ++i) {
    if (matrices_.R[i].size() == 0) take_covariance_with(i);
  }
  build_flow();
}

LawGains HybridKalmanFilter::gains() const {
  return gains_of(matrices_, plant()).add("iterations", static_cast<double>(iterations_));
}

void HybridKalmanFilter::start_from(const double* estimate, double* state) const {
  PlantObserver::start_from(estimate, state);
  P_.set(matrices_.P0.data(), state);
  project_covariance(plant(), state, P_.of(state));
}

double HybridKalmanFilter::mahalanobis_distance(const Event& sample, const double* state,
                                                double* workspace) const {
  const auto sensor = static_cast<std::size_t>(sample.sensor);
  const Eigen::Index m = sample.size;
  take_noise(sensor, sample.values, workspace);
  double* nu = innovation_.of(workspace);
  double* S = S_.of(workspace);
  double* PC = PC_.of(workspace);
  innovation(sample, state, nu);
  // Where the noise has variance 1, S = I + C P Cᵀ.
  solve_lower(noise_root(sensor, workspace), m, m, nu, 1);
  const double* C = output_rows(sensor, held(state), state, workspace);
  multiply(covariance(state), n(), n(), C, m, PC);
  for (Eigen::Index j = 0; j < m; ++j) {
    for (Eigen::Index i = 0; i < m; ++i) {
      S[j * m + i] = (i == j ? 1.0 : 0.0) + dot(C + i * n(), PC + j * n(), n());
    }
  }
  if (plant().sensors()[sensor].timing == SensorTiming::kAtJumps) {
    add_covariance_of_stamp(C, m, state, S, workspace);
  }
  if (!factor_cholesky(S, m)) return std::numeric_limits<double>::quiet_NaN();
  solve_lower(S, m, m, nu, 1);
  return std::sqrt(dot(nu, nu, m));
}

/// Adds what the error of a jump's stamp makes of outputs measured at it, σ² (C f)(C f)ᵀ.
/// @param C  of the normalized outputs: n x m, transposed
/// @param S  m x m
void HybridKalmanFilter::add_covariance_of_stamp(const double* C, Eigen::Index m,
                                                 const double* state, double* S,
                                                 double* workspace) const {
  if (matrices_.stamp_deviation == 0.0) return;
  const Held now = held(state);
  double* speed = field_before_.of(workspace);
  plant().modes()[now.mode].flow->evaluate(state, now.u, speed);
  for (Eigen::Index j = 0; j < m; ++j) {
    for (Eigen::Index i = 0; i < m; ++i) {
      S[j * m + i] += matrices_.stamp_deviation * dot(C + i * n(), speed, n()) *
                      matrices_.stamp_deviation * dot(C + j * n(), speed, n());
    }
  }
}

void HybridKalmanFilter::flow_constants(Duration duration, const Held& held, double* state,
                                        double* workspace) const {
  if (covariance_flows_.empty()) return;
  covariance_flows_[held.mode].apply(duration, P_.of(state), flown_.of(workspace));
}

void HybridKalmanFilter::step_constants(Duration duration, const Held& held, const double* before,
                                        double* after, double* state, double* workspace) const {
  double* middle = midpoint_.of(workspace);
  for (Eigen::Index i = 0; i < n(); ++i) middle[i] = 0.5 * (before[i] + after[i]);
  double* F = jacobian_.of(workspace);
  jacobians_.modes[held.mode].flow.evaluate(middle, held.u, F, differentiating_.of(workspace));
  covariance_step(F, matrices_.Q.data(), n(), to_seconds(duration), P_.of(state),
                  stepping_.of(workspace));
  project_covariance(plant(), after, P_.of(state));
}

void HybridKalmanFilter::sample(std::size_t sensor, const double* y, const Held& held,
                                double* state, double* workspace) const {
  take_noise(sensor, y, workspace);
  correct(sensor, y, held, state, workspace);
  normalize(state);
}

/// Where R comes with the outputs y, behind them: makes noise_root() that of this sample.
void HybridKalmanFilter::take_noise(std::size_t sensor, const double* y, double* workspace) const {
  if (matrices_.R[sensor].size() > 0) return;
  const Eigen::Index m = plant().sensors()[sensor].outputs();
  write_noise(matrices_, sensor, m, y, noise_root_.of(workspace));
  factor_cholesky(noise_root_.of(workspace), m);
}

/// L with R = L Lᵀ.
const double* HybridKalmanFilter::noise_root(std::size_t sensor, const double* workspace) const {
  const Eigen::MatrixXd& root = matrices_.noise_roots[sensor];
  return root.size() > 0 ? root.data() : noise_root_.of(workspace);
}

void HybridKalmanFilter::jump(const Held& held, std::size_t next, const JumpOutputs& outputs,
                              double* state, double* workspace) const {
  if (matrices_.stamp_deviation > 0.0) {
    jump_of_uncertain_stamp(held, next, outputs, state, workspace);
  } else {
    jump_of_certain_stamp(held, outputs, state, workspace);
  }
  normalize(state);
}

void HybridKalmanFilter::jump_of_certain_stamp(const Held& held, const JumpOutputs& outputs,
                                               double* state, double* workspace) const {
  for (const std::size_t i : sensors_of(SensorTiming::kAtJumps)) {
    if (const double* y_d = outputs.of(i)) correct(i, y_d, held, state, workspace);
  }
  const double* A_d = jump_matrix(held, state, workspace);
  apply_plant_jump(held, state, workspace);
  double* P = P_.of(state);
  if (A_d == nullptr) {
    for (Eigen::Index i = 0; i < P_.size(); ++i) P[i] += matrices_.Q_d.data()[i];
    return;
  }
  double* A_d_P = flown_.of(workspace);
  multiply(A_d, n(), n(), P, n(), A_d_P);
  P_.set(matrices_.Q_d.data(), state);
  add_symmetric_product(A_d_P, A_d, n(), n(), P);
}

/// The update of x̂ and P by the outputs y of a sensor.
void HybridKalmanFilter::correct(std::size_t sensor, const double* y, const Held& held,
                                 double* state, double* workspace) const {
  if (iterations_ > 1 && !is_affine(sensor, held)) {
    correct_iteratively(sensor, y, held, state, workspace);
    return;
  }
  const double* correction = correction_.of(workspace);
  normalized_innovation(sensor, y, held, state, workspace);
  update(output_rows(sensor, held, state, workspace), plant().sensors()[sensor].outputs(), n(),
         P_.of(state), workspace);
  for (Eigen::Index i = 0; i < n(); ++i) state[i] += correction[i];
}

/// Takes the normalized innovation that stands in innovation_ into P (size x size), and leaves what
/// it corrects in correction_.
/// @param rows  of the outputs: size x outputs, transposed
void HybridKalmanFilter::update(const double* rows, Eigen::Index outputs, Eigen::Index size,
                                double* P, double* workspace) const {
  joseph_update(rows, outputs, size, innovation_.of(workspace), P, correction_.of(workspace),
                updating_.of(workspace));
}

/// innovation_ ← that of outputs whose noises are independent and of variance 1.
void HybridKalmanFilter::normalized_innovation(std::size_t sensor, const double* y,
                                               const Held& held, const double* state,
                                               double* workspace) const {
  const Eigen::Index m = plant().sensors()[sensor].outputs();
  double* innovation = innovation_.of(workspace);
  compute_innovation(plant(), held.mode, sensor, y, state, held.u, innovation);
  solve_lower(noise_root(sensor, workspace), m, m, innovation, 1);
}

}  // namespace sampled_data_observers
