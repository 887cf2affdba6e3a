#include "plant/covariance_flow.h"

#include <cmath>
#include <stdexcept>

#include "linear_algebra/digit_tables.h"
#include "linear_algebra/ordered_linear_algebra.h"
#include "linear_algebra/transition_matrix.h"

namespace sampled_data_observers {
namespace {

/// Φ and Q_Δ of one duration.
struct CovarianceStep {
  Transition transition;
  ExtendedMatrix noise;

  bool is_finite() const { return transition.is_finite() && noise.allFinite(); }
  void write(double* table) const {
    const Eigen::Index n = noise.rows();
    Eigen::Map<Eigen::MatrixXd>(table, n, n) = transition.full.cast<double>();
    Eigen::Map<Eigen::MatrixXd>(table + n * n, n, n) = noise.cast<double>();
  }
};

CovarianceStep compose(const CovarianceStep& first, const CovarianceStep& second) {
  const ExtendedMatrix& Phi = second.transition.full;
  const ExtendedMatrix noise = Phi * first.noise * Phi.transpose() + second.noise;
  return {compose(first.transition, second.transition), (noise + noise.transpose()) / 2.0L};
}

/// The step over one unit of the time in which A and Q are given.
CovarianceStep unit_step(const ExtendedMatrix& A, const ExtendedMatrix& Q) {
  // Q_h is the sum of D^k(Q) h^{k+1} / (k + 1)! with D(X) = A X + X Aᵀ: at |A| h <= 1/4 the
  // remainder after 20 terms is below 1e-25, relative to Q h.
  constexpr int kTerms = 20;
  const int doublings = doublings_for(A);
  const long double h = std::ldexp(1.0L, -doublings);
  ExtendedMatrix term = Q * h;
  ExtendedMatrix sum = term;
  for (int k = 2; k <= kTerms; ++k) {
    term = ((A * term + term * A.transpose()) * (h / static_cast<long double>(k))).eval();
    sum += term;
  }
  CovarianceStep result{exponential(A * h), sum};
  for (int i = 0; i < doublings && result.is_finite(); ++i) result = compose(result, result);
  return result;
}

}  // namespace

CovarianceFlow::CovarianceFlow(const Eigen::MatrixXd& A, const Eigen::MatrixXd& Q)
    : states_(A.rows()) {
  if (A.rows() == 0 || A.rows() != A.cols()) {
    throw std::invalid_argument("CovarianceFlow: A must be square and not empty");
  }
  if (Q.rows() != A.rows() || Q.cols() != A.cols()) {
    throw std::invalid_argument("CovarianceFlow: Q must have the size of A");
  }
  if (!A.allFinite() || !Q.allFinite()) {
    throw std::invalid_argument("CovarianceFlow: A and Q must be finite");
  }
  const ExtendedMatrix zero = ExtendedMatrix::Zero(states_, states_);
  const auto unit = [&](long double scale) {
    const long double seconds = 1e-9L * scale;
    return unit_step(A.cast<long double>() * seconds, Q.cast<long double>() * seconds);
  };
  tables_ = digit_tables(block(), CovarianceStep{Transition(zero), zero}, unit);
}

void CovarianceFlow::apply(Duration duration, double* P, double* scratch) const {
  const Eigen::Index entries = states_ * states_;
  for_each_digit(duration, tables_, block(), [&](const double* Phi) {
    const double* noise = Phi + entries;
    multiply(Phi, states_, states_, P, states_, scratch);
    for (Eigen::Index i = 0; i < entries; ++i) P[i] = noise[i];
    add_symmetric_product(scratch, Phi, states_, states_, P);
  });
}

}  // namespace sampled_data_observers
