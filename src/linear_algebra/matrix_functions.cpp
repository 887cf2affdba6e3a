#include "linear_algebra/matrix_functions.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/MatrixFunctions>

namespace sampled_data_observers {

Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a) {
  if (!a.allFinite()) {
    return Eigen::VectorXd::Constant(a.rows(), std::numeric_limits<double>::quiet_NaN());
  }
  const Eigen::MatrixXd symmetric = (a + a.transpose()) / 2.0;
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

double min_eigenvalue(const Eigen::MatrixXd& a) { return symmetric_eigenvalues(a)(0); }

double max_eigenvalue(const Eigen::MatrixXd& a) { return symmetric_eigenvalues(a)(a.rows() - 1); }

double largest_generalized_eigenvalue(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const Eigen::LLT<Eigen::MatrixXd> root(b);
  const Eigen::MatrixXd half = root.matrixL().solve(a);
  return max_eigenvalue(root.matrixL().solve(half.transpose()));
}

Eigen::VectorXd least_eigenvector(const Eigen::MatrixXd& a) {
  const Eigen::MatrixXd symmetric = (a + a.transpose()) / 2.0;
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric).eigenvectors().col(0);
}

std::optional<Eigen::MatrixXd> diagonalizing_congruence(const Eigen::MatrixXd& a,
                                                        const Eigen::MatrixXd& b) {
  const Eigen::LLT<Eigen::MatrixXd> factor(a);
  if (!a.allFinite() || !b.allFinite() || factor.info() != Eigen::Success) return std::nullopt;
  const Eigen::MatrixXd half = factor.matrixL().solve(b);
  const Eigen::MatrixXd reduced = factor.matrixL().solve(half.transpose());
  const Eigen::MatrixXd rotation =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(reduced).eigenvectors();
  return factor.matrixU().solve(rotation);
}

Eigen::VectorXd singular_values(const Eigen::MatrixXd& a) {
  return Eigen::JacobiSVD<Eigen::MatrixXd>(a).singularValues();
}

double norm2(const Eigen::MatrixXd& a) { return a.size() == 0 ? 0.0 : singular_values(a)(0); }

Eigen::VectorXd balancing_of(const Eigen::MatrixXd& a) {
  constexpr int kMaxSweeps = 100;
  const Eigen::Index n = a.rows();
  Eigen::VectorXd D = Eigen::VectorXd::Ones(n);
  if (!a.allFinite()) return D;
  Eigen::MatrixXd sizes = a.cwiseAbs();
  sizes.diagonal().setZero();
  bool has_changed = true;
  for (int sweep = 0; has_changed && sweep < kMaxSweeps; ++sweep) {
    has_changed = false;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double row = sizes.row(i).sum();
      const double col = sizes.col(i).sum();
      double exponent = 0.0;
      if (row > 0.0 && col > 0.0) exponent = std::round(std::log2(row / col) / 2.0);
      // Of a triangular matrix, what may be made as small as one likes.
      if (row > 1.0 && col == 0.0) exponent = std::ceil(std::log2(row));
      if (col > 1.0 && row == 0.0) exponent = -std::ceil(std::log2(col));
      if (exponent == 0.0) continue;
      const double factor = std::exp2(exponent);
      D(i) *= factor;
      sizes.col(i) *= factor;
      sizes.row(i) /= factor;
      has_changed = true;
    }
  }
  return D;
}

Eigen::MatrixXd balanced_by(const Eigen::VectorXd& D, const Eigen::MatrixXd& a) {
  return D.cwiseInverse().asDiagonal() * a * D.asDiagonal();
}

Eigen::MatrixXd exponential_of(const Eigen::MatrixXd& a) {
  const Eigen::VectorXd D = balancing_of(a);
  return balanced_by(D.cwiseInverse(), balanced_by(D, a).exp());
}

Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& a) { return a.partialPivLu().inverse(); }

std::optional<Eigen::MatrixXd> inverse_where_regular(const Eigen::MatrixXd& a) {
  const Eigen::FullPivLU<Eigen::MatrixXd> decomposition(a);
  if (!decomposition.isInvertible()) return std::nullopt;
  return decomposition.inverse();
}

Eigen::MatrixXd solve_linear(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.partialPivLu().solve(b);
}

Eigen::MatrixXd solve_definite(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.llt().solve(b);
}

Eigen::MatrixXd cholesky_root(const Eigen::MatrixXd& a) {
  const Eigen::LLT<Eigen::MatrixXd> decomposition(a);
  if (decomposition.info() != Eigen::Success) {
    return Eigen::MatrixXd::Constant(a.rows(), a.cols(), std::numeric_limits<double>::quiet_NaN());
  }
  return decomposition.matrixU();
}

Eigen::Index rank_of(const Eigen::MatrixXd& a) {
  return Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(a).rank();
}

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& a) {
  return a.completeOrthogonalDecomposition().pseudoInverse();
}

Eigen::MatrixXd orthogonal_complement(const Eigen::MatrixXd& a) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(a);
  const Eigen::MatrixXd orthonormal =
      qr.householderQ() * Eigen::MatrixXd::Identity(a.rows(), a.rows());
  return orthonormal.rightCols(a.rows() - a.cols());
}

Eigen::VectorXcd eigenvalues_of(const Eigen::MatrixXd& a) {
  return Eigen::EigenSolver<Eigen::MatrixXd>(a, false).eigenvalues();
}

Eigen::MatrixXd null_space(const Eigen::MatrixXd& a) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeFullV);
  return svd.matrixV().rightCols(a.cols() - svd.rank());
}

Eigen::MatrixXd weakest_directions(const Eigen::MatrixXd& a, Eigen::Index count) {
  return Eigen::JacobiSVD<Eigen::MatrixXd>(a, Eigen::ComputeFullV).matrixV().rightCols(count);
}

}  // namespace sampled_data_observers
