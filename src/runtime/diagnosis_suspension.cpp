// What suspends the guarantee of a certificate.
#include <algorithm>
#include <string>

#include "runtime/diagnosis_text.h"
#include "sampled_data_observers/runtime/diagnosis.h"

namespace sampled_data_observers {

std::optional<Diagnosis::Suspension> Diagnosis::find_suspension() const {
  if (subject_.guarantee.empty()) return std::nullopt;
  if (window_.bound_lost_since) return Suspension{*window_.bound_lost_since, why_bound_is_lost()};
  if (newly_skipped_ > 0) return Suspension{now_, describe(BoundLoss::kUnknownJump)};
  if (new_dwell_violations_ > 0) return Suspension{now_, describe(BoundLoss::kDwellTimes)};
  for (std::size_t i = 0; i < subject_.channels.size(); ++i) {
    const ChannelStatistics& statistics = window_.channels[i];
    const SamplingBounds& sampling = subject_.sampling_of(subject_.channels[i]);
    if (statistics.violations.count > 0) {
      const bool is_long = statistics.long_intervals > 0;
      return Suspension{statistics.violations.smallest,
                        "a time between events of " + subject_.channels[i].name + " of " +
                            diagnosis_text::seconds(is_long ? statistics.interval.largest
                                                            : statistics.interval.smallest) +
                            (is_long ? ", above T2 = " + diagnosis_text::longest(sampling.T2)
                                     : ", below T1 = " + diagnosis_text::seconds(sampling.T1))};
    }
    if (statistics.after_bound > 0) {
      return Suspension{now_, std::to_string(statistics.after_bound) + " events of " +
                                  subject_.channels[i].name + ", up to " +
                                  diagnosis_text::seconds(statistics.latency.largest) +
                                  " late, came after error bounds of later stamps were published, "
                                  "which rested on their absence: set error_assumptions/latency "
                                  "to what is never exceeded, and publish_delay to as much"};
    }
    // A sensor of several may never have had one.
    const Stamp since = std::max(memory_[i].used, begun_);
    const bool is_silent = subject_.channels[i].kind == EventKind::kSample && since > 0 &&
                           now_ - since > std::max(sampling.T2, diagnosis_text::kSilence);
    if (is_silent) {
      return Suspension{since, "no sample of " + subject_.channels[i].name +
                                   " for longer than T2 = " + diagnosis_text::longest(sampling.T2)};
    }
  }
  return std::nullopt;
}

std::string Diagnosis::why_bound_is_lost() const {
  std::string reason = describe(window_.bound_loss);
  const std::string old_stamps = why_stamps_are_old();
  return old_stamps.empty() ? reason : reason + "; " + old_stamps;
}

}  // namespace sampled_data_observers
