#include "sampled_data_observers/plant/linear_flow.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "linear_algebra/transition_matrix.h"
#include "sampled_data_observers/linear_algebra/ordered_product.h"

namespace sampled_data_observers {

LinearFlow::LinearFlow(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B)
    : states_(A.rows()), inputs_(B.cols()) {
  if (A.rows() == 0 || A.rows() != A.cols()) {
    throw std::invalid_argument("LinearFlow: A must be square and not empty");
  }
  if (B.rows() != A.rows()) {
    throw std::invalid_argument("LinearFlow: B must have as many rows as A");
  }
  if (!A.allFinite() || !B.allFinite()) {
    throw std::invalid_argument("LinearFlow: A and B must be finite");
  }
  const Eigen::Index size = states_ + inputs_;
  const auto block = static_cast<std::size_t>(states_ * size);
  tables_.resize(block * kDigits * kPlaces);

  ExtendedMatrix generator = ExtendedMatrix::Zero(size, size);
  generator.topLeftCorner(states_, states_) = A.cast<long double>();
  generator.topRightCorner(states_, inputs_) = B.cast<long double>();
  generator *= 1e-9L;

  // An unstable plant's later transitions overflow; arithmetic on infinities takes ages.
  std::fill(tables_.begin(), tables_.end(), std::numeric_limits<double>::infinity());
  auto table = tables_.begin();
  for (int place = 0; place < kPlaces; ++place) {
    std::vector<Transition> digits;
    digits.emplace_back(ExtendedMatrix::Zero(size, size));
    digits.push_back(exponential(generator * std::ldexp(1.0L, kDigitBits * place)));
    for (std::size_t d = 2; d < kDigits; ++d) {
      if (!digits.back().full.allFinite()) break;
      digits.push_back(compose(digits[d / 2], digits[d - d / 2]));
    }
    for (const Transition& digit : digits) {
      if (!digit.full.allFinite()) return;
      Eigen::Map<Eigen::MatrixXd>(&*table, states_, size) =
          digit.full.topRows(states_).cast<double>();
      table += static_cast<std::ptrdiff_t>(block);
    }
  }
}

const double* LinearFlow::transition(int place, int digit) const {
  const auto block = static_cast<std::size_t>(states_ * (states_ + inputs_));
  return tables_.data() + static_cast<std::size_t>(place * kDigits + digit) * block;
}

void LinearFlow::apply(Duration duration, double* x, const double* u, double* scratch) const {
  for (int place = 0; duration > 0; ++place, duration >>= kDigitBits) {
    const int digit = static_cast<int>(duration & (kDigits - 1));
    if (digit == 0) continue;
    const double* M = transition(place, digit);
    // Loops, not fill_n and copy_n: these call the C library, which takes longer than the product.
    for (Eigen::Index i = 0; i < states_; ++i) scratch[i] = 0.0;
    add_product(M, states_, states_, x, scratch);
    add_product(M + states_ * states_, states_, inputs_, u, scratch);
    for (Eigen::Index i = 0; i < states_; ++i) x[i] = scratch[i];
  }
}

}  // namespace sampled_data_observers
