#pragma once

#include <Eigen/Core>
#include <vector>

namespace sampled_data_observers {

/// An observable pair (A, H), n states and m outputs, in block-diagonal observable form
/// (bernard2022, example 4.2): with 𝒱 the change of coordinates,
///
///   𝒱 A 𝒱⁻¹ = 𝐀 + 𝐃 𝐇,   H 𝒱⁻¹ = M 𝐇,
///
/// where 𝐀 = blkdiag(A_i) and 𝐇 = blkdiag(H_i), A_i (d_i x d_i) with ones below the diagonal and
/// H_i = (0 … 0 1). M is lower triangular with ones on the diagonal; for one output, and for
/// outputs of equal indices, it is the identity, as the paper has it. 𝐃 need not be block-diagonal.
struct ObservableForm {
  std::vector<Eigen::Index> indices;  ///< m observability indices d_i >= 1, of sum n
  Eigen::MatrixXd basis;              ///< n x n: 𝒱⁻¹
  Eigen::MatrixXd D;                  ///< n x m: 𝐃
  Eigen::MatrixXd M;                  ///< m x m
};

/// The rows h_j A^k are taken in the order of k, then j, each unless it depends on those before it.
/// @param A  n x n
/// @param H  m x n
/// @throws std::invalid_argument where the pair is not observable, or an output depends linearly on
/// the others and therefore adds nothing.
ObservableForm observable_form(const Eigen::MatrixXd& A, const Eigen::MatrixXd& H);

/// The gain L_c = 𝒱⁻¹ (𝐃 + ℓ 𝓛(ℓ) 𝐊) M⁻¹, n x m, with 𝓛_i = diag(ℓ^(d_i−1), …, ℓ, 1), for which
/// the eigenvalues of A − L_c H are ℓ times those of 𝐀 − 𝐊 𝐇 (bernard2022 (24)).
/// @param ell  ℓ > 0
/// @param K    m vectors K_i of d_i entries
/// @throws std::invalid_argument for a K that does not fit or for which 𝐀 − 𝐊 𝐇 is not Hurwitz, and
/// where the eigenvalues can not be placed because the pair is too close to an unobservable one.
Eigen::MatrixXd high_gain(const Eigen::MatrixXd& A, const Eigen::MatrixXd& H,
                          const ObservableForm& form, double ell,
                          const std::vector<Eigen::VectorXd>& K);

/// ℓ 𝓛(ℓ) K with 𝓛(ℓ) = diag(1, ℓ, …, ℓ^(d−1)), for one output in the form of example 4.3.
/// @throws std::invalid_argument unless ℓ > 0 and K is Hurwitz as is_hurwitz() has it.
Eigen::VectorXd scaled_gain(double ell, const Eigen::VectorXd& K);

/// Whether all zeros of s^d + c_1 s^(d−1) + … + c_d lie in the open left half plane.
/// @pre d >= 1
bool is_hurwitz(const Eigen::VectorXd& c);

}  // namespace sampled_data_observers
