#include "observer/unscented_kalman_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "linear_algebra/ordered_linear_algebra.h"
#include "observer/sigma_points.h"
#include "observer/unit_norm_covariance.h"

namespace sampled_data_observers {

/// The plant's own, for its points.
class UnscentedKalmanFilter::Field : public VectorField {
 public:
  Field(const VectorMap& flow, const double* u) : flow_(flow), u_(u) {}
  void evaluate(const double* x, double* dx) const override { flow_.evaluate(x, u_, dx); }

 private:
  const VectorMap& flow_;
  const double* u_;
};

UnscentedKalmanFilter::UnscentedKalmanFilter(const ObserverContext& context,
                                             const KalmanCovariances& covariances)
    : PlantObserver(context, {SensorTiming::kSampled, SensorTiming::kAtJumps}),
      matrices_(kalman_matrices(covariances, plant())) {
  if (covariances.iterations != 1) {
    throw std::invalid_argument("iterations: 1, where there is nothing to linearize");
  }
  const std::vector<PlantMode>& modes = plant().modes();
  const bool is_exact = std::all_of(modes.begin(), modes.end(), [](const PlantMode& mode) {
    return mode.flow->affine() != nullptr;
  });
  if (is_exact) {
    for (const PlantMode& mode : modes) {
      covariance_flows_.emplace_back(mode.flow->affine()->M(), matrices_.Q);
    }
  } else {
    points_flow_ = std::make_unique<const RungeKuttaFlow>(n(), plant().integration().step);
  }
  for (std::size_t i = 0; i < sensors(); ++i) {
    if (matrices_.R[i].size() == 0) take_covariance_with(i);
  }
  build_flow();
}

LawGains UnscentedKalmanFilter::gains() const {
  return gains_of(matrices_, plant()).add("variant/unscented", Eigen::MatrixXd());
}

void UnscentedKalmanFilter::start_from(const double* estimate, double* state) const {
  PlantObserver::start_from(estimate, state);
  P_.set(matrices_.P0.data(), state);
  project_covariance(plant(), state, P_.of(state));
}

void UnscentedKalmanFilter::flow_constants(Duration duration, const Held& held, double* state,
                                           double* workspace) const {
  if (covariance_flows_.empty()) return;
  covariance_flows_[held.mode].apply(duration, P_.of(state), flown_.of(workspace));
}

void UnscentedKalmanFilter::step_constants(Duration duration, const Held& held,
                                           const double* before, double* after, double* state,
                                           double* workspace) const {
  const double* Q = matrices_.Q.data();
  const double half = 0.5 * to_seconds(duration);
  double* P = P_.of(state);
  double* factor = factor_.of(workspace);
  for (Eigen::Index i = 0; i < n() * n(); ++i) factor[i] = P[i] + half * Q[i];
  factor_semidefinite(factor, n());
  const Field field(*plant().modes()[held.mode].flow, held.u);
  double* spread = spread_.of(workspace);
  spread_of_points(before, factor, n(), n(), point_.of(workspace), spread,
                   [&](double* point, double* difference) {
                     plant().normalize(point);
                     points_flow_->apply(field, duration, point);
                     plant().normalize(point);
                     for (Eigen::Index i = 0; i < n(); ++i) difference[i] = point[i] - after[i];
                   });
  for (Eigen::Index i = 0; i < n() * n(); ++i) P[i] = half * Q[i];
  add_covariance_of_spread(spread, n(), n(), P);
  add_shift_of_mean(spread, n(), n(), after);
  project_covariance(plant(), after, P);
  plant().normalize(after);
}

UnscentedKalmanFilter::Variables UnscentedKalmanFilter::variables(const double* state,
                                                                  bool with_stamp,
                                                                  double* workspace) const {
  const bool has_stamp = with_stamp && has_uncertain_stamps();
  Variables of;
  of.size = n() + (has_stamp ? 1 : 0);
  of.mean = mean_.of(workspace);
  of.factor = factor_.of(workspace);
  std::copy_n(state, n(), of.mean);
  std::fill_n(of.factor, of.size * of.size, 0.0);
  const double* P = covariance(state);
  for (Eigen::Index j = 0; j < n(); ++j) std::copy_n(P + j * n(), n(), of.factor + j * of.size);
  if (has_stamp) {
    of.mean[n()] = 0.0;
    of.factor[of.size * of.size - 1] = matrices_.stamp_deviation * matrices_.stamp_deviation;
    of.speed = speed_before_.of(workspace);
  }
  factor_semidefinite(of.factor, of.size);
  return of;
}

/// From what the plant was at its true time to what it was at the stamp: x ← x − f ε.
void UnscentedKalmanFilter::to_stamp(const Variables& of, double* point) const {
  for (Eigen::Index i = 0; of.speed != nullptr && i < n(); ++i)
    point[i] -= of.speed[i] * point[n()];
  plant().normalize(point);
}

/// Leaves y − ȳ in innovation_, and the spread of the outputs in spread_.
void UnscentedKalmanFilter::measure(std::size_t sensor, const double* y, const Held& held,
                                    const Variables& of, double* workspace) const {
  const Plant::Output& output = plant().output(held.mode, sensor);
  const Eigen::Index m = output.size;
  double* spread = spread_.of(workspace);
  double* centre = centre_.of(workspace);
  double* point = point_.of(workspace);
  double* innovation = innovation_.of(workspace);
  std::copy_n(of.mean, of.size, point);
  to_stamp(of, point);
  output.map->evaluate(point, held.u, centre);
  compute_innovation(plant(), held.mode, sensor, y, point, held.u, innovation);
  spread_of_points(of.mean, of.factor, of.size, m, point, spread,
                   [&](double* at, double* difference) {
                     to_stamp(of, at);
                     compute_innovation(plant(), held.mode, sensor, centre, at, held.u, difference);
                     for (Eigen::Index i = 0; i < m; ++i) difference[i] = -difference[i];
                   });
  std::fill_n(centre, m, 0.0);
  add_shift_of_mean(spread, of.size, m, centre);
  for (Eigen::Index i = 0; i < m; ++i) innovation[i] -= centre[i];
  if (output.angular != nullptr) wrap_angles(*output.angular, innovation);
}

double UnscentedKalmanFilter::mahalanobis_distance(const Event& measured, const double* state,
                                                   double* workspace) const {
  const auto sensor = static_cast<std::size_t>(measured.sensor);
  const Held now = held(state);
  const bool is_at_jump = plant().sensors()[sensor].timing == SensorTiming::kAtJumps;
  const Variables of = variables(state, is_at_jump, workspace);
  if (of.speed != nullptr) {
    plant().modes()[now.mode].flow->evaluate(state, now.u, speed_before_.of(workspace));
  }
  measure(sensor, measured.values, now, of, workspace);
  const Eigen::Index m = measured.size;
  double* S = noise_.of(workspace);
  write_noise(matrices_, sensor, m, measured.values, S);
  add_covariance_of_spread(spread_.of(workspace), of.size, m, S);
  if (!factor_cholesky(S, m)) return std::numeric_limits<double>::quiet_NaN();
  double* innovation = innovation_.of(workspace);
  solve_lower(S, m, m, innovation, 1);
  return std::sqrt(dot(innovation, innovation, m));
}

void UnscentedKalmanFilter::sample(std::size_t sensor, const double* y, const Held& held,
                                   double* state, double* workspace) const {
  if (matrices_.outputs[held.mode][sensor].size() > 0) {
    correct_linearly(sensor, y, held, state, workspace);
  } else {
    const Variables of = variables(state, false, workspace);
    correct(sensor, y, held, of, workspace);
    std::copy_n(of.mean, n(), state);
    P_.set(covariance_.of(workspace), state);
  }
  normalize(state);
}

/// By an affine output.
void UnscentedKalmanFilter::correct_linearly(std::size_t sensor, const double* y, const Held& held,
                                             double* state, double* workspace) const {
  const Eigen::Index m = plant().sensors()[sensor].outputs();
  double* innovation = innovation_.of(workspace);
  double* correction = correction_.of(workspace);
  compute_innovation(plant(), held.mode, sensor, y, state, held.u, innovation);
  solve_lower(matrices_.noise_roots[sensor].data(), m, m, innovation, 1);
  joseph_update(matrices_.outputs[held.mode][sensor].data(), m, n(), innovation, P_.of(state),
                correction, updating_.of(workspace));
  for (Eigen::Index i = 0; i < n(); ++i) state[i] += correction[i];
}

/// Moves the mean, and leaves the covariance in covariance_.
void UnscentedKalmanFilter::correct(std::size_t sensor, const double* y, const Held& held,
                                    const Variables& of, double* workspace) const {
  const Eigen::Index m = plant().sensors()[sensor].outputs();
  const Eigen::Index size = of.size;
  measure(sensor, y, held, of, workspace);
  double* spread = spread_.of(workspace);
  double* noise = noise_.of(workspace);
  double* innovation = innovation_.of(workspace);
  write_noise(matrices_, sensor, m, y, noise);
  const double* even = spread + size * m;
  add_symmetric_product(even, even, m, size, noise);
  if (!factor_cholesky(noise, m)) {  // not finite
    std::fill_n(of.mean, size, std::numeric_limits<double>::quiet_NaN());
  }
  solve_lower(noise, m, m, innovation, 1);
  solve_lower(noise, m, m, spread, size);
  double* rows = rows_.of(workspace);
  for (Eigen::Index j = 0; j < size; ++j) {
    for (Eigen::Index i = 0; i < m; ++i) rows[i * size + j] = spread[j * m + i];
  }
  double* covariance = covariance_.of(workspace);
  double* correction = correction_.of(workspace);
  std::fill_n(covariance, size * size, 0.0);
  for (Eigen::Index i = 0; i < size; ++i) covariance[i * size + i] = 1.0;
  joseph_update(rows, m, size, innovation, covariance, correction, updating_.of(workspace));
  add_product(of.factor, size, size, correction, of.mean);
  double* product = product_.of(workspace);
  multiply(of.factor, size, size, covariance, size, product);
  std::fill_n(covariance, size * size, 0.0);
  add_symmetric_product(product, of.factor, size, size, covariance);
}

void UnscentedKalmanFilter::jump(const Held& held, std::size_t next, const JumpOutputs& outputs,
                                 double* state, double* workspace) const {
  const PlantMode& mode = plant().modes()[held.mode];
  const Variables of = variables(state, true, workspace);
  double* speed = speed_before_.of(workspace);
  mode.flow->evaluate(of.mean, held.u, speed);
  for (const std::size_t i : sensors_of(SensorTiming::kAtJumps)) {
    const double* y_d = outputs.of(i);
    if (y_d == nullptr) continue;
    correct(i, y_d, held, of, workspace);
    std::copy_n(covariance_.of(workspace), of.size * of.size, of.factor);
    factor_semidefinite(of.factor, of.size);
    mode.flow->evaluate(of.mean, held.u, speed);
  }

  double* after = point_.of(workspace);
  const auto jumped = [&](const double* x, double* result) {
    if (mode.jump) {
      mode.jump->evaluate(x, held.u, result);
    } else {
      std::copy_n(x, n(), result);
    }
  };
  jumped(of.mean, after);
  plant().normalize(after);
  double* speed_after = speed_after_.of(workspace);
  plant().modes()[next].flow->evaluate(after, held.u, speed_after);
  const auto carry = [&](double* point, double* result) {
    const double stamp_error = of.speed != nullptr ? point[n()] : 0.0;
    to_stamp(of, point);
    jumped(point, result);
    for (Eigen::Index i = 0; i < n(); ++i) result[i] += speed_after[i] * stamp_error;
    plant().normalize(result);
  };
  double* point = point_.of(workspace);
  double* centre = centre_.of(workspace);
  double* spread = spread_.of(workspace);
  std::copy_n(of.mean, of.size, point);
  carry(point, centre);
  spread_of_points(of.mean, of.factor, of.size, n(), point, spread,
                   [&](double* at, double* difference) {
                     carry(at, difference);
                     for (Eigen::Index i = 0; i < n(); ++i) difference[i] -= centre[i];
                   });
  P_.set(matrices_.Q_d.data(), state);
  add_covariance_of_spread(spread, of.size, n(), P_.of(state));
  std::copy_n(centre, n(), state);
  add_shift_of_mean(spread, of.size, n(), state);
  normalize(state);
}

/// After a reset: brings the groups of unit norm back to it, and P with them.
void UnscentedKalmanFilter::normalize(double* state) const {
  project_covariance(plant(), state, P_.of(state));
  plant().normalize(state);
}

}  // namespace sampled_data_observers
