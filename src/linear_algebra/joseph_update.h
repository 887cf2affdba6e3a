#pragma once

#include <Eigen/Core>

namespace sampled_data_observers {

/// What an update leaves, and what it computes with: `size` numbers each.
struct JosephWorkspace {
  double* correction;  ///< of the estimate
  double* gain;
  double* column;  ///< P c
  double* rest;    ///< (I − K c) P c
};

/// The measurement update of a Kalman filter, output by output, in Joseph's form
/// P⁺ = (I − K c) P (I − K c)ᵀ + K Kᵀ, which keeps P symmetric to the bit.
/// @param rows        of the outputs, whose noises are independent and of variance 1: size x
///                    outputs, transposed
/// @param innovation  of the outputs
/// @param P           covariance, size x size
void joseph_update(const double* rows, Eigen::Index outputs, Eigen::Index size,
                   const double* innovation, double* P, const JosephWorkspace& workspace);

}  // namespace sampled_data_observers
