#include "observer/metric_gain.h"

#include <algorithm>
#include <cmath>

#include "linear_algebra/matrix_functions.h"
#include "linear_algebra/ordered_linear_algebra.h"
#include "observer/gain_requirement.h"

namespace sampled_data_observers {

MetricGain::MetricGain(const Eigen::MatrixXd& A, const Eigen::MatrixXd& A_d,
                       const Eigen::MatrixXd& H, const Eigen::MatrixXd& P)
    : n_(A.rows()),
      m_(H.rows()),
      flow_(A, Eigen::MatrixXd(A.rows(), 0)),
      A_d_(A_d),
      H_(H),
      root_(inverse_of(cholesky_root(P))),
      at_zero_(n_, m_) {
  Eigen::VectorXd workspace(workspace_size());
  require_of_gains(evaluate_where_regular(0, at_zero_.data(), workspace.data()),
                   "the outputs at jumps must be linearly independent");
}

void MetricGain::evaluate(Duration tau, double* L, double* workspace) const {
  if (evaluate_where_regular(tau, L, workspace)) return;
  std::copy_n(at_zero_.data(), n_ * m_, L);
}

bool MetricGain::evaluate_where_regular(Duration tau, double* L, double* workspace) const {
  double* transition = transition_.of(workspace);
  double* moved = moved_.of(workspace);
  double* measured = measured_.of(workspace);
  double* basis = basis_.of(workspace);
  double* factor = factor_.of(workspace);
  double* gain = gain_.of(workspace);
  flow_.transition(tau, transition, scratch_.of(workspace));
  multiply(transition, n_, n_, root_.data(), n_, moved);
  multiply(H_.data(), m_, n_, moved, n_, measured);
  for (Eigen::Index i = 0; i < m_; ++i) {
    for (Eigen::Index j = 0; j < n_; ++j) basis[i * n_ + j] = measured[j * m_ + i];
  }
  // (H G)ᵀ = B Fᵀ with B orthonormal, so that G (H G)ᵀ (H G (H G)ᵀ)⁻¹ = G B F⁻¹.
  if (!factor_gram(basis, n_, m_, factor)) return false;
  for (Eigen::Index i = 0; i < n_; ++i) {
    for (Eigen::Index k = 0; k < m_; ++k) {
      double sum = 0.0;
      for (Eigen::Index j = 0; j < n_; ++j) sum += moved[j * n_ + i] * basis[k * n_ + j];
      gain[i * m_ + k] = sum;
    }
  }
  solve_lower_transposed(factor, m_, m_, gain, n_);
  multiply_by_transposed(A_d_.data(), n_, n_, gain, m_, L);
  return std::all_of(L, L + n_ * m_, [](double entry) { return std::isfinite(entry); });
}

}  // namespace sampled_data_observers
