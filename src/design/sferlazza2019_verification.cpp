#include "design/sferlazza2019_verification.h"

#include <algorithm>
#include <cmath>

#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

constexpr std::size_t kMaxVerificationSteps = 50000;
/// Of each step, so that rounding does not make it too long.
constexpr double kCaution = 0.9;

}  // namespace

IntervalVerification verify_between(const Eigen::MatrixXd& A, const Eigen::MatrixXd& complement,
                                    const Eigen::MatrixXd& P, double T1, double T2) {
  IntervalVerification result;
  const Eigen::MatrixXd R = cholesky_root(P);  // P = Rᵀ R
  if (!R.allFinite()) {
    result.stopped_at = T1;
    return result;
  }
  if (complement.cols() == 0) {
    result.holds = true;
    return result;
  }
  // In the coordinates R x: Ψ falls no faster than by the largest eigenvalue of the symmetric part.
  const double beta = std::max(0.0, max_eigenvalue(R * A * inverse_of(R)));
  const Eigen::MatrixXd weighed = R * complement;
  const Eigen::MatrixXd inverse_root = inverse_of(cholesky_root(weighed.transpose() * weighed));
  double tau = T1;
  for (; result.steps < kMaxVerificationSteps; ++result.steps) {
    const Eigen::MatrixXd back = R * exponential_of(-A * tau) * complement * inverse_root;
    const double ratio = min_eigenvalue(back.transpose() * back);
    if (!(ratio > 1.0)) break;
    if (beta == 0.0) {
      result.holds = true;
      return result;
    }
    tau += kCaution * std::log(ratio) / (2.0 * beta);
    if (tau >= T2) {
      result.holds = true;
      return result;
    }
  }
  result.stopped_at = tau;
  return result;
}

}  // namespace sampled_data_observers
