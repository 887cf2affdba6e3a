#include "design/affine_matrix.h"

#include <stdexcept>

namespace sampled_data_observers {

Eigen::MatrixXd evaluate(const AffineMatrix& matrix, const std::vector<double>& x) {
  Eigen::MatrixXd value = matrix.constant;
  for (const AffineMatrix::Term& term : matrix.terms) {
    value(term.row, term.col) += term.coefficient * x[static_cast<std::size_t>(term.variable)];
  }
  return value;
}

AffineMatrix sum(const AffineMatrix& a, const AffineMatrix& b) {
  AffineMatrix result{a.constant + b.constant, a.terms};
  result.terms.insert(result.terms.end(), b.terms.begin(), b.terms.end());
  return result;
}

AffineMatrix product(const AffineMatrix& a, const AffineMatrix& b) {
  AffineMatrix result;
  result.constant = a.constant * b.constant;
  if (!a.is_constant() && !b.is_constant()) {
    throw std::logic_error("a product of two decision variables is not affine");
  }
  for (const AffineMatrix::Term& term : a.terms) {
    for (Eigen::Index j = 0; j < b.constant.cols(); ++j) {
      const double factor = b.constant(term.col, j);
      if (factor == 0.0) continue;
      result.terms.push_back(
          {term.variable, term.row, static_cast<int>(j), term.coefficient * factor});
    }
  }
  for (const AffineMatrix::Term& term : b.terms) {
    for (Eigen::Index i = 0; i < a.constant.rows(); ++i) {
      const double factor = a.constant(i, term.row);
      if (factor == 0.0) continue;
      result.terms.push_back(
          {term.variable, static_cast<int>(i), term.col, factor * term.coefficient});
    }
  }
  return result;
}

AffineMatrix scaled(const AffineMatrix& scalar, const AffineMatrix& a) {
  AffineMatrix result;
  const double factor = scalar.constant(0, 0);
  result.constant = factor * a.constant;
  if (!scalar.is_constant() && !a.is_constant()) {
    throw std::logic_error("a product of two decision variables is not affine");
  }
  for (AffineMatrix::Term term : a.terms) {
    term.coefficient *= factor;
    if (term.coefficient != 0.0) result.terms.push_back(term);
  }
  for (const AffineMatrix::Term& term : scalar.terms) {
    for (Eigen::Index j = 0; j < a.constant.cols(); ++j) {
      for (Eigen::Index i = 0; i < a.constant.rows(); ++i) {
        const double entry = a.constant(i, j);
        if (entry == 0.0) continue;
        result.terms.push_back(
            {term.variable, static_cast<int>(i), static_cast<int>(j), term.coefficient * entry});
      }
    }
  }
  return result;
}

AffineMatrix transpose(const AffineMatrix& a) {
  AffineMatrix result{a.constant.transpose(), a.terms};
  for (AffineMatrix::Term& term : result.terms) std::swap(term.row, term.col);
  return result;
}

}  // namespace sampled_data_observers
