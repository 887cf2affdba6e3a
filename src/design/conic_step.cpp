#include "design/conic_step.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace sampled_data_observers {
namespace {

/// Whether a tridiagonal matrix is definite after `shift` was taken from its diagonal.
/// @param squares  of what is beside the diagonal
bool is_definite(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& squares, double shift) {
  double pivot = diagonal(0) - shift;
  for (Eigen::Index i = 1; pivot > 0.0 && i < diagonal.size(); ++i) {
    pivot = diagonal(i) - shift - squares(i - 1) / pivot;
  }
  return pivot > 0.0;
}

}  // namespace

bool lower_factor(const Eigen::MatrixXd& S, Eigen::MatrixXd& L) {
  if (S.rows() == 1) {
    L = S.cwiseSqrt();
    return S(0, 0) > 0.0;
  }
  L = S;
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> cholesky(L);
  if (cholesky.info() != Eigen::Success || !L.diagonal().allFinite()) return false;
  L.triangularView<Eigen::StrictlyUpper>().setZero();
  return true;
}

Eigen::MatrixXd inverse_from_factor(const Eigen::MatrixXd& L) {
  const Eigen::Index n = L.rows();
  if (n == 1) return Eigen::MatrixXd::Constant(1, 1, 1.0 / (L(0, 0) * L(0, 0)));
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(n, n);
  L.triangularView<Eigen::Lower>().solveInPlace(inverse);
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(n, n);
  product.selfadjointView<Eigen::Lower>().rankUpdate(inverse.transpose());
  product.triangularView<Eigen::StrictlyUpper>() = product.transpose();
  return product;
}

double largest_step(const Eigen::MatrixXd& L, const Eigen::MatrixXd& step) {
  if (L.rows() == 1) {
    const double eigenvalue = step(0, 0) / (L(0, 0) * L(0, 0));
    return eigenvalue < -1.0 / kLongStep ? -1.0 / eigenvalue : kLongStep;
  }
  Eigen::MatrixXd relative = L.triangularView<Eigen::Lower>().solve(step);
  L.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(relative);
  if (!relative.allFinite()) return 0.0;
  const Eigen::Tridiagonalization<Eigen::MatrixXd> similar(relative);
  const Eigen::VectorXd diagonal = similar.diagonal();
  const Eigen::VectorXd squares = similar.subDiagonal().cwiseAbs2();
  double impossible = kLongStep;
  if (is_definite(diagonal, squares, -1.0 / impossible)) return impossible;
  const double radius =
      diagonal.cwiseAbs().maxCoeff() + 2.0 * similar.subDiagonal().cwiseAbs().maxCoeff();
  double possible = std::min(impossible, 1.0 / radius);
  while (impossible > 1.01 * possible) {
    const double middle = std::sqrt(possible * impossible);
    (is_definite(diagonal, squares, -1.0 / middle) ? possible : impossible) = middle;
  }
  return possible;
}

}  // namespace sampled_data_observers
