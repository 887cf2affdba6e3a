#include <algorithm>

#include "linear_algebra/ordered_linear_algebra.h"
#include "observer/hybrid_kalman_filter.h"

namespace sampled_data_observers {

/// The jump of x̂ and P where its stamp is uncertain: what is measured at it corrects (x, ε).
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
    const double* C = output_rows(i, held, state, workspace);
    double* rows = rows_.of(workspace);
    double* innovation = innovation_.of(workspace);
    normalized_innovation(i, y_d, held, state, workspace);
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
  const double* A_d = jump_matrix(held, state, workspace);
  apply_plant_jump(held, state, workspace);
  double* after = field_after_.of(workspace);
  plant().modes()[next].flow->evaluate(state, held.u, after);
  double* transition = transition_.of(workspace);
  double* saltation = transition + n() * n();
  if (A_d != nullptr) {
    std::copy_n(A_d, n() * n(), transition);
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

}  // namespace sampled_data_observers
