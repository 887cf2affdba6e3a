#pragma once

#include <cstdint>

namespace sampled_data_observers {

/// Why an estimate has no finite error bound.
enum class BoundLoss : std::uint8_t {
  kNone = 0,        ///< it has one, or the law gives none at all
  kNotVouched,      ///< the estimate went on from one of which nothing is known
  kAngle,           ///< an angular innovation may have been wrapped
  kJumpTimes,       ///< the theorem is not about jumps at such times
  kTooLarge,        ///< it grew beyond what it can be computed for
  kRefusedJump,     ///< a jump came faster than the limits allow, and was refused
  kUnknownInput,    ///< an input was rejected: the estimate rests on another one
  kUnknownJump,     ///< a jump was rejected: the estimate did not take it
  kStillOnTheirWay  ///< events before its stamp may still come
};

/// In a few words, for people.
const char* describe(BoundLoss loss);

}  // namespace sampled_data_observers
