#pragma once

#include <Eigen/Core>
#include <optional>

namespace sampled_data_observers {

// Functions of whole matrices, compiled once: Eigen's decompositions are slow to compile.

/// Eigenvalues of (a + aᵀ)/2, in increasing order; NaN where a is not finite.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a);
double min_eigenvalue(const Eigen::MatrixXd& a);
double max_eigenvalue(const Eigen::MatrixXd& a);

/// The least c for which a <= c b, a symmetric and b symmetric positive definite.
double largest_generalized_eigenvalue(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
/// An eigenvector of norm 1 of the least eigenvalue of (a + aᵀ)/2.
/// @pre a is finite
Eigen::VectorXd least_eigenvector(const Eigen::MatrixXd& a);

/// W with Wᵀ a W = I and Wᵀ b W diagonal, for symmetric matrices; nothing where a is not positive
/// definite.
std::optional<Eigen::MatrixXd> diagonalizing_congruence(const Eigen::MatrixXd& a,
                                                        const Eigen::MatrixXd& b);

/// Singular values, in decreasing order; the largest is the norm ‖a‖₂.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& a);
double norm2(const Eigen::MatrixXd& a);

/// The diagonal of a D, powers of two, for which D⁻¹ a D has rows and columns of similar size: a
/// change of units that is exact in floating point, and after which rounding does not depend on the
/// units of a. Ones where a is not finite.
Eigen::VectorXd balancing_of(const Eigen::MatrixXd& a);
/// D⁻¹ a D
Eigen::MatrixXd balanced_by(const Eigen::VectorXd& D, const Eigen::MatrixXd& a);

/// e^a, computed in balanced units
Eigen::MatrixXd exponential_of(const Eigen::MatrixXd& a);

/// a⁻¹; not finite where a is singular.
Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& a);

/// a⁻¹; nothing where a is singular.
std::optional<Eigen::MatrixXd> inverse_where_regular(const Eigen::MatrixXd& a);

/// a⁻¹ b
Eigen::MatrixXd solve_linear(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// a⁻¹ b for a symmetric positive definite a.
Eigen::MatrixXd solve_definite(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// The upper triangular R with a = Rᵀ R; not finite where a is not positive definite.
Eigen::MatrixXd cholesky_root(const Eigen::MatrixXd& a);

Eigen::Index rank_of(const Eigen::MatrixXd& a);

/// The Moore–Penrose pseudo-inverse.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& a);

/// Orthonormal columns orthogonal to those of a, which are independent.
Eigen::MatrixXd orthogonal_complement(const Eigen::MatrixXd& a);

/// The eigenvalues of a square matrix, in no order.
Eigen::VectorXcd eigenvalues_of(const Eigen::MatrixXd& a);

/// An orthonormal basis of the null space of a, as columns.
Eigen::MatrixXd null_space(const Eigen::MatrixXd& a);

/// The right singular vectors of the `count` least singular values, as orthonormal columns.
Eigen::MatrixXd weakest_directions(const Eigen::MatrixXd& a, Eigen::Index count);

}  // namespace sampled_data_observers
