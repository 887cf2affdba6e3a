// What diagnostics say of the times between events, and of innovations.
#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/diagnosis_text.h"
#include "sampled_data_observers/runtime/diagnosis.h"

namespace sampled_data_observers {

using diagnosis_text::longest;
using diagnosis_text::seconds;

const SamplingBounds& DiagnosisSubject::sampling_of(const Channel& channel) const {
  return sampling.of(channel.kind, channel.sensor);
}

std::string describe_unit_of_times(double mean, double T1, double T2) {
  constexpr double kFar = 100.0;
  if (mean > 0.0 && T1 >= kFar * mean) {
    return "T1 is " + diagnosis_text::shown(std::round(T1 / mean)) +
           " times the mean time between samples: are T1 and T2 in seconds?";
  }
  if (T2 > 0.0 && mean >= kFar * T2) {
    return "the mean time between samples is " + diagnosis_text::shown(std::round(mean / T2)) +
           " times T2: are T1 and T2 in seconds?";
  }
  return "";
}

/// Those of a channel of samples. How long ago the last one was, by its stamp, says whether it is
/// late before the next one comes.
void Diagnosis::add_times_between_samples(std::size_t index, Finding& finding) const {
  const SamplingBounds& bounds = subject_.sampling_of(subject_.channels[index]);
  const ChannelStatistics& total = totals_.channels[index];
  const Stamp newest = memory_[index].newest;
  const Duration since = newest > 0 ? std::max<Duration>(now_ - newest, 0) : 0;
  const bool is_late = since > bounds.T2;
  finding.values.insert(
      finding.values.end(),
      {{"T1", seconds(bounds.T1)},
       {"T2", longest(bounds.T2)},
       {"time between samples", diagnosis_text::extremes(window_.channels[index].interval)},
       {"below T1 in all", std::to_string(total.short_intervals)},
       {"above T2 in all", std::to_string(total.long_intervals)},
       {"time since the last sample", newest > 0 ? seconds(since) : "none"},
       {"late now", is_late ? "by " + seconds(since - bounds.T2) : "no"}});
}

/// Of all time, since a bias shows in many only.
void Diagnosis::add_innovations(std::size_t index, Finding& finding) const {
  const InnovationStatistics& innovations = totals_.channels[index].innovations;
  if (innovations.count == 0) return;
  const std::size_t outputs = subject_.channels[index].outputs;
  std::string mean;
  std::string rms;
  for (std::size_t i = 0; i < std::min(outputs, innovations.sums.size()); ++i) {
    mean += (i > 0 ? ", " : "") + diagnosis_text::shown(innovations.mean(i));
    rms += (i > 0 ? ", " : "") + diagnosis_text::shown(innovations.rms(i));
  }
  finding.values.emplace_back("innovation, mean in all", mean);
  finding.values.emplace_back("innovation, RMS in all", rms);
  if (innovations.nis_count == 0) return;
  finding.values.emplace_back("normalized innovation squared, mean in all",
                              diagnosis_text::shown(innovations.nis()) + " (" +
                                  std::to_string(outputs) + " where the model is right)");
}

/// T1 and T2, by sensor where they differ.
void Diagnosis::add_bounds_of_all(Finding& finding) const {
  const SamplingBounds& all = subject_.sampling.of_all();
  std::vector<std::pair<std::string, std::string>> by_sensor;
  bool differ = false;
  for (const DiagnosisSubject::Channel& channel : subject_.channels) {
    if (channel.kind != EventKind::kSample) continue;
    const SamplingBounds& bounds = subject_.sampling_of(channel);
    differ = differ || bounds.T1 != all.T1 || bounds.T2 != all.T2;
    by_sensor.emplace_back("T1 of " + channel.name, seconds(bounds.T1));
    by_sensor.emplace_back("T2 of " + channel.name, longest(bounds.T2));
  }
  if (!differ) by_sensor = {{"T1", seconds(all.T1)}, {"T2", longest(all.T2)}};
  finding.values.insert(finding.values.end(), by_sensor.begin(), by_sensor.end());
}

}  // namespace sampled_data_observers
