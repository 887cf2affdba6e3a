#include "sampled_data_observers/runtime/diagnosis.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/diagnosis_text.h"
#include "sampled_data_observers/runtime/no_clock.h"

namespace sampled_data_observers {
namespace {

using diagnosis_text::extremes;
using diagnosis_text::in_milliseconds;
using diagnosis_text::instant;
using diagnosis_text::kSilence;
using diagnosis_text::longest;
using diagnosis_text::seconds;
using diagnosis_text::shown;

/// Estimates that come later than two periods and this are reported.
constexpr Duration kLate = 20'000'000;
/// Less than this part of the rate is reported.
constexpr double kLowestRate = 0.9;

std::uint64_t rejected(const ChannelStatistics& statistics) {
  std::uint64_t sum = 0;
  for (std::size_t code = 0; code < kEventOutcomes; ++code) {
    if (is_rejection(static_cast<EventOutcome>(code))) sum += statistics.outcomes[code];
  }
  return sum;
}

std::uint64_t growth(std::uint64_t before, std::uint64_t now) {
  return now > before ? now - before : 0;
}

/// An outcome in words, what it was about (which may be empty), and what to do.
std::string with_remedy(EventOutcome outcome, const std::string& detail) {
  const std::string advice = remedy(outcome);
  return std::string(describe(outcome)) + (detail.empty() ? "" : ": " + detail) +
         (advice.empty() ? "" : " (" + advice + ")");
}

}  // namespace

std::string describe_wrong_type(const std::string& topic, const std::string& published,
                                const std::string& expected) {
  return topic + " is published as " + published + ", expected " + expected;
}

std::string describe_stamps_ahead(Duration latency) {
  constexpr Duration kMillisecond = 1'000'000;
  const Duration rounded = (latency - kMillisecond / 2) / kMillisecond * kMillisecond;
  return seconds(-latency) +
         " ahead of the clock in the median: stamp_offset: " + shown(to_seconds(rounded)) +
         " in the source takes that off (its clock is ahead by the messages' latency more), "
         "NTP on its host mends it";
}

std::string describe_old_stamps(const std::string& topic, Duration behind) {
  return "stamps on " + topic + " are " + seconds(behind) +
         " older than the clock: play the bag with --clock and /use_sim_time true, or compare the "
         "clocks of the hosts";
}

Diagnosis::Diagnosis(DiagnosisSubject subject)
    : subject_(std::move(subject)),
      clock_(subject_.jump_back_tolerance),
      window_(subject_.channels.size()),
      totals_(subject_.channels.size()),
      memory_(subject_.channels.size()) {}

void Diagnosis::update(const RunStatistics& window, Stamp now, Duration elapsed) {
  if (clock_.note(now) > 0) {  // what was in the future says nothing
    for (ChannelMemory& memory : memory_) memory.forget_events();
    begun_ = 0;
    restored_ = 0;
  }
  window_ = window;
  newly_missing_ = growth(totals_.missing_jumps, window.missing_jumps);
  newly_skipped_ = growth(totals_.skipped_jumps, window.skipped_jumps);
  new_dwell_violations_ = growth(totals_.dwell_violations, window.dwell_violations);
  totals_.add(window);
  now_ = now;
  elapsed_ = elapsed;
  for (std::size_t i = 0; i < memory_.size(); ++i) {
    if (window.channels[i].received() > 0) {
      const Range& latency = window.channels[i].latency;
      const bool is_behind = latency.count > 0 && latency.smallest > subject_.history;
      memory_[i].received = now;
      memory_[i].behind = is_behind && window.channels[i].used() > 0 ? latency.smallest : 0;
    }
    if (window.channels[i].used() > 0) memory_[i].used = now;
    memory_[i].newest = std::max(memory_[i].newest, window.channels[i].newest.value_or(0));
  }
  if (begun_ == 0 && window.lateness.count > 0) begun_ = now;
  const std::optional<Suspension> found = find_suspension();
  if (found && !suspension_) {
    suspension_ = found;
  } else if (!found && suspension_) {
    last_suspension_ = *suspension_;
    restored_ = now;
    suspension_.reset();
  }
}

void Diagnosis::set_published_type(std::size_t channel, std::string type) {
  memory_[channel].published_type = std::move(type);
}

std::string Diagnosis::rejections(const ChannelStatistics& statistics) const {
  std::size_t commonest = kEventOutcomes;
  for (std::size_t code = 0; code < kEventOutcomes; ++code) {
    if (!is_rejection(static_cast<EventOutcome>(code)) || statistics.outcomes[code] == 0) continue;
    if (commonest == kEventOutcomes || statistics.outcomes[code] > statistics.outcomes[commonest]) {
      commonest = code;
    }
  }
  if (commonest == kEventOutcomes) return "";
  const auto outcome = static_cast<EventOutcome>(commonest);
  std::string detail;
  if (outcome == statistics.detail.outcome) detail = statistics.detail.text;
  if (outcome == EventOutcome::kInFuture && statistics.median_latency.value_or(0) < 0) {
    detail = describe_stamps_ahead(*statistics.median_latency);
  }
  return with_remedy(outcome, detail);
}

/// Empty where the type is right, or nothing is published.
std::string Diagnosis::wrong_type(std::size_t channel) const {
  const DiagnosisSubject::Channel& expected = subject_.channels[channel];
  const std::string& published = memory_[channel].published_type;
  if (published.empty() || published == expected.type) return "";
  return describe_wrong_type(expected.topic, published, expected.type);
}

/// Empty where those of no channel are.
std::string Diagnosis::why_stamps_are_old() const {
  for (std::size_t i = 0; i < memory_.size(); ++i) {
    if (memory_[i].behind > 0)
      return describe_old_stamps(subject_.channels[i].topic, memory_[i].behind);
  }
  return "";
}

std::string Diagnosis::why_no_estimate() const {
  std::string silent;
  std::string mistyped;
  for (std::size_t i = 0; i < subject_.channels.size(); ++i) {
    const ChannelStatistics& statistics = totals_.channels[i];
    const std::string reason = rejections(statistics);
    if (!reason.empty())
      return "messages on " + subject_.channels[i].topic + " rejected: " + reason;
    if (mistyped.empty()) mistyped = wrong_type(i);
    silent += " " + subject_.channels[i].topic;
  }
  if (!mistyped.empty()) return mistyped;
  return "nothing was received on" + silent + ": are their publishers running (rostopic info)?";
}

/// Empty where it is not, as of the last input that was used.
std::string Diagnosis::why_input_is_stale(std::size_t index) const {
  const DiagnosisSubject::Channel& channel = subject_.channels[index];
  const Stamp newest = memory_[index].newest;
  if (channel.timeout == 0 || newest == 0 || now_ - newest <= channel.timeout) return "";
  return "the last input on " + channel.topic + " is " + seconds(now_ - newest) +
         " old, more than its timeout of " + seconds(channel.timeout) +
         (channel.after_timeout.empty() ? ": it goes on holding"
                                        : ": taken as " + channel.after_timeout) +
         "; has its publisher stopped (rostopic hz)?";
}

/// Empty where the innovations of no sensor do so.
std::string Diagnosis::why_it_diverges(InnovationTrend trend) const {
  for (std::size_t i = 0; i < subject_.channels.size(); ++i) {
    const ChannelStatistics& statistics = window_.channels[i];
    if (statistics.trend != trend) continue;
    const std::string what = "the innovations of " + subject_.channels[i].name +
                             " grow and grow, the last to " + shown(statistics.innovation);
    return trend == InnovationTrend::kDiverging
               ? "the estimate diverges: " + what +
                     ": are the signs of the gains right, and the "
                     "plant's model?"
               : what + ", more than what is measured: does the estimate diverge?";
  }
  return "";
}

Finding Diagnosis::estimates() const {
  Finding finding;
  const double rate = 1.0 / to_seconds(subject_.period);
  const double published = static_cast<double>(window_.lateness.count);
  const double expected = rate * to_seconds(elapsed_);
  const std::string old_stamps = why_stamps_are_old();
  const std::string diverging = why_it_diverges(InnovationTrend::kDiverging);
  const std::string growing = why_it_diverges(InnovationTrend::kGrowing);
  const Duration latest = window_.lateness.count > 0 ? window_.lateness.largest : 0;
  if (now_ == 0) {
    finding = {HealthLevel::kStale, std::string("no time yet: ") + kNoClock, {}};
  } else if (!window_.newest_estimate) {
    const bool received = std::any_of(memory_.begin(), memory_.end(),
                                      [](const ChannelMemory& m) { return m.received > 0; });
    finding = {received ? HealthLevel::kError : HealthLevel::kStale,
               "no estimate yet: " + why_no_estimate(),
               {}};
  } else if (elapsed_ <= 0) {
    finding = {HealthLevel::kStale,
               "time stands still (/use_sim_time is true): nothing comes on /clock",
               {}};
  } else if (expected >= 2.0 && published == 0.0) {
    finding = {HealthLevel::kError,
               "no estimate since " + instant(*window_.newest_estimate) +
                   ": is the observer switched off, or time before its history?",
               {}};
  } else if (!diverging.empty()) {
    finding = {HealthLevel::kError, diverging, {}};
  } else if (!old_stamps.empty()) {
    finding = {HealthLevel::kWarn, old_stamps, {}};
  } else if (window_.held > 0) {
    finding = {HealthLevel::kWarn,
               "the model's flow is not finite: the last estimate is held until the next sample",
               {}};
  } else if (window_.saturated > 0) {
    finding = {HealthLevel::kWarn,
               std::to_string(window_.saturated) + " of " + std::to_string(window_.lateness.count) +
                   " estimates stand at a bound of saturations, or beyond: is the model right?",
               {}};
  } else if (newly_missing_ > 0) {
    finding = {HealthLevel::kWarn,
               std::to_string(newly_missing_) + " jumps that no event told of (jumps/missing)",
               {}};
  } else if (newly_skipped_ > 0) {
    finding = {HealthLevel::kWarn,
               std::to_string(newly_skipped_) +
                   " jumps were lost: their numbers (index) are missing among those told",
               {}};
  } else if (new_dwell_violations_ > 0) {
    finding = {HealthLevel::kWarn,
               std::to_string(new_dwell_violations_) +
                   " times, jumps came at others than jumps/dwell_time, average_dwell_time or "
                   "reverse_average_dwell_time say",
               {}};
  } else if (!growing.empty()) {
    finding = {HealthLevel::kWarn, growing, {}};
  } else if (published < kLowestRate * expected - 1.0) {
    finding = {HealthLevel::kWarn,
               shown(published / to_seconds(elapsed_)) + " Hz instead of " + shown(rate) +
                   " Hz: the host is too busy, or the clock too coarse",
               {}};
  } else if (latest > std::max(2 * subject_.period, kLate)) {
    finding = {
        HealthLevel::kWarn, "up to " + in_milliseconds(latest) + " late: the host is too busy", {}};
  } else {
    finding.message = "published at their rate";
  }
  const Range& cpu = window_.tick_cpu_time;
  finding.values = {
      {"rate [Hz]", elapsed_ > 0 ? shown(published / to_seconds(elapsed_)) : "unknown"},
      {"rate asked [Hz]", shown(rate)},
      {"lateness", extremes(window_.lateness)},
      {"jitter", window_.lateness.count > 0
                     ? in_milliseconds(window_.lateness.largest - window_.lateness.smallest)
                     : "none"},
      {"published in all", std::to_string(totals_.lateness.count)},
      {"held", std::to_string(window_.held)},
      {"saturated", std::to_string(window_.saturated)},
      {"with a stale input", std::to_string(window_.input_stale)},
      {"missing jumps in all", std::to_string(totals_.missing_jumps)},
      {"lost jumps in all", std::to_string(totals_.skipped_jumps)},
      {"jumps at other times in all", std::to_string(totals_.dwell_violations)},
      {"CPU time per tick, mean", in_milliseconds(cpu.mean())},
      {"CPU time per tick, most", in_milliseconds(cpu.count > 0 ? cpu.largest : 0)},
  };
  return finding;
}

Finding Diagnosis::channel(std::size_t index) const {
  const DiagnosisSubject::Channel& channel = subject_.channels[index];
  const ChannelStatistics& statistics = window_.channels[index];
  const ChannelStatistics& total = totals_.channels[index];
  const SamplingBounds& sampling = subject_.sampling_of(channel);
  const Stamp received = memory_[index].received;
  const bool is_measured = channel.kind == EventKind::kSample || channel.kind == EventKind::kOutput;
  Finding finding;
  const std::string mistyped = wrong_type(index);
  if (total.received() == 0 && !mistyped.empty()) {
    finding.level = HealthLevel::kError;
    finding.message = mistyped;
  } else if (total.received() == 0) {
    finding.message = "nothing received on " + channel.topic;
    if (channel.kind != EventKind::kJump && channel.kind != EventKind::kJumpOutput) {
      finding.level = is_measured ? HealthLevel::kStale : HealthLevel::kWarn;
      finding.message += ": is its publisher running (rostopic info)?";
    }
  } else if (statistics.received() > 0 && statistics.used() == 0 && rejected(statistics) > 0) {
    finding.level = HealthLevel::kError;
    finding.message = "all rejected: " + rejections(statistics);
  } else if (rejected(statistics) > 0) {
    finding.level = HealthLevel::kWarn;
    finding.message = std::to_string(rejected(statistics)) + " of " +
                      std::to_string(statistics.received()) +
                      " rejected: " + rejections(statistics);
  } else if (const std::uint64_t alone = statistics.count(EventOutcome::kJumpAlone); alone > 0) {
    finding.level = HealthLevel::kWarn;
    finding.message = std::to_string(alone) + " of " + std::to_string(statistics.received()) + " " +
                      with_remedy(EventOutcome::kJumpAlone, "");
  } else if (memory_[index].behind > 0) {
    finding.level = HealthLevel::kWarn;
    finding.message = describe_old_stamps(channel.topic, memory_[index].behind);
  } else if (const std::string stale = why_input_is_stale(index); !stale.empty()) {
    finding.level = HealthLevel::kWarn;
    finding.message = stale;
  } else if (is_measured && now_ - received > std::max(sampling.T2, kSilence)) {
    finding.level = HealthLevel::kStale;
    finding.message = "nothing for " + seconds(now_ - received) + " on " + channel.topic +
                      ": has its publisher stopped (rostopic hz)?";
  } else if (statistics.short_intervals + statistics.long_intervals > 0) {
    finding.level = HealthLevel::kWarn;
    finding.message = "used, but " +
                      std::to_string(statistics.short_intervals + statistics.long_intervals) +
                      " times between samples are outside of [" + seconds(sampling.T1) + ", " +
                      longest(sampling.T2) + "]";
    const std::string hint =
        describe_unit_of_times(statistics.interval.mean() / kNanosecondsPerSecond,
                               to_seconds(sampling.T1), longest_to_seconds(sampling.T2));
    if (!hint.empty()) finding.message += ": " + hint;
  } else if (statistics.received() == 0 && channel.kind == EventKind::kInput &&
             now_ - received > kSilence) {
    finding.message = "nothing for " + seconds(now_ - received) + ": the last input holds";
  } else {
    finding.message = statistics.received() > 0 ? "used" : "nothing lately";
  }
  finding.values = {
      {"topic", channel.topic},
      {"received", std::to_string(statistics.received())},
      {"used", std::to_string(statistics.used())},
      {"latency", extremes(statistics.latency)},
      {"latency, median",
       statistics.median_latency ? in_milliseconds(*statistics.median_latency) : "none"},
      {"rewinds", std::to_string(statistics.rewound.count)},
      {"events applied again, most",
       std::to_string(statistics.rewound.count > 0 ? statistics.rewound.largest : 0)},
      {"received in all", std::to_string(total.received())},
      {"used in all", std::to_string(total.used())}};
  if (total.after_bound > 0) {
    finding.values.emplace_back("after a published bound, in all",
                                std::to_string(total.after_bound));
  }
  if (is_measured) {
    finding.values.emplace_back("innovation, last", shown(statistics.innovation));
    add_innovations(index, finding);
  }
  if (channel.kind == EventKind::kSample) add_times_between_samples(index, finding);
  for (std::size_t code = 0; code < kEventOutcomes; ++code) {
    const auto outcome = static_cast<EventOutcome>(code);
    const bool is_usual = outcome == EventOutcome::kUsed || outcome == EventOutcome::kUsedLate;
    if (is_usual || total.outcomes[code] == 0) continue;
    finding.values.emplace_back(std::string("in all: ") + describe(outcome),
                                std::to_string(total.outcomes[code]));
  }
  return finding;
}

Finding Diagnosis::certificate() const {
  Finding finding;
  if (!subject_.warning.empty()) {
    finding = {HealthLevel::kWarn, "no guarantee: " + subject_.warning, {}};
  } else if (subject_.guarantee.empty()) {
    finding.message = "none configured";
  } else if (suspension_) {
    finding.level = HealthLevel::kWarn;
    finding.message = "suspended since " + instant(suspension_->since) + ": " + suspension_->reason;
    if (window_.bound_lost_since && window_.bound_loss != BoundLoss::kStillOnTheirWay) {
      finding.message += "; the error bound stays infinite until reset is called";
    }
  } else if (restored_ > 0) {
    finding.message = "restored at " + instant(restored_) + ", suspended since " +
                      instant(last_suspension_.since) + ": " + last_suspension_.reason;
  } else {
    finding.message = "valid";
  }
  finding.values.emplace_back("guarantee",
                              subject_.guarantee.empty() ? "none" : subject_.guarantee);
  add_bounds_of_all(finding);
  finding.values.emplace_back("error bound", shown(window_.error_bound));
  return finding;
}

}  // namespace sampled_data_observers
