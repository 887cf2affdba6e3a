#pragma once

#include <optional>
#include <vector>

#include "certificate/matrix_expression.h"
#include "certificate/numeric_algebra.h"
#include "design/ball_matrix.h"

namespace sampled_data_observers {

/// A matrix that depends on τ = τ_c + h, enclosed over an interval |h| <= r by a polynomial in h
/// with balls as coefficients: for each h it is Σ F_k h^k with some F_k in the coefficients. The
/// constant one is as narrow as rounding allows: it encloses the matrix at τ_c.
///
/// Ball arithmetic on the interval itself would forget that all entries depend on the same τ, and
/// its matrix exponential grows with e^{|A| r} whatever e^{A τ} does. In the polynomial the
/// dependence is kept to the order of its degree.
struct TaylorMatrix {
  /// From the constant one on.
  std::vector<BallMatrix> coefficients;

  /// Where the matrix is known to be f(h) M, with a scalar f and a constant M: what its exponential
  /// needs, since e^{(a + b) M} = e^{a M} e^{b M}.
  struct Factors {
    std::vector<BallMatrix> f;
    BallMatrix M;
  };
  std::optional<Factors> factors;

  bool is_constant() const { return coefficients.size() == 1; }
};

/// An algebra for ExpressionEvaluator: what is proved of its result is true of the expression for
/// all τ of the interval, and for all values of which those given are the nearest doubles (see
/// set_nearest()).
class TaylorAlgebra {
 public:
  using Matrix = TaylorMatrix;

  /// @param values     of all symbols; must outlive the algebra
  /// @param centre     τ_c, exactly
  /// @param radius     r >= 0
  /// @param precision  bits
  TaylorAlgebra(const NamedMatrices& values, double centre, double radius, slong precision,
                RoundedNumbers rounded = RoundedNumbers::kNotWhole);

  Matrix constant(const Eigen::MatrixXd& value) const;
  Matrix symbol(const MatrixExpression::Node& node) const;
  Matrix square(const MatrixExpression::Node& node) const;
  Matrix time() const;
  Matrix sum(const Matrix& a, const Matrix& b) const;
  Matrix product(const Matrix& a, const Matrix& b) const;
  Matrix scaled(const Matrix& scalar, const Matrix& a) const;
  Matrix transpose(const Matrix& a) const;
  Matrix blocks(const MatrixExpression::Node& node,
                const std::vector<const Matrix*>& operands) const;
  Matrix inverse(const Matrix& a) const;
  Matrix exponential(const Matrix& a) const;

  /// Balls that hold the matrix for all |h| <= r.
  BallMatrix range(const std::vector<BallMatrix>& coefficients) const;

 private:
  using Coefficients = std::vector<BallMatrix>;

  static constexpr std::size_t kDegree = 4;

  /// Adds term h^power; powers beyond the degree go to the last coefficient.
  void add_term(Coefficients& coefficients, std::size_t power, const BallMatrix& term) const;
  template <class Product>
  Coefficients multiply(const Coefficients& a, const Coefficients& b, const Product& product) const;
  Coefficients scale(const Coefficients& scalar, const Coefficients& a) const;
  Coefficients exponential_of_sum(const Coefficients& X) const;
  Coefficients exponential_of_product(const Coefficients& f, const BallMatrix& M) const;

  const NamedMatrices& values_;
  double centre_;
  slong precision_;
  RoundedNumbers rounded_;
  bool is_point_;
  /// [−r, r]^k, for even k without the negative numbers.
  std::vector<Ball> powers_;
};

}  // namespace sampled_data_observers
