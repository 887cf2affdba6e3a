#include "observer/hybrid_kalman_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "linear_algebra/ordered_linear_algebra.h"

namespace sampled_data_observers {

HybridKalmanFilter::HybridKalmanFilter(const ObserverContext& context,
                                       const KalmanCovariances& covariances)
    : PlantObserver(context, {SensorTiming::kSampled, SensorTiming::kAtJumps}),
      matrices_(kalman_matrices(covariances, plant())) {
  for (const PlantMode& mode : plant().modes()) {
    covariance_flows_.emplace_back(mode.flow->affine()->M(), matrices_.Q);
  }
  build_flow();
}

LawGains HybridKalmanFilter::gains() const {
  LawGains all;
  for (std::size_t i = 0; i < sensors(); ++i) {
    all.add("R/" + plant().sensors()[i].name, matrices_.R[i]);
  }
  return all.add("P0", matrices_.P0).add("Q", matrices_.Q).add("Q_d", matrices_.Q_d);
}

void HybridKalmanFilter::start_from(const double* estimate, double* state) const {
  PlantObserver::start_from(estimate, state);
  P_.set(matrices_.P0.data(), state);
}

double HybridKalmanFilter::mahalanobis_distance(const Event& sample, const double* state,
                                                double* workspace) const {
  const auto sensor = static_cast<std::size_t>(sample.sensor);
  const Eigen::Index m = sample.size;
  double* nu = innovation_.of(workspace);
  double* S = S_.of(workspace);
  double* PC = PC_.of(workspace);
  innovation(sample, state, nu);
  // Where the noise has variance 1, S = I + C P Cᵀ.
  solve_lower(matrices_.noise_roots[sensor].data(), m, m, nu, 1);
  const double* C = matrices_.outputs[held(state).mode][sensor].data();
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
  covariance_flows_[held.mode].apply(duration, P_.of(state), flown_.of(workspace));
}

void HybridKalmanFilter::sample(std::size_t sensor, const double* y, const Held& held,
                                double* state, double* workspace) const {
  correct(sensor, y, held, state, workspace);
}

void HybridKalmanFilter::jump(const Held& held, std::size_t next, const JumpOutputs& outputs,
                              double* state, double* workspace) const {
  if (matrices_.stamp_deviation > 0.0) {
    jump_of_uncertain_stamp(held, next, outputs, state, workspace);
    return;
  }
  for (const std::size_t i : sensors_of(SensorTiming::kAtJumps)) {
    if (const double* y_d = outputs.of(i)) correct(i, y_d, held, state, workspace);
  }
  apply_plant_jump(held, state, workspace);
  double* P = P_.of(state);
  const PlantMode& mode = plant().modes()[held.mode];
  if (!mode.jump) {
    for (Eigen::Index i = 0; i < P_.size(); ++i) P[i] += matrices_.Q_d.data()[i];
    return;
  }
  const double* A_d = mode.jump->affine()->M().data();
  double* A_d_P = flown_.of(workspace);
  multiply(A_d, n(), n(), P, n(), A_d_P);
  P_.set(matrices_.Q_d.data(), state);
  add_symmetric_product(A_d_P, A_d, n(), n(), P);
}

void HybridKalmanFilter::jump_of_uncertain_stamp(const Held& held, std::size_t next,
                                                 const JumpOutputs& outputs, double* state,
                                                 double* workspace) const {
  const Eigen::Index size = variables();
  double* P = P_.of(state);
  double* joint = joint_.of(workspace);
  std::fill_n(joint, joint_.size(), 0.0);
  for (Eigen::Index j = 0; j < n(); ++j) std::copy_n(P + j * n(), n(), joint + j * size);
  joint[size * size - 1] = matrices_.stamp_deviation * matrices_.stamp_deviation;

  const PlantMode& mode = plant().modes()[held.mode];
  double* before = field_before_.of(workspace);
  mode.flow->evaluate(state, held.u, before);
  double stamp_error = 0.0;
  for (const std::size_t i : sensors_of(SensorTiming::kAtJumps)) {
    const double* y_d = outputs.of(i);
    if (y_d == nullptr) continue;
    const Eigen::Index m = plant().sensors()[i].outputs();
    const double* C = matrices_.outputs[held.mode][i].data();
    double* rows = rows_.of(workspace);
    double* innovation = innovation_.of(workspace);
    normalized_innovation(i, y_d, held, state, innovation);
    for (Eigen::Index j = 0; j < m; ++j) {
      std::copy_n(C + j * n(), n(), rows + j * size);
      const double per_stamp_error = -dot(C + j * n(), before, n());
      rows[j * size + n()] = per_stamp_error;
      innovation[j] -= per_stamp_error * stamp_error;
    }
    update(rows, m, size, joint, workspace);
    const double* correction = correction_.of(workspace);
    for (Eigen::Index j = 0; j < n(); ++j) state[j] += correction[j];
    stamp_error += correction[n()];
  }

  mode.flow->evaluate(state, held.u, before);
  apply_plant_jump(held, state, workspace);
  double* after = field_after_.of(workspace);
  plant().modes()[next].flow->evaluate(state, held.u, after);
  double* transition = transition_.of(workspace);
  double* saltation = transition + n() * n();
  if (mode.jump) {
    std::copy_n(mode.jump->affine()->M().data(), n() * n(), transition);
  } else {
    std::fill_n(transition, n() * n(), 0.0);
    for (Eigen::Index i = 0; i < n(); ++i) transition[i * n() + i] = 1.0;
  }
  multiply(transition, n(), n(), before, 1, saltation);
  for (Eigen::Index i = 0; i < n(); ++i) {
    saltation[i] = after[i] - saltation[i];
    state[i] += saltation[i] * stamp_error;
  }
  double* propagated = propagated_.of(workspace);
  multiply(transition, n(), size, joint, size, propagated);
  P_.set(matrices_.Q_d.data(), state);
  add_symmetric_product(propagated, transition, n(), size, P);
}

/// The update of x̂ and P by the outputs y of a sensor.
void HybridKalmanFilter::correct(std::size_t sensor, const double* y, const Held& held,
                                 double* state, double* workspace) const {
  const double* correction = correction_.of(workspace);
  normalized_innovation(sensor, y, held, state, innovation_.of(workspace));
  update(matrices_.outputs[held.mode][sensor].data(), plant().sensors()[sensor].outputs(), n(),
         P_.of(state), workspace);
  for (Eigen::Index i = 0; i < n(); ++i) state[i] += correction[i];
}

/// The innovation of outputs whose noises are independent and of variance 1.
void HybridKalmanFilter::normalized_innovation(std::size_t sensor, const double* y,
                                               const Held& held, const double* state,
                                               double* innovation) const {
  const Eigen::Index m = plant().sensors()[sensor].outputs();
  compute_innovation(plant(), held.mode, sensor, y, state, held.u, innovation);
  solve_lower(matrices_.noise_roots[sensor].data(), m, m, innovation, 1);
}

/// Takes the normalized innovation that stands in innovation_ into P (size x size), in Joseph's
/// form, and leaves what it corrects in correction_.
/// @param rows  of the outputs: size x outputs, transposed
void HybridKalmanFilter::update(const double* rows, Eigen::Index outputs, Eigen::Index size,
                                double* P, double* workspace) const {
  const double* innovation = innovation_.of(workspace);
  double* correction = correction_.of(workspace);
  double* gain = gain_.of(workspace);
  double* column = column_.of(workspace);
  double* rest = rest_.of(workspace);
  for (Eigen::Index i = 0; i < size; ++i) correction[i] = 0.0;
  for (Eigen::Index output = 0; output < outputs; ++output) {
    const double* c = rows + output * size;
    multiply(P, size, size, c, 1, column);
    // Rounding may leave c P cᵀ a little below zero.
    const double variance = 1.0 + std::max(0.0, dot(c, column, size));
    const double left = innovation[output] - dot(c, correction, size);
    for (Eigen::Index i = 0; i < size; ++i) {
      gain[i] = column[i] / variance;
      correction[i] += gain[i] * left;
    }
    for (Eigen::Index j = 0; j < size; ++j) {
      for (Eigen::Index i = 0; i < size; ++i) P[j * size + i] -= gain[i] * column[j];
    }
    multiply(P, size, size, c, 1, rest);
    for (Eigen::Index j = 0; j < size; ++j) {
      for (Eigen::Index i = j; i < size; ++i) {
        P[j * size + i] += (gain[i] - rest[i]) * gain[j];
      }
    }
    mirror_lower(P, size);
  }
}

}  // namespace sampled_data_observers
