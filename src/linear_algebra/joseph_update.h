#pragma once

#include <Eigen/Core>

namespace sampled_data_observers {

/// Number of entries of the scratch memory of joseph_update().
Eigen::Index joseph_update_scratch(Eigen::Index size);

/// The measurement update of a Kalman filter, output by output, in Joseph's form
/// P⁺ = (I − K c) P (I − K c)ᵀ + K Kᵀ, which keeps P symmetric to the bit.
/// @param rows        of the outputs, whose noises are independent and of variance 1: size x
///                    outputs, transposed
/// @param innovation  of the outputs
/// @param P           covariance, size x size
/// @param correction  of the estimate: size entries
/// @param scratch     joseph_update_scratch(size) entries
void joseph_update(const double* rows, Eigen::Index outputs, Eigen::Index size,
                   const double* innovation, double* P, double* correction, double* scratch);

}  // namespace sampled_data_observers
