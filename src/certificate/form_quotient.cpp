#include "certificate/form_quotient.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "certificate/condition.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {

double form_quotient_above(const MatrixExpression& M, const MatrixExpression& P,
                           const NamedMatrices& values) {
  const Eigen::MatrixXd of_M = evaluate(M, values);
  const Eigen::MatrixXd of_P = evaluate(P, values);
  const double computed = largest_generalized_eigenvalue((of_M + of_M.transpose()) / 2.0,
                                                         (of_P + of_P.transpose()) / 2.0);
  const double size = of_M.norm() / of_P.diagonal().maxCoeff();
  double excess =
      1e-9 * std::max(std::abs(computed), 1e-6 * size) + std::numeric_limits<double>::min();
  constexpr int kAttempts = 100;
  for (int i = 0; i < kAttempts; ++i, excess *= 4.0) {
    const double c = std::max(0.0, computed) + excess;
    const MatrixExpression room = c * P - M;
    if (check({{"quotient", room, std::nullopt}}, values).front().holds()) return c;
  }
  throw std::invalid_argument(
      "how far the certificate's matrices differ is lost in rounding: write states in units in "
      "which they are of like size, and design again");
}

}  // namespace sampled_data_observers
