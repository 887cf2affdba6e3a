#include "sampled_data_observers/design/detectability.h"

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <cmath>

#include "sampled_data_observers/certificate/matrix_functions.h"

namespace sampled_data_observers {
namespace {

constexpr double kTolerance = 1e-7;
/// Multiples of the shortest such time that are looked at.
constexpr double kMaxMultiples = 20.0;

/// Whether [A − z I; C] loses rank, in real form.
bool hides(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C, const std::complex<double>& z) {
  const Eigen::Index n = A.rows();
  const Eigen::Index m = C.rows();
  const double norm_C = norm2(C);
  const double norm = std::max(norm2(A), std::abs(z));
  if (norm_C == 0.0) return true;
  // Both parts in the same size.
  const double unit = norm > 0.0 ? norm : 1.0;
  Eigen::MatrixXd test = Eigen::MatrixXd::Zero(2 * (n + m), 2 * n);
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(n, n);
  test.topLeftCorner(n, n) = (A - z.real() * I) / unit;
  test.block(n, n, n, n) = (A - z.real() * I) / unit;
  test.block(0, n, n, n) = z.imag() / unit * I;
  test.block(n, 0, n, n) = -z.imag() / unit * I;
  test.block(2 * n, 0, m, n) = C / norm_C;
  test.block(2 * n + m, n, m, n) = C / norm_C;
  const Eigen::VectorXd sizes = singular_values(test);
  return sizes(sizes.size() - 1) <= kTolerance;
}

}  // namespace

std::optional<std::complex<double>> undetectable_eigenvalue(const Eigen::MatrixXd& A,
                                                            const Eigen::MatrixXd& C) {
  const Eigen::VectorXcd eigenvalues = eigenvalues_of(A);
  const double tolerance = kTolerance * norm2(A);
  for (Eigen::Index i = 0; i < eigenvalues.size(); ++i) {
    if (eigenvalues(i).real() >= -tolerance && hides(A, C, eigenvalues(i))) return eigenvalues(i);
  }
  return std::nullopt;
}

std::optional<double> undetectable_time(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C,
                                        double T1, double T2) {
  if (undetectable_eigenvalue(A, C)) return std::nullopt;
  const Eigen::VectorXcd eigenvalues = eigenvalues_of(A);
  const double tolerance = kTolerance * norm2(A);
  for (Eigen::Index i = 0; i < eigenvalues.size(); ++i) {
    for (Eigen::Index j = 0; j < eigenvalues.size(); ++j) {
      const std::complex<double> difference = eigenvalues(i) - eigenvalues(j);
      if (eigenvalues(i).real() < -tolerance || std::abs(difference.real()) > tolerance ||
          difference.imag() <= tolerance) {
        continue;
      }
      const double shortest = boost::math::constants::two_pi<double>() / difference.imag();
      const double first = std::ceil(T1 / shortest);
      for (double k = first; k < first + kMaxMultiples && k * shortest <= T2; k += 1.0) {
        const double tau = k * shortest;
        if (hides(exponential_of(A * tau), C, std::exp(eigenvalues(i) * tau))) return tau;
      }
    }
  }
  return std::nullopt;
}

}  // namespace sampled_data_observers
