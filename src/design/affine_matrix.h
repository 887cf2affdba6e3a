#pragma once

#include <Eigen/Core>
#include <vector>

namespace sampled_data_observers {

/// A matrix whose entries are affine in the decision variables x_0, x_1, …
struct AffineMatrix {
  /// coefficient * x_variable, added to one entry.
  struct Term {
    int variable = 0;
    int row = 0;
    int col = 0;
    double coefficient = 0.0;
  };
  Eigen::MatrixXd constant;
  std::vector<Term> terms;

  bool is_constant() const { return terms.empty(); }
};

/// Its value at x.
Eigen::MatrixXd evaluate(const AffineMatrix& matrix, const std::vector<double>& x);

/// The algebra of affine matrices (see ExpressionEvaluator).
/// @throws std::logic_error where a product, an inverse or an exponential is not affine.
AffineMatrix sum(const AffineMatrix& a, const AffineMatrix& b);
AffineMatrix product(const AffineMatrix& a, const AffineMatrix& b);
AffineMatrix scaled(const AffineMatrix& scalar, const AffineMatrix& a);
AffineMatrix transpose(const AffineMatrix& a);

}  // namespace sampled_data_observers
