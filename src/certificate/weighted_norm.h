#pragma once

#include <Eigen/Core>

#include "certificate/matrix_expression.h"

namespace sampled_data_observers {

// Norms of matrices between spaces with |v|_P = √(vᵀ P v), P > 0, not less than they are: s² bounds
// that of a where s² from − aᵀ to a > 0, which is checked with a bound on its own rounding. So it
// holds, too, where P is ill-conditioned, and a large beside its norm.

/// sup |a v|_to for |v|_from <= 1; a has numbers only, no symbols.
/// @throws std::invalid_argument where no s can be shown to bound it
double norm_between(const Eigen::MatrixXd& from, const Eigen::MatrixXd& to,
                    const MatrixExpression& a);

/// sup |a v|_P for |v| <= 1
/// @throws as norm_between()
double norm_into(const Eigen::MatrixXd& P, const Eigen::MatrixXd& a);

}  // namespace sampled_data_observers
