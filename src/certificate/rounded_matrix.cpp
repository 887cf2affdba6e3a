#include "certificate/rounded_matrix.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "certificate/evaluate_expression.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

using Eigen::MatrixXd;

constexpr double kUnitRounding = std::numeric_limits<double>::epsilon();

MatrixXd unknown(const MatrixXd& a) {
  return MatrixXd::Constant(a.rows(), a.cols(), std::numeric_limits<double>::infinity());
}

/// Numbers as they are read: each may stand for all that round to it, but for whole ones.
RoundedMatrix nearest(const MatrixXd& value) {
  return {value, value.unaryExpr([](double entry) {
            return entry == std::trunc(entry) ? 0.0 : std::abs(entry);
          })};
}

/// The value of a product and its error.
RoundedMatrix product_at_centre(const RoundedMatrix& a, const RoundedMatrix& b) {
  const MatrixXd size_a = a.value.cwiseAbs();
  const MatrixXd size_b = b.value.cwiseAbs();
  const auto terms = static_cast<double>(a.value.cols());
  return {a.value * b.value, size_a * b.error + a.error * size_b +
                                 kUnitRounding * (a.error * b.error) + terms * (size_a * size_b)};
}

/// Powers of two d with which d_i a_ii d_i is about 1 in absolute value, where it is not zero.
Eigen::VectorXd units_of_diagonal(const MatrixXd& a) {
  return a.diagonal().unaryExpr([](double entry) {
    const bool is_usable = std::isfinite(entry) && entry != 0.0;
    return is_usable ? std::ldexp(1.0, -std::ilogb(entry) / 2) : 1.0;
  });
}

/// From the residual R of A X = I + R: A⁻¹ = X (I + R)⁻¹. In units in which the diagonal is about
/// 1, to which changing is exact: R depends on units.
RoundedMatrix inverse_at_centre(const RoundedMatrix& in_any_units) {
  const Eigen::VectorXd d = units_of_diagonal(in_any_units.value);
  const auto scaled = [&d](const MatrixXd& matrix) {
    return MatrixXd(d.asDiagonal() * matrix * d.asDiagonal());
  };
  const RoundedMatrix a{scaled(in_any_units.value), scaled(in_any_units.error)};
  const Eigen::Index n = a.value.rows();
  const MatrixXd X = inverse_of(a.value);
  const MatrixXd size = X.cwiseAbs();
  const MatrixXd R = (a.value * X - MatrixXd::Identity(n, n)).cwiseAbs() / kUnitRounding +
                     (static_cast<double>(n) * a.value.cwiseAbs() + a.error) * size;
  const double norm_of_R = R.colwise().sum().maxCoeff();
  if (!(kUnitRounding * norm_of_R < 0.5)) return {scaled(X), unknown(X)};
  // |R|² + |R|³ + …, of which no entry is larger than the norm.
  const double further = kUnitRounding * norm_of_R * norm_of_R / (1.0 - kUnitRounding * norm_of_R);
  return {scaled(X), scaled(size * (R + MatrixXd::Constant(n, n, further)))};
}

/// By scaling and squaring, with the error of each step: of a part whose exponential is small it
/// shrinks with it. Where the scaled matrix is X, the error of its exponential by Padé's formula is
/// a small multiple of n ε e^{|X|}, entry by entry. Balanced, which is exact, it does not depend on
/// units.
RoundedMatrix exponential_at_centre(const RoundedMatrix& a) {
  if (!a.value.allFinite() || !a.error.allFinite()) return {unknown(a.value), unknown(a.value)};
  constexpr double kPadeSteps = 8.0;
  const Eigen::VectorXd D = balancing_of(a.value);
  const MatrixXd value = balanced_by(D, a.value);
  const double norm = value.cwiseAbs().colwise().sum().maxCoeff();
  const int squarings = norm > 0.5 ? std::ilogb(norm) + 2 : 0;
  const double scale = std::ldexp(1.0, -squarings);
  const MatrixXd X = value * scale;
  const MatrixXd error = balanced_by(D, a.error) * scale;
  const MatrixXd majorant = exponential_of(X.cwiseAbs());
  const auto n = static_cast<double>(X.rows());
  RoundedMatrix result{exponential_of(X),
                       kPadeSteps * (n + 1.0) * majorant + majorant * error * majorant};
  for (int i = 0; i < squarings; ++i) result = product_at_centre(result, result);
  const Eigen::VectorXd back = D.cwiseInverse();
  return {balanced_by(back, result.value), balanced_by(back, result.error)};
}

/// A RoundedMatrix that may be known to be f(τ) M with a constant M: what its exponential needs.
struct Rounded : RoundedMatrix {
  struct Factors {
    RoundedMatrix f;  ///< 1 x 1
    MatrixXd M;
  };
  std::optional<Factors> factors;
};

class RoundedAlgebra {
 public:
  using Matrix = Rounded;

  RoundedAlgebra(const NamedMatrices& values, double tau, double radius)
      : values_(values), tau_(tau), radius_(radius) {}

  Matrix constant(const MatrixXd& value) { return {nearest(value), std::nullopt}; }
  Matrix symbol(const MatrixExpression::Node& node) { return constant(value_of(node, values_)); }
  Matrix square(const MatrixExpression::Node& node) {
    const Matrix root = symbol(node);
    return product(root, root);
  }
  Matrix time() {
    RoundedMatrix tau{scalar_matrix(tau_), scalar_matrix(0.0)};
    if (radius_ > 0.0) {
      tau.slope = scalar_matrix(1.0);
      tau.curvature = scalar_matrix(0.0);
    }
    return {tau, std::nullopt};
  }

  Matrix sum(const Matrix& a, const Matrix& b) {
    const MatrixXd value = a.value + b.value;
    // Where one is zero nothing is rounded.
    const auto rounds = [](double x, double y) { return x == 0.0 || y == 0.0 ? 0.0 : 1.0; };
    const MatrixXd rounded = a.value.binaryExpr(b.value, rounds);
    RoundedMatrix result{value, a.error + b.error + value.cwiseAbs().cwiseProduct(rounded)};
    if (a.is_constant() || b.is_constant()) {
      result.slope = a.is_constant() ? b.slope : a.slope;
      result.curvature = a.is_constant() ? b.curvature : a.curvature;
    } else {
      result.slope = a.slope + b.slope;
      result.curvature = a.curvature + b.curvature;
    }
    return {result, std::nullopt};
  }

  Matrix product(const Matrix& a, const Matrix& b) {
    RoundedMatrix result = product_at_centre(a, b);
    go_on(
        a, b, [](const auto& x, const auto& y) -> MatrixXd { return x * y; }, result);
    return {result, std::nullopt};
  }

  Matrix scaled(const Matrix& scalar, const Matrix& a) {
    Matrix result{scaled_by(scalar, a), std::nullopt};
    if (a.factors) {
      result.factors = Matrix::Factors{scaled_by(scalar, a.factors->f), a.factors->M};
    } else if (a.is_constant()) {
      result.factors = Matrix::Factors{scalar, a.value};
    }
    return result;
  }

  Matrix transpose(const Matrix& a) {
    Matrix result{
        {a.value.transpose(), a.error.transpose(), a.slope.transpose(), a.curvature.transpose()},
        std::nullopt};
    if (a.factors) result.factors = Matrix::Factors{a.factors->f, a.factors->M.transpose()};
    return result;
  }

  Matrix inverse(const Matrix& a) { return {unless_it_changes(a, inverse_at_centre(a)), {}}; }

  /// Of f(τ) M: E' = f' M E and E'' = (f'' M + f'² M²) E, E(τ_c + h) = e^{(f − f_c) M} E(τ_c).
  Matrix exponential(const Matrix& a) {
    RoundedMatrix E = exponential_at_centre(a);
    const bool is_scalar = a.value.size() == 1;
    if (a.is_constant() || !(a.factors || is_scalar)) {
      return {unless_it_changes(a, std::move(E)), {}};
    }
    const RoundedMatrix& f = is_scalar ? a : a.factors->f;
    const MatrixXd M = is_scalar ? scalar_matrix(1.0) : a.factors->M;
    const double steepest = largest_slope(f)(0, 0);
    const MatrixXd growth = exponential_of((radius_ * steepest) * M.cwiseAbs());
    E.slope = f.slope(0, 0) * (M * E.value);
    E.curvature = (f.curvature(0, 0) * M.cwiseAbs() + (steepest * steepest) * (M * M).cwiseAbs()) *
                  growth * E.value.cwiseAbs();
    return {std::move(E), std::nullopt};
  }

  Matrix blocks(const MatrixExpression::Node& node, const std::vector<const Matrix*>& operands) {
    const auto join = [&](MatrixXd RoundedMatrix::*part) {
      std::vector<const MatrixXd*> parts;
      for (const Matrix* operand : operands) parts.push_back(&(operand->*part));
      return joined_blocks(node, parts);
    };
    RoundedMatrix whole{join(&RoundedMatrix::value), join(&RoundedMatrix::error)};
    const bool changes = std::any_of(operands.begin(), operands.end(),
                                     [](const Matrix* a) { return !a->is_constant(); });
    if (changes) {
      whole.slope = join(&RoundedMatrix::slope);
      whole.curvature = join(&RoundedMatrix::curvature);
    }
    return {std::move(whole), std::nullopt};
  }

 private:
  /// |F'| for |h| <= r.
  MatrixXd largest_slope(const RoundedMatrix& a) const {
    return a.slope.cwiseAbs() + radius_ * a.curvature;
  }
  /// |F| for |h| <= r.
  MatrixXd largest(const RoundedMatrix& a) const {
    if (a.is_constant()) return a.value.cwiseAbs();
    return a.value.cwiseAbs() + radius_ * a.slope.cwiseAbs() +
           (radius_ * radius_ / 2.0) * a.curvature;
  }

  /// Slope and curvature of a product: (a b)'' = a'' b + 2 a' b' + a b''.
  template <class Product>
  void go_on(const RoundedMatrix& a, const RoundedMatrix& b, const Product& product,
             RoundedMatrix& result) const {
    if (a.is_constant() && b.is_constant()) return;
    result.slope = MatrixXd::Zero(result.value.rows(), result.value.cols());
    result.curvature = result.slope;
    if (!a.is_constant()) {
      result.slope += product(a.slope, b.value);
      result.curvature += product(a.curvature, largest(b));
    }
    if (!b.is_constant()) {
      result.slope += product(a.value, b.slope);
      result.curvature += product(largest(a), b.curvature);
    }
    if (!a.is_constant() && !b.is_constant()) {
      result.curvature += 2.0 * product(largest_slope(a), largest_slope(b));
    }
  }

  RoundedMatrix scaled_by(const RoundedMatrix& scalar, const RoundedMatrix& a) const {
    const double s = scalar.value(0, 0);
    const double of_s = scalar.error(0, 0);
    int exponent = 0;
    const bool is_exact = s == 0.0 || std::abs(std::frexp(s, &exponent)) == 0.5;
    RoundedMatrix result{s * a.value,
                         std::abs(s) * a.error +
                             (of_s + (is_exact ? 0.0 : std::abs(s))) * a.value.cwiseAbs() +
                             (kUnitRounding * of_s) * a.error};
    go_on(
        scalar, a, [](const auto& x, const auto& y) -> MatrixXd { return x(0, 0) * y; }, result);
    return result;
  }

  /// No formula of a theorem has another inverse or exponential that depends on τ.
  static RoundedMatrix unless_it_changes(const RoundedMatrix& a, RoundedMatrix result) {
    if (a.is_constant()) return result;
    result.slope = MatrixXd::Zero(result.value.rows(), result.value.cols());
    result.curvature = unknown(result.value);
    return result;
  }

  const NamedMatrices& values_;
  double tau_;
  double radius_;
};

}  // namespace

RoundedMatrix evaluate_with_rounding(const MatrixExpression& expression,
                                     const NamedMatrices& values, double tau, double radius) {
  RoundedAlgebra algebra(values, tau, radius);
  return ExpressionEvaluator<RoundedAlgebra>(algebra).evaluate(expression);
}

}  // namespace sampled_data_observers
