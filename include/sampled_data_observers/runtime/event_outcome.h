#pragma once

#include <cstddef>
#include <cstdint>

namespace sampled_data_observers {

/// What became of a received event.
enum class EventOutcome : std::uint8_t {
  kUsed = 0,           ///< taken in as the newest event
  kUsedLate = 1,       ///< taken in before events already there, which were applied again
  kDuplicate = 2,      ///< the same event was taken in before
  kTooOld = 3,         ///< before the history window, the start or the last reset
  kInFuture = 4,       ///< stamped later than now plus the tolerance
  kNoStamp = 5,        ///< the stamp is zero, or was no time
  kWrongSize = 6,      ///< another number of values than the channel has
  kNotFinite = 7,      ///< a value is NaN, infinite or beyond kLargestValue
  kWouldOverflow = 8,  ///< taken in, but its effect is not finite and was skipped
  kUnknownMode = 9,    ///< a jump into a mode that the plant does not have
  kTooFrequent = 10,   ///< taken in without effect: jumps come faster than the limits allow
  kGated = 11,         ///< taken in without effect: the innovation lies outside the gate
  kDisabled = 12,      ///< the observer or the sensor is switched off
  kNoTransform = 13,   ///< no transform into a configured frame came in time, so there is no event
  kNoField = 14,       ///< the message does not hold what is configured, so there is no event
  kOutOfOrder = 15,    ///< a detector's signal, stamped not after the one before: no event
  kDropped = 16,       ///< more messages came than could be taken in: never looked at
  kNotPossible = 17,   ///< taken in without effect: a jump where the estimate can't jump
  kRepeated = 18,      ///< taken in without effect: a jump with the number of the one before
  kJumpAlone = 19,     ///< a jump taken in without what was measured at it, or a part of it
  kTakenBack = 20,     ///< a withdrawal: the jump that it is about was taken out
  kWithdrawn = 21,     ///< a jump taken in without effect: its withdrawal came before
  kNoSuchJump = 22,    ///< a withdrawal taken in without effect, unless its jump comes yet
  kOtherDefinition = 23,  ///< of a publisher of another type, or another definition of it: no event
  kMalformed = 24,        ///< bytes that are no message of the type: no event
  kOutOfLimits = 25,      ///< a value lies outside of its source's limits
  kNoCovariance =
      26  ///< the covariance in the message is not positive definite, so there is no event
};

/// How many outcomes there are: their codes lie below.
constexpr std::size_t kEventOutcomes = static_cast<std::size_t>(EventOutcome::kNoCovariance) + 1;

/// Characters of what is said of a rejected event beside its outcome; what is longer is cut.
constexpr std::size_t kLongestDetail = 400;

/// The outcome in a few words.
const char* describe(EventOutcome outcome);

/// What a person can do about events with this outcome; empty where nothing need be done.
const char* remedy(EventOutcome outcome);

/// Whether the estimate rests on events with this outcome.
bool is_use(EventOutcome outcome);

/// Whether events with this outcome are good as far as events alone tell: they are used, or it is
/// the estimate that keeps them out.
bool is_good(EventOutcome outcome);

/// Whether events with this outcome are lost: neither used nor known already.
bool is_rejection(EventOutcome outcome);

}  // namespace sampled_data_observers
