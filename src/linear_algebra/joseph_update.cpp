#include "linear_algebra/joseph_update.h"

#include "linear_algebra/kernels.h"

namespace sampled_data_observers {

Eigen::Index joseph_update_scratch(Eigen::Index size) { return joseph_scratch(size); }

void joseph_update(const double* rows, Eigen::Index outputs, Eigen::Index size,
                   const double* innovation, double* P, double* correction, double* scratch) {
  kernels().joseph_update({rows, outputs, size, innovation}, P, correction, scratch);
}

}  // namespace sampled_data_observers
