#include "linear_algebra/transition_matrix.h"

#include <cmath>

namespace sampled_data_observers {

Transition compose(const Transition& a, const Transition& b) {
  Transition result(a.minus_identity + b.minus_identity + a.minus_identity * b.minus_identity);
  // When all modes have decayed, the sum with the identity has cancelled.
  if (result.full.norm() < 0.25L) result.full = a.full * b.full;
  return result;
}

int doublings_for(const ExtendedMatrix& M) {
  const long double norm = M.cwiseAbs().colwise().sum().maxCoeff();
  int doublings = 0;
  if (norm > 0.25L) std::frexp(norm * 4.0L, &doublings);
  return doublings;
}

Transition exponential(const ExtendedMatrix& M) {
  // Taylor's remainder at a norm of 1/4 and 16 terms is below 1e-24, relative to M.
  constexpr int kTerms = 16;
  const int doublings = doublings_for(M);
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

}  // namespace sampled_data_observers
