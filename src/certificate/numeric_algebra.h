#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "certificate/matrix_expression.h"

namespace sampled_data_observers {

/// Values of symbols; scalars are 1 x 1.
using NamedMatrices = std::map<std::string, Eigen::MatrixXd>;

/// The value of a scalar symbol.
/// @throws std::out_of_range where there is none.
double scalar_value(const NamedMatrices& values, const std::string& name);

/// 1 x 1
Eigen::MatrixXd scalar_matrix(double value);

/// The value of an expression, in floating point.
/// @param values  of all its symbols
/// @param tau     value of τ [s]
/// @throws std::out_of_range naming a symbol without a value, std::invalid_argument for one of
/// another size.
Eigen::MatrixXd evaluate(const MatrixExpression& expression, const NamedMatrices& values,
                         double tau = 0.0);

/// The value of a symbol, which must have the size that the expression gives it.
/// @throws as evaluate()
const Eigen::MatrixXd& value_of(const MatrixExpression::Node& symbol, const NamedMatrices& values);

/// The matrix that a node of kind kBlocks is made of these, row by row; one without entries stands
/// for zeros.
Eigen::MatrixXd joined_blocks(const MatrixExpression::Node& node,
                              const std::vector<const Eigen::MatrixXd*>& blocks);

}  // namespace sampled_data_observers
