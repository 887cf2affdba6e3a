#include "sampled_data_observers/runtime/event_report.h"

namespace sampled_data_observers {

const char* describe(const EventReport& report) {
  switch (report.effect) {
    case Effect::kPastGate:
      return "used though outside the gate: all were for recovery/after";
    case Effect::kRestarted:
      return "used after a reset: all were outside for recovery/after";
    case Effect::kWithoutOutputs:
      return "jumped, but what was measured at the jump gives no finite correction and was skipped";
    case Effect::kOutputsGated:
      return "jumped, but what was measured at the jump, or a part of it, lies outside the gate "
             "and was skipped";
    default:
      return describe(report.outcome);
  }
}

}  // namespace sampled_data_observers
