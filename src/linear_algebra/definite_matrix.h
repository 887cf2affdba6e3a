#pragma once

#include <Eigen/Core>
#include <string>

namespace sampled_data_observers {

/// The matrix, symmetric to the bit, once it is known to be n x n, symmetric up to rounding (1e-12
/// of its largest entry) and positive definite.
/// @throws std::invalid_argument saying what `name` is not.
Eigen::MatrixXd checked_positive_definite(const std::string& name, const Eigen::MatrixXd& matrix,
                                          Eigen::Index n);

/// The same for positive semidefinite matrices: up to rounding, no direction is negative, whatever
/// the units of the rows.
Eigen::MatrixXd checked_positive_semidefinite(const std::string& name,
                                              const Eigen::MatrixXd& matrix, Eigen::Index n);

}  // namespace sampled_data_observers
