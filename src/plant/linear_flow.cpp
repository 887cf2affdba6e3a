#include "sampled_data_observers/plant/linear_flow.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "sampled_data_observers/plant/ordered_product.h"

namespace sampled_data_observers {
namespace {

constexpr int kBits = 6;
constexpr int kDigits = 1 << kBits;
constexpr int kPlaces = (63 + kBits - 1) / kBits;

using ExtendedMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

/// A transition matrix, kept in both forms: the difference from the identity holds the digits of
/// slow modes beside fast ones, the matrix itself those of modes that have decayed.
struct Transition {
  explicit Transition(ExtendedMatrix difference)
      : minus_identity(std::move(difference)),
        full(ExtendedMatrix::Identity(minus_identity.rows(), minus_identity.cols()) +
             minus_identity) {}

  ExtendedMatrix minus_identity;
  ExtendedMatrix full;
};

Transition compose(const Transition& a, const Transition& b) {
  Transition result(a.minus_identity + b.minus_identity + a.minus_identity * b.minus_identity);
  // When all modes have decayed, the sum with the identity has cancelled.
  if (result.full.norm() < 0.25L) result.full = a.full * b.full;
  return result;
}

Transition exponential(const ExtendedMatrix& M) {
  const long double norm = M.cwiseAbs().colwise().sum().maxCoeff();
  // Taylor's remainder at a norm of 1/4 and 16 terms is below 1e-24, relative to M.
  constexpr int kTerms = 16;
  int doublings = 0;
  if (norm > 0.25L) std::frexp(norm * 4.0L, &doublings);
  const ExtendedMatrix scaled = M * std::ldexp(1.0L, -doublings);
  ExtendedMatrix power = scaled;
  ExtendedMatrix sum = scaled;
  for (int k = 2; k <= kTerms; ++k) {
    power = (power * scaled / static_cast<long double>(k)).eval();
    sum += power;
  }
  Transition result(sum);
  for (int i = 0; i < doublings && result.full.allFinite(); ++i) result = compose(result, result);
  return result;
}

}  // namespace

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
    digits.push_back(exponential(generator * std::ldexp(1.0L, kBits * place)));
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
  for (int place = 0; duration > 0; ++place, duration >>= kBits) {
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
