#include "sampled_data_observers/observer/bound_loss.h"

namespace sampled_data_observers {

const char* describe(BoundLoss loss) {
  switch (loss) {
    case BoundLoss::kNone:
      return "it is finite";
    case BoundLoss::kNotVouched:
      return "the estimate went on from one that nobody vouches for, after an overflow, a jump "
             "that "
             "no event told of, new gains without a bound before, or a recovery by reset";
    case BoundLoss::kAngle:
      return "the innovation of an angle may have been wrapped";
    case BoundLoss::kTooLarge:
      return "it grew too large";
    case BoundLoss::kUnknownInput:
      return "an input was rejected, so that the estimate rests on another one";
    case BoundLoss::kUnknownJump:
      return "a jump, or its withdrawal, was rejected or lost, so that the estimate lacks it";
    case BoundLoss::kStillOnTheirWay:
      return "events may still be on their way (error_assumptions/latency, jumps/stamp_error)";
    case BoundLoss::kNearJump:
      return "a jump was told so near to it that the plant may have made it before or after "
             "(jumps/stamp_error)";
    case BoundLoss::kUncertainJump:
      return "a jump may have been before or after its stamp (jumps/stamp_error), and with it "
             "another jump, a change of the input or of the mode, or a turn of an angle; or jumps "
             "of one stamp have no numbers, which tell their order";
    case BoundLoss::kDwellTimes:
      return "the times between jumps were not as jumps/dwell_time, average_dwell_time and "
             "reverse_average_dwell_time say";
    case BoundLoss::kAtRest:
      return "the estimate was taken to be at rest (jumps/rest), which the plant's model is not";
  }
  return "";
}

}  // namespace sampled_data_observers
