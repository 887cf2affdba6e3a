#include "design/taylor_matrix.h"

#include <algorithm>
#include <utility>

namespace sampled_data_observers {
namespace {

BallMatrix identity_balls(Eigen::Index n) { return exact_balls(Eigen::MatrixXd::Identity(n, n)); }

/// Widens all entries by the largest number in `error`.
void add_error(BallMatrix& a, const Ball& error) {
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    for (Eigen::Index j = 0; j < a.cols(); ++j) arb_add_error(a.entry(i, j), error.get());
  }
}

/// 1/k!
Ball inverse_factorial(std::size_t k, slong precision) {
  Ball result;
  arb_fac_ui(result.get(), k, precision);
  arb_inv(result.get(), result.get(), precision);
  return result;
}

}  // namespace

TaylorAlgebra::TaylorAlgebra(const NamedMatrices& values, double centre, double radius,
                             slong precision, RoundedNumbers rounded)
    : values_(values),
      centre_(centre),
      precision_(precision),
      rounded_(rounded),
      is_point_(radius == 0.0) {
  Ball r;
  arb_set_d(r.get(), radius);
  // Two polynomials of the degree multiplied, and those of exponentials.
  for (std::size_t k = 0; k <= 2 * kDegree; ++k) {
    Ball power;
    arb_pow_ui(power.get(), r.get(), k, precision);
    if (k > 0) {
      Ball lowest;
      if (k % 2 == 1) arb_neg(lowest.get(), power.get());
      arb_union(power.get(), lowest.get(), power.get(), precision);
    }
    powers_.push_back(std::move(power));
  }
}

void TaylorAlgebra::add_term(Coefficients& coefficients, std::size_t power,
                             const BallMatrix& term) const {
  const std::size_t at = std::min(power, kDegree);
  while (coefficients.size() <= at) coefficients.emplace_back(term.rows(), term.cols());
  BallMatrix& sum = coefficients[at];
  if (power == at) {
    arb_mat_add(sum.get(), sum.get(), term.get(), precision_);
  } else {
    arb_mat_scalar_addmul_arb(sum.get(), term.get(), powers_[power - at].get(), precision_);
  }
}

template <class Product>
TaylorAlgebra::Coefficients TaylorAlgebra::multiply(const Coefficients& a, const Coefficients& b,
                                                    const Product& product) const {
  Coefficients result;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) add_term(result, i + j, product(a[i], b[j]));
  }
  return result;
}

TaylorAlgebra::Coefficients TaylorAlgebra::scale(const Coefficients& scalar,
                                                 const Coefficients& a) const {
  return multiply(scalar, a, [this](const BallMatrix& s, const BallMatrix& x) {
    return sampled_data_observers::scaled(s.entry(0, 0), x, precision_);
  });
}

TaylorMatrix TaylorAlgebra::constant(const Eigen::MatrixXd& value) const {
  return {{nearest_balls(value, rounded_)}, std::nullopt};
}

TaylorMatrix TaylorAlgebra::symbol(const MatrixExpression::Node& node) const {
  return constant(value_of(node, values_));
}

TaylorMatrix TaylorAlgebra::square(const MatrixExpression::Node& node) const {
  const Matrix root = symbol(node);
  return product(root, root);
}

TaylorMatrix TaylorAlgebra::time() const {
  Matrix tau{{exact_balls(scalar_matrix(centre_))}, std::nullopt};
  if (!is_point_) tau.coefficients.push_back(identity_balls(1));
  return tau;
}

TaylorMatrix TaylorAlgebra::sum(const Matrix& a, const Matrix& b) const {
  Matrix result{a.coefficients, std::nullopt};
  for (std::size_t k = 0; k < b.coefficients.size(); ++k) {
    add_term(result.coefficients, k, b.coefficients[k]);
  }
  return result;
}

TaylorMatrix TaylorAlgebra::product(const Matrix& a, const Matrix& b) const {
  return {multiply(a.coefficients, b.coefficients,
                   [this](const BallMatrix& x, const BallMatrix& y) {
                     return sampled_data_observers::product(x, y, precision_);
                   }),
          std::nullopt};
}

TaylorMatrix TaylorAlgebra::scaled(const Matrix& scalar, const Matrix& a) const {
  Matrix result{scale(scalar.coefficients, a.coefficients), std::nullopt};
  if (a.factors) {
    result.factors = Matrix::Factors{scale(scalar.coefficients, a.factors->f), a.factors->M};
  } else if (a.is_constant()) {
    result.factors = Matrix::Factors{scalar.coefficients, a.coefficients.front()};
  }
  return result;
}

TaylorMatrix TaylorAlgebra::transpose(const Matrix& a) const {
  Matrix result;
  for (const BallMatrix& coefficient : a.coefficients) {
    result.coefficients.push_back(sampled_data_observers::transpose(coefficient));
  }
  if (a.factors) {
    result.factors = Matrix::Factors{a.factors->f, sampled_data_observers::transpose(a.factors->M)};
  }
  return result;
}

TaylorMatrix TaylorAlgebra::blocks(const MatrixExpression::Node& node,
                                   const std::vector<const Matrix*>& operands) const {
  Matrix whole;
  whole.coefficients.emplace_back(node.rows, node.cols);
  const std::size_t columns = operands.size() / node.block_rows;
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < node.block_rows; ++i) {
    Eigen::Index col = 0;
    for (std::size_t j = 0; j < columns; ++j) {
      const Coefficients& block = operands[i * columns + j]->coefficients;
      while (whole.coefficients.size() < block.size()) {
        whole.coefficients.emplace_back(node.rows, node.cols);
      }
      for (std::size_t k = 0; k < block.size(); ++k) {
        for (Eigen::Index r = 0; r < block[k].rows(); ++r) {
          for (Eigen::Index c = 0; c < block[k].cols(); ++c) {
            arb_set(whole.coefficients[k].entry(row + r, col + c), block[k].entry(r, c));
          }
        }
      }
      col += block.front().cols();
    }
    row += operands[i * columns]->coefficients.front().rows();
  }
  return whole;
}

TaylorMatrix TaylorAlgebra::inverse(const Matrix& a) const {
  const Coefficients& X = a.coefficients;
  Matrix result{{sampled_data_observers::inverse(X.front(), precision_)}, std::nullopt};
  if (a.is_constant()) return result;
  Coefficients& Y = result.coefficients;
  // Coefficient k of X Y vanishes, up to k = degree − 1 …
  const auto coefficient_of_product = [&](std::size_t k) {
    BallMatrix total(X.front().rows(), X.front().cols());
    for (std::size_t j = 1; j < X.size() && j <= k; ++j) {
      if (k - j >= std::min(Y.size(), kDegree)) continue;
      total = sampled_data_observers::sum(
          total, sampled_data_observers::product(X[j], Y[k - j], precision_), precision_);
    }
    return total;
  };
  const auto negated_product = [this](const BallMatrix& x, const BallMatrix& y) {
    BallMatrix result = sampled_data_observers::product(x, y, precision_);
    arb_mat_neg(result.get(), result.get());
    return result;
  };
  for (std::size_t k = 1; k < kDegree; ++k) {
    Y.push_back(negated_product(Y.front(), coefficient_of_product(k)));
  }
  // … so that X Y = I + h^degree R, and X⁻¹ = Y − h^degree X⁻¹ R.
  BallMatrix R(X.front().rows(), X.front().cols());
  for (std::size_t k = kDegree; k < kDegree + X.size() - 1; ++k) {
    arb_mat_scalar_addmul_arb(R.get(), coefficient_of_product(k).get(), powers_[k - kDegree].get(),
                              precision_);
  }
  Y.push_back(negated_product(sampled_data_observers::inverse(range(X), precision_), R));
  return result;
}

TaylorMatrix TaylorAlgebra::exponential(const Matrix& a) const {
  if (a.is_constant()) {
    return {{sampled_data_observers::exponential(a.coefficients.front(), precision_)},
            std::nullopt};
  }
  if (a.factors) return {exponential_of_product(a.factors->f, a.factors->M), std::nullopt};
  if (a.coefficients.front().rows() == 1) {
    return {exponential_of_product(a.coefficients, identity_balls(1)), std::nullopt};
  }
  return {exponential_of_sum(a.coefficients), std::nullopt};
}

/// For X = X_0 + h G: ‖e^X − e^{X_0}‖ <= |h| ‖G‖ e^{‖X_0‖ + |h| ‖G‖}.
TaylorAlgebra::Coefficients TaylorAlgebra::exponential_of_sum(const Coefficients& X) const {
  const Coefficients slope(X.begin() + 1, X.end());
  const Ball norm = norm_bound(range(slope));
  Ball bound;
  arb_mul(bound.get(), powers_[1].get(), norm.get(), precision_);
  arb_add(bound.get(), bound.get(), norm_bound(X.front()).get(), precision_);
  arb_exp(bound.get(), bound.get(), precision_);
  arb_mul(bound.get(), bound.get(), norm.get(), precision_);
  BallMatrix rest(X.front().rows(), X.front().cols());
  add_error(rest, bound);
  return {sampled_data_observers::exponential(X.front(), precision_), std::move(rest)};
}

/// e^{f M} = e^{f_0 M} e^{g M}, with g = f − f_0 = h g̃ and
/// e^{g M} = Σ_{k<d} g^k M^k / k! + h^d g̃^d M^d φ, where φ = Σ_j (g M)^j / (j + d)! differs from
/// I / d! by a matrix of norm <= (e^{|g| ‖M‖} − 1) / (d + 1)!, since d! j! / (j + d)! <= 1 / (d +
/// 1) for j >= 1.
TaylorAlgebra::Coefficients TaylorAlgebra::exponential_of_product(const Coefficients& f,
                                                                  const BallMatrix& M) const {
  const Eigen::Index n = M.rows();
  const Coefficients slope(f.begin() + 1, f.end());
  Coefficients g = {BallMatrix(1, 1)};
  g.insert(g.end(), slope.begin(), slope.end());

  Coefficients series = {identity_balls(n)};
  Coefficients power_of_g = {identity_balls(1)};
  BallMatrix power_of_M = identity_balls(n);
  for (std::size_t k = 1; k < kDegree; ++k) {
    power_of_g = scale(power_of_g, g);
    power_of_M = sampled_data_observers::product(power_of_M, M, precision_);
    const BallMatrix term = sampled_data_observers::scaled(inverse_factorial(k, precision_).get(),
                                                           power_of_M, precision_);
    for (std::size_t j = 0; j < power_of_g.size(); ++j) {
      add_term(series, j,
               sampled_data_observers::scaled(power_of_g[j].entry(0, 0), term, precision_));
    }
  }
  power_of_M = sampled_data_observers::product(power_of_M, M, precision_);

  Ball distance;
  arb_abs(distance.get(), range(g).entry(0, 0));
  arb_mul(distance.get(), distance.get(), norm_bound(M).get(), precision_);
  arb_expm1(distance.get(), distance.get(), precision_);
  arb_mul(distance.get(), distance.get(), inverse_factorial(kDegree + 1, precision_).get(),
          precision_);
  BallMatrix phi = sampled_data_observers::scaled(inverse_factorial(kDegree, precision_).get(),
                                                  identity_balls(n), precision_);
  add_error(phi, distance);
  Ball slope_power;
  arb_pow_ui(slope_power.get(), range(slope).entry(0, 0), kDegree, precision_);
  add_term(series, kDegree,
           sampled_data_observers::scaled(
               slope_power.get(), sampled_data_observers::product(power_of_M, phi, precision_),
               precision_));

  const BallMatrix at_centre = sampled_data_observers::exponential(
      sampled_data_observers::scaled(f.front().entry(0, 0), M, precision_), precision_);
  for (BallMatrix& coefficient : series) {
    coefficient = sampled_data_observers::product(at_centre, coefficient, precision_);
  }
  return series;
}

BallMatrix TaylorAlgebra::range(const Coefficients& coefficients) const {
  BallMatrix result = coefficients.front();
  for (std::size_t k = 1; k < coefficients.size(); ++k) {
    arb_mat_scalar_addmul_arb(result.get(), coefficients[k].get(), powers_[k].get(), precision_);
  }
  return result;
}

}  // namespace sampled_data_observers
