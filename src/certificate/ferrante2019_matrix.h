#pragma once

#include <functional>
#include <vector>

#include "certificate/matrix_expression.h"
#include "certificate/plant_matrices.h"

namespace sampled_data_observers {

// Parts of the inequalities of ferrante2019, in the symbols P1 (n x n), P2 (m x m), delta, and
// gamma and chi, where there are a disturbance and a nonlinearity.

/// M(τ) of ferrante2019 (30). The gains enter by two products in which it is linear.
/// @param e        e^{δτ}
/// @param P1_L     P1 L, n x m
/// @param P2_CL_H  P2 (C L + H), m x m
MatrixExpression ferrante2019_M(const PlantMatrices& plant, const MatrixExpression& e,
                                const MatrixExpression& lambda_t, const MatrixExpression& P1_L,
                                const MatrixExpression& P2_CL_H);

/// 2 λ_t P1 + C_pᵀ C_p + χ ℓ² Sᵀ S, of the upper left block of (30), and of (37), which is printed
/// with λ_t P1 there.
MatrixExpression ferrante2019_error_weight(const PlantMatrices& plant,
                                           const MatrixExpression& lambda_t);

/// The upper triangle of a symmetric matrix of blocks, from the diagonal on.
using UpperTriangle = std::vector<std::vector<MatrixExpression>>;

/// Completes a matrix by the rows and columns of w and of ψ, with −γ² I and −χ I on the diagonal;
/// each only where the plant has it (Remark 2).
/// @param column  the column of blocks of an input that enters the flow by a matrix, N or G
MatrixExpression ferrante2019_with_inputs(
    const PlantMatrices& plant, UpperTriangle rows,
    const std::function<std::vector<MatrixExpression>(const MatrixExpression&)>& column);

}  // namespace sampled_data_observers
