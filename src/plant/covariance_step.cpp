#include "plant/covariance_step.h"

#include "linear_algebra/kernels.h"

namespace sampled_data_observers {

Eigen::Index covariance_step_workspace(Eigen::Index n) { return covariance_step_scratch(n); }

void covariance_step(const double* F, const double* Q, Eigen::Index n, double h, double* P,
                     double* workspace) {
  kernels().covariance_step(F, Q, n, h, P, workspace);
}

}  // namespace sampled_data_observers
