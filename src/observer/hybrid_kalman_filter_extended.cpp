// What the filter does where the plant is not affine: linearize it along the estimate.
#include <algorithm>

#include "linear_algebra/ordered_linear_algebra.h"
#include "observer/hybrid_kalman_filter.h"
#include "observer/unit_norm_covariance.h"

namespace sampled_data_observers {

bool HybridKalmanFilter::is_affine(std::size_t sensor, const Held& held) const {
  return jacobians_.modes[held.mode].outputs[sensor].constant() != nullptr;
}

/// (L⁻¹ H)ᵀ with H = ∂h/∂x at x, R = L Lᵀ: n x m.
const double* HybridKalmanFilter::output_rows(std::size_t sensor, const Held& held, const double* x,
                                              double* workspace) const {
  if (matrices_.outputs[held.mode][sensor].size() > 0) {
    return matrices_.outputs[held.mode][sensor].data();
  }
  const Eigen::Index m = plant().sensors()[sensor].outputs();
  double* H = jacobian_.of(workspace);
  jacobians_.modes[held.mode].outputs[sensor].evaluate(x, held.u, H,
                                                       differentiating_.of(workspace));
  solve_lower(noise_root(sensor, workspace), m, m, H, n());
  double* rows = output_rows_.of(workspace);
  for (Eigen::Index j = 0; j < n(); ++j) {
    for (Eigen::Index i = 0; i < m; ++i) rows[i * n() + j] = H[j * m + i];
  }
  return rows;
}

/// A_d = ∂g/∂x at x; null in a mode without jump map.
const double* HybridKalmanFilter::jump_matrix(const Held& held, const double* x,
                                              double* workspace) const {
  const std::optional<Jacobian>& jump = jacobians_.modes[held.mode].jump;
  if (!jump || jump->constant() != nullptr) return jump ? jump->constant() : nullptr;
  double* A_d = jacobian_.of(workspace);
  jump->evaluate(x, held.u, A_d, differentiating_.of(workspace));
  return A_d;
}

/// After a reset: brings the groups of unit norm back to it, and P with them.
void HybridKalmanFilter::normalize(double* state) const {
  project_covariance(plant(), state, P_.of(state));
  plant().normalize(state);
}

/// x̂⁺ from x̂ and P before the update each time, with the outputs linearized at the last x̂⁺, x_i:
/// y − h(x_i) − H (x̂ − x_i) in place of the innovation.
void HybridKalmanFilter::correct_iteratively(std::size_t sensor, const double* y, const Held& held,
                                             double* state, double* workspace) const {
  const Eigen::Index m = plant().sensors()[sensor].outputs();
  double* P = P_.of(state);
  double* first = x_before_.of(workspace);
  double* moved = moved_.of(workspace);
  double* innovation = innovation_.of(workspace);
  const double* correction = correction_.of(workspace);
  std::copy_n(state, n(), first);
  P_before_.set(P, workspace);
  std::fill_n(moved, n(), 0.0);
  for (int iteration = 0; iteration < iterations_; ++iteration) {
    normalized_innovation(sensor, y, held, state, workspace);
    const double* rows = output_rows(sensor, held, state, workspace);
    for (Eigen::Index i = 0; i < m; ++i) innovation[i] += dot(rows + i * n(), moved, n());
    P_.set(P_before_.of(workspace), state);
    update(rows, m, n(), P, workspace);
    for (Eigen::Index i = 0; i < n(); ++i) {
      moved[i] = correction[i];
      state[i] = first[i] + moved[i];
    }
  }
}

}  // namespace sampled_data_observers
