#include "observer/time_varying_gain.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "linear_algebra/matrix_functions.h"
#include "linear_algebra/ordered_linear_algebra.h"

namespace sampled_data_observers {
namespace {

/// M22 is a difference, singular at τ = 0: below this share of P its pivots are rounding.
constexpr double kDifferenceTolerance = 1e-10;

/// Whether e^{−Aτ} still tells the error after the sample before from rounding.
bool is_moderate(const double* backward, Eigen::Index size) {
  const double limit = std::ldexp(1.0, 52);
  for (Eigen::Index i = 0; i < size; ++i) {
    if (!(std::abs(backward[i]) <= limit)) return false;
  }
  return true;
}

Eigen::Index number_of_independent_rows(const Eigen::MatrixXd& C) {
  if (rank_of(C.transpose()) < C.rows()) {
    throw std::invalid_argument("the rows of C must be linearly independent");
  }
  return C.rows();
}

}  // namespace

InverseOutputGain::InverseOutputGain(const Eigen::MatrixXd& C, double lambda) : lambda_(lambda) {
  if (C.rows() != C.cols()) throw std::invalid_argument("C must be square where there is no P");
  const std::optional<Eigen::MatrixXd> inverse = inverse_where_regular(C);
  if (!inverse) throw std::invalid_argument("C must be invertible where there is no P");
  inverse_ = *inverse;
}

void InverseOutputGain::evaluate(const double* backward, double* K, double* workspace) const {
  static_cast<void>(workspace);
  const Eigen::Index n = inverse_.rows();
  if (lambda_ == 0.0 || !is_moderate(backward, n * n)) {
    std::copy_n(inverse_.data(), n * n, K);
    return;
  }
  multiply(backward, n, n, inverse_.data(), n, K);
  for (Eigen::Index i = 0; i < n * n; ++i) K[i] = inverse_.data()[i] - lambda_ * K[i];
}

CertificateGain::CertificateGain(const Eigen::MatrixXd& C, const Eigen::MatrixXd& P, double lambda)
    : n_(C.cols()),
      m_(number_of_independent_rows(C)),
      q_(n_ - m_),
      lambda_(lambda),
      P_(P),
      L_(P),
      basis_(n_, n_),
      K_at_zero_(n_, m_) {
  factor_cholesky(L_.data(), n_);
  L_transposed_ = L_.transpose();
  basis_.leftCols(q_) = orthogonal_complement(C.transpose());
  basis_.rightCols(m_) = C.transpose();
  P_complement_ = (P * basis_.leftCols(q_)).transpose();
  gram_inverse_ = inverse_of(C * C.transpose());

  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(n_, n_);
  Eigen::VectorXd workspace(workspace_size());
  Eigen::MatrixXd K(n_, m_);
  evaluate(identity.data(), K.data(), workspace.data());
  K_at_zero_ = K;
}

void CertificateGain::evaluate(const double* backward, double* K, double* workspace) const {
  double* root = root_.of(workspace);
  double* rotated = rotated_.of(workspace);
  double* factor = factor_.of(workspace);
  multiply(L_transposed_.data(), n_, n_, backward, n_, root);
  multiply(root, n_, n_, basis_.data(), n_, rotated);
  if (!factor_gram(rotated, n_, n_, factor)) {
    std::copy_n(K_at_zero_.data(), n_ * m_, K);
    return;
  }
  double* solved = solved_.of(workspace);
  for (Eigen::Index j = 0; j < m_; ++j) {
    for (Eigen::Index i = 0; i < q_; ++i) solved[j * q_ + i] = -factor[i * n_ + q_ + j];
  }
  solve_lower_transposed(factor, n_, q_, solved, m_);
  double* K_CCt = K_CCt_.of(workspace);
  std::copy_n(basis_.data() + n_ * q_, n_ * m_, K_CCt);
  for (Eigen::Index j = 0; j < m_; ++j) {
    add_product(basis_.data(), n_, q_, solved + j * q_, K_CCt + j * n_);
  }
  if (lambda_ > 0.0 && is_moderate(backward, n_ * n_)) subtract_kept_part(workspace);
  multiply(K_CCt, n_, m_, gram_inverse_.data(), m_, K);
}

void CertificateGain::subtract_kept_part(double* workspace) const {
  const double* factor = factor_.of(workspace);
  double* M22 = M22_.of(workspace);
  double* Y = Y_.of(workspace);
  double* L11 = L11_.of(workspace);
  double* M21 = M21_.of(workspace);
  double* K_CCt = K_CCt_.of(workspace);
  std::copy_n(P_complement_.data(), q_ * n_, Y);
  solve_lower(factor, n_, q_, Y, n_);
  for (Eigen::Index j = 0; j < n_; ++j) {
    for (Eigen::Index i = 0; i < n_; ++i) {
      M22[j * n_ + i] = P_(i, j) - dot(Y + i * q_, Y + j * q_, q_);
    }
  }
  for (Eigen::Index i = 0; i < n_; ++i) {
    if (!(M22[i * n_ + i] > kDifferenceTolerance * P_(i, i))) return;
  }
  if (!factor_cholesky(M22, n_, kDifferenceTolerance)) return;
  for (Eigen::Index j = 0; j < m_; ++j) {
    for (Eigen::Index i = 0; i < m_; ++i) {
      L11[j * m_ + i] = lambda_ * factor[(q_ + j) * n_ + q_ + i];
    }
  }
  multiply_by_transposed(M22, n_, m_, L11, m_, M21);
  solve_lower(L_.data(), n_, n_, M21, m_);
  solve_lower_transposed(L_.data(), n_, n_, M21, m_);
  for (Eigen::Index i = 0; i < n_ * m_; ++i) K_CCt[i] -= M21[i];
}

}  // namespace sampled_data_observers
