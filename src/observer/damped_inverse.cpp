#include "observer/damped_inverse.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "linear_algebra/ordered_linear_algebra.h"
#include "linear_algebra/ordered_solve.h"
#include "observer/gain_requirement.h"

namespace sampled_data_observers {

DampedInverse::DampedInverse(Eigen::VectorXd powers, std::vector<Eigen::Index> outputs,
                             Eigen::VectorXd scales, double damping)
    : powers_(std::move(powers)),
      outputs_(std::move(outputs)),
      scales_(std::move(scales)),
      damping_(damping) {
  require_of_gains(damping >= 0.0 && std::isfinite(damping), "damping: a number of 0 or more");
  require_of_gains(powers_.size() == scales_.size(), "K: as many entries as the plant has states");
}

void DampedInverse::apply(double* J, double* r, double* workspace) const {
  const Eigen::Index n = scales_.size();
  if (damping_ == 0.0) {
    solve_in_place(J, r, n);
    return;
  }
  double of_outputs = 0.0;
  for (Eigen::Index j = 0; j < n; ++j) {
    double* column = J + j * n;
    for (Eigen::Index i = 0; i < n; ++i) column[i] *= powers_(i) * scales_(j);
    for (const Eigen::Index i : outputs_) of_outputs += column[i] * column[i];
  }
  for (Eigen::Index i = 0; i < n; ++i) r[i] *= powers_(i);
  double* normal = workspace;
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = 0; i < n; ++i) normal[j * n + i] = dot(J + i * n, J + j * n, n);
    normal[j * n + j] += damping_ * damping_ * (of_outputs / static_cast<double>(outputs_.size()));
  }
  double* solution = workspace + n * n;
  for (Eigen::Index j = 0; j < n; ++j) solution[j] = dot(J + j * n, r, n);
  solve_in_place(normal, solution, n);
  for (Eigen::Index i = 0; i < n; ++i) r[i] = scales_(i) * solution[i];
  if (!std::all_of(r, r + n, [](double value) { return std::isfinite(value); })) {
    std::fill_n(r, n, 0.0);
  }
}

}  // namespace sampled_data_observers
