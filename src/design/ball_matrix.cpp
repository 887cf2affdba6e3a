#include "design/ball_matrix.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sampled_data_observers {

void set_nearest(arb_ptr ball, double value, RoundedNumbers rounded) {
  arb_set_d(ball, value);
  const bool is_exact =
      value == 0.0 || (rounded == RoundedNumbers::kNotWhole && value == std::trunc(value));
  if (!std::isfinite(value) || is_exact) return;
  // Half the distance to the next double.
  constexpr int kDigits = std::numeric_limits<double>::digits;
  constexpr int kLeast = std::numeric_limits<double>::min_exponent - kDigits - 1;
  int exponent = 0;
  std::frexp(value, &exponent);
  arb_add_error_2exp_si(ball, std::max(exponent - kDigits - 1, kLeast));
}

BallMatrix nearest_balls(const Eigen::MatrixXd& values, RoundedNumbers rounded) {
  BallMatrix balls(values.rows(), values.cols());
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    for (Eigen::Index j = 0; j < values.cols(); ++j) {
      set_nearest(balls.entry(i, j), values(i, j), rounded);
    }
  }
  return balls;
}

BallMatrix exact_balls(const Eigen::MatrixXd& values) {
  BallMatrix balls(values.rows(), values.cols());
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    for (Eigen::Index j = 0; j < values.cols(); ++j) arb_set_d(balls.entry(i, j), values(i, j));
  }
  return balls;
}

Eigen::MatrixXd midpoints(const BallMatrix& a) {
  Eigen::MatrixXd result(a.rows(), a.cols());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    for (Eigen::Index j = 0; j < a.cols(); ++j) {
      result(i, j) = arf_get_d(arb_midref(a.entry(i, j)), ARF_RND_NEAR);
    }
  }
  return result;
}

BallMatrix sum(const BallMatrix& a, const BallMatrix& b, slong precision) {
  BallMatrix result(a.rows(), a.cols());
  arb_mat_add(result.get(), a.get(), b.get(), precision);
  return result;
}

BallMatrix product(const BallMatrix& a, const BallMatrix& b, slong precision) {
  BallMatrix result(a.rows(), b.cols());
  arb_mat_mul(result.get(), a.get(), b.get(), precision);
  return result;
}

BallMatrix scaled(arb_srcptr scalar, const BallMatrix& a, slong precision) {
  BallMatrix result(a.rows(), a.cols());
  arb_mat_scalar_mul_arb(result.get(), a.get(), scalar, precision);
  return result;
}

BallMatrix transpose(const BallMatrix& a) {
  BallMatrix result(a.cols(), a.rows());
  arb_mat_transpose(result.get(), a.get());
  return result;
}

BallMatrix inverse(const BallMatrix& a, slong precision) {
  BallMatrix result(a.rows(), a.cols());
  if (arb_mat_inv(result.get(), a.get(), precision) == 0) {
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      for (Eigen::Index j = 0; j < a.cols(); ++j) arb_indeterminate(result.entry(i, j));
    }
  }
  return result;
}

BallMatrix exponential(const BallMatrix& a, slong precision) {
  BallMatrix result(a.rows(), a.cols());
  arb_mat_exp(result.get(), a.get(), precision);
  return result;
}

Ball norm_bound(const BallMatrix& a) {
  Ball result;
  mag_t bound;
  mag_init(bound);
  arb_mat_bound_inf_norm(bound, a.get());
  arf_set_mag(arb_midref(result.get()), bound);
  mag_clear(bound);
  return result;
}

bool is_positive_definite(const BallMatrix& a, slong precision) {
  BallMatrix factor(a.rows(), a.cols());
  return arb_mat_cho(factor.get(), a.get(), precision) != 0;
}

}  // namespace sampled_data_observers
