#include "sampled_data_observers/plant/linear_flow.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sampled_data_observers/plant/ordered_product.h"

namespace sampled_data_observers {
namespace {

constexpr int kBits = 6;
constexpr int kDigits = 1 << kBits;
constexpr int kPlaces = (63 + kBits - 1) / kBits;

using ExtendedMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

/// exp(M) - I. Without the identity, doubling keeps the slow modes' digits beside fast ones, which
/// the squaring of exp(M / 2^s) loses.
ExtendedMatrix exponential_minus_identity(const ExtendedMatrix& M) {
  const long double norm = M.cwiseAbs().colwise().sum().maxCoeff();
  // Taylor's remainder at a norm of 1/4 and 16 terms is below 1e-24, relative to M.
  constexpr int kTerms = 16;
  int doublings = 0;
  if (norm > 0.25L) std::frexp(norm * 4.0L, &doublings);
  const ExtendedMatrix scaled = M * std::ldexp(1.0L, -doublings);
  ExtendedMatrix power = scaled;
  ExtendedMatrix result = scaled;
  for (int k = 2; k <= kTerms; ++k) {
    power = (power * scaled / static_cast<long double>(k)).eval();
    result += power;
  }
  for (int i = 0; i < doublings; ++i) result = (2.0L * result + result * result).eval();
  return result;
}

/// exp(a + b) - I from exp(a) - I and exp(b) - I.
ExtendedMatrix compose(const ExtendedMatrix& a, const ExtendedMatrix& b) { return a + b + a * b; }

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

  std::vector<ExtendedMatrix> digits(kDigits, ExtendedMatrix::Zero(size, size));
  auto table = tables_.begin();
  for (int place = 0; place < kPlaces; ++place) {
    digits[1] = exponential_minus_identity(generator * std::ldexp(1.0L, kBits * place));
    for (std::size_t d = 2; d < kDigits; ++d) digits[d] = compose(digits[d / 2], digits[d - d / 2]);
    for (const ExtendedMatrix& digit : digits) {
      Eigen::Map<Eigen::MatrixXd> transition(&*table, states_, size);
      transition = digit.topRows(states_).cast<double>();
      // Rounded after the identity is added: a decayed mode keeps its relative precision.
      for (Eigen::Index i = 0; i < states_; ++i) {
        transition(i, i) = static_cast<double>(1.0L + digit(i, i));
      }
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
    std::fill_n(scratch, states_, 0.0);
    add_product(M, states_, states_, x, scratch);
    add_product(M + states_ * states_, states_, inputs_, u, scratch);
    std::copy_n(scratch, states_, x);
  }
}

}  // namespace sampled_data_observers
