#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "certificate/condition.h"

namespace sampled_data_observers {

enum class ProofStatus { kProved, kDisproved, kUndecided };
const char* to_string(ProofStatus status);

/// What ball arithmetic says of a condition.
struct ConditionProof {
  std::string name;
  ProofStatus status = ProofStatus::kUndecided;
  /// Of a condition over τ: where it is violated, or where it could not be decided [s].
  std::optional<double> tau;
  /// Where disproved: vᵀ F v is certainly not larger than this for a vector v of norm 1, F being
  /// the matrix that should be positive definite; of a domain, the number itself. Where undecided:
  /// the least eigenvalue, about, of F scaled as by check().
  double value = 0.0;
  /// Intervals of τ that were looked at.
  std::size_t intervals = 0;
  /// Why it is undecided.
  std::string reason;
};

/// Which numbers stand for all numbers of which they are the nearest double.
enum class RoundedNumbers {
  kNotWhole,   ///< of a file, where whole numbers are meant as they are
  kAllButZero  ///< in other units: what is whole there need not be so in the file
};

struct ProofOptions {
  /// Of all conditions together [s]. What is not decided by then is undecided.
  double time_limit = 60.0;
  RoundedNumbers rounded = RoundedNumbers::kNotWhole;
  /// Called now and then with the share that is done, from 0 to 1; may be empty.
  std::function<void(double)> on_progress;
};

/// Proves or disproves conditions, over all τ of their intervals and not on a grid, in ball
/// arithmetic: rounding is accounted for.
///
/// Every number of `values` and of the constants in the conditions that is not whole, or not zero
/// (RoundedNumbers), stands for all numbers of which it is the nearest double. Its decimal in a
/// file is one of them, and the double that an observer computes with is another: a proof is about
/// both.
///
/// An interval of τ is proved by the Cholesky decomposition of an enclosure, scaled by a
/// congruence, or bisected. A condition is disproved by a τ and a vector. Undecided is one whose
/// matrix is singular, or too close to it, at some τ, or for which the time was not enough; its
/// reason says which.
/// @throws as evaluate()
std::vector<ConditionProof> prove(const std::vector<Condition>& conditions,
                                  const NamedMatrices& values, const ProofOptions& options = {});

/// Of the first condition that is not proved, which one it is, where and why, in one line; empty
/// where all are proved.
std::string first_unproved(const std::vector<ConditionProof>& proofs);

}  // namespace sampled_data_observers
