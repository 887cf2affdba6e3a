#include "sampled_data_observers/runtime/event_outcome.h"

namespace sampled_data_observers {
namespace {

struct OutcomeText {
  EventOutcome outcome;
  const char* words;
  const char* remedy;
};

constexpr OutcomeText kTexts[kEventOutcomes] = {
    {EventOutcome::kUsed, "used", ""},
    {EventOutcome::kUsedLate, "used late", ""},
    {EventOutcome::kDuplicate, "duplicate of an event taken in before", ""},
    {EventOutcome::kTooOld, "older than the history window, the start or the last reset",
     "compare the clocks of the hosts, and the latency with history/duration"},
    {EventOutcome::kInFuture, "stamped in the future",
     "compare the clocks of the hosts, or raise future_tolerance"},
    {EventOutcome::kNoStamp, "stamp is zero or invalid", "its publisher must set header.stamp"},
    {EventOutcome::kWrongSize, "wrong number of values",
     "compare the messages with what is configured"},
    {EventOutcome::kNotFinite, "a value is not finite, or beyond 1e100",
     "see what its publisher sends, with rostopic echo"},
    {EventOutcome::kWouldOverflow, "the estimate would overflow",
     "the value is far off, or the estimate diverged: reset it"},
    {EventOutcome::kUnknownMode, "a mode that the plant does not have",
     "compare the mode in the messages with plant/modes"},
    {EventOutcome::kTooFrequent, "jumps faster than jumps/min_separation or max_per_second allow",
     "the detector of jumps fires again and again, or raise the limits"},
    {EventOutcome::kGated, "the innovation lies outside the gate",
     "the value is far off, or the estimate is wrong: see gate/recovery"},
    {EventOutcome::kDisabled, "the observer or the sensor is switched off",
     "switch it on again with set_enabled or enable_sensor"},
    {EventOutcome::kNoTransform, "no transform into the configured frame came in time",
     "see who should publish it, with rosrun tf tf_echo, or raise tf_timeout"},
    {EventOutcome::kNoField, "the message does not hold a configured field",
     "compare the messages with source/fields"},
    {EventOutcome::kOutOfOrder, "a detector's signal, stamped not after the one before",
     "its publisher must send the signal in the order of stamps"},
    {EventOutcome::kDropped, "dropped, since 2000 later ones of its topic waited",
     "send fewer messages, or give the observer more of the machine"},
    {EventOutcome::kNotPossible,
     "the estimate lies outside plant/jump_set, by more than jumps/gate/margin",
     "the detector of jumps erred, or the estimate did: see jumps/gate/recovery"},
    {EventOutcome::kRepeated, "a jump with the number of the one before",
     "one jump was told twice, with different stamps"},
    {EventOutcome::kJumpAlone,
     "jumped, but what was measured at the jump, or a part of it, was skipped",
     "the value is far off, or the estimate is wrong: reset it, or see gate/recovery"},
    {EventOutcome::kTakenBack, "a jump was taken back, as if it had never been told", ""},
    {EventOutcome::kWithdrawn, "a jump that was taken back before it came", ""},
    {EventOutcome::kNoSuchJump,
     "no jump of its stamp and number, or mode, was told to be taken back",
     "withdrawals repeat the message of the jump, with its stamp and index"},
    {EventOutcome::kOtherDefinition, "its publisher has another type, or another definition of it",
     "compare rosmsg md5 on both hosts, and rostopic info: build all against the same messages"},
    {EventOutcome::kMalformed, "its bytes are no message of its type",
     "its publisher is broken, or its messages are cut off"},
    {EventOutcome::kOutOfLimits, "a value lies outside of its source's limits",
     "see what its publisher sends, with rostopic echo, and compare scale, offset and limits"},
    {EventOutcome::kNoCovariance, "the covariance in the message is not positive definite",
     "see what its publisher sends, with rostopic echo, or give gains/R a floor"},
};

constexpr bool is_in_order() {
  for (std::size_t code = 0; code < kEventOutcomes; ++code) {
    if (kTexts[code].outcome != static_cast<EventOutcome>(code)) return false;
  }
  return true;
}
static_assert(is_in_order(), "one line per outcome, in the order of their codes");

const OutcomeText& text_of(EventOutcome outcome) {
  return kTexts[static_cast<std::size_t>(outcome)];
}

}  // namespace

const char* describe(EventOutcome outcome) { return text_of(outcome).words; }

const char* remedy(EventOutcome outcome) { return text_of(outcome).remedy; }

bool is_use(EventOutcome outcome) {
  return outcome == EventOutcome::kUsed || outcome == EventOutcome::kUsedLate ||
         outcome == EventOutcome::kJumpAlone || outcome == EventOutcome::kTakenBack;
}

bool is_good(EventOutcome outcome) {
  return is_use(outcome) || outcome == EventOutcome::kGated ||
         outcome == EventOutcome::kWouldOverflow;
}

bool is_rejection(EventOutcome outcome) {
  return !is_use(outcome) && outcome != EventOutcome::kDuplicate &&
         outcome != EventOutcome::kWithdrawn;
}

}  // namespace sampled_data_observers
