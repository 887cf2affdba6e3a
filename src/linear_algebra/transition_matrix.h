#pragma once

#include <Eigen/Core>
#include <utility>

namespace sampled_data_observers {

using ExtendedMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

/// A transition matrix, kept in both forms: the difference from the identity holds the digits of
/// slow modes beside fast ones, the matrix itself those of modes that have decayed.
struct Transition {
  explicit Transition(ExtendedMatrix difference)
      : minus_identity(std::move(difference)),
        full(ExtendedMatrix::Identity(minus_identity.rows(), minus_identity.cols()) +
             minus_identity) {}

  /// As doubles, which overflow earlier.
  bool is_finite() const { return full.cast<double>().allFinite(); }

  ExtendedMatrix minus_identity;
  ExtendedMatrix full;
};

/// a b, each entry summed in the order of the columns of a, in blocks that stay in registers: the
/// processor loads a long double from memory many times slower than it multiplies two.
ExtendedMatrix product(const ExtendedMatrix& a, const ExtendedMatrix& b);

/// The product of two that commute.
Transition compose(const Transition& a, const Transition& b);

/// By how many doublings e^M follows from the exponential of a matrix of norm 1/4 at most.
int doublings_for(const ExtendedMatrix& M);

/// e^M
Transition exponential(const ExtendedMatrix& M);

}  // namespace sampled_data_observers
