#pragma once

#include <cstdint>
#include <limits>

namespace sampled_data_observers {

/// Why an estimate has no finite error bound.
enum class BoundLoss : std::uint8_t {
  kNone = 0,         ///< it has one, or the law gives none at all
  kNotVouched,       ///< the estimate went on from one of which nothing is known
  kAngle,            ///< an angular innovation may have been wrapped
  kTooLarge,         ///< it grew beyond what it can be computed for
  kUnknownInput,     ///< an input was rejected: the estimate rests on another one
  kUnknownJump,      ///< a jump was rejected or lost: the estimate did not take it
  kStillOnTheirWay,  ///< events before its stamp may still come
  kNearJump,         ///< a jump told near its stamp may have been before or after it
  kUncertainJump,    ///< the time of a jump is not known well enough to bound what it did
  kDwellTimes,       ///< jumps came at other times than those configured
  kAtRest            ///< the estimate was taken to be at rest
};

/// A guaranteed bound on |x − x̂|, infinite where there is none, and why; NaN without certificate.
struct PublishedBound {
  /// In units of the state, >= 0.
  double value = std::numeric_limits<double>::quiet_NaN();
  /// kNone unless the value is infinite.
  BoundLoss loss = BoundLoss::kNone;
};

/// In a few words, for people.
const char* describe(BoundLoss loss);

}  // namespace sampled_data_observers
