#include "config/event_times.h"

#include <limits>

namespace sampled_data_observers {
namespace {

constexpr double kNoLongest = std::numeric_limits<double>::infinity();
constexpr double kShortestDwellTime = 1e-9;  // s: one tick of the clock
constexpr double kLongestTimeBetween = 1e6;  // s
constexpr std::size_t kMostN0 = 10000;

}  // namespace

DwellTime read_dwell_time(ConfigSection section, DwellTime::Kind kind) {
  DwellTime dwell_time;
  dwell_time.kind = kind;
  dwell_time.tau = section.number_in("tau", kShortestDwellTime, kLongestTimeBetween, std::nullopt);
  section.number("N0");
  dwell_time.N0 = static_cast<double>(section.count("N0", 1, kMostN0, 1));
  section.finish();
  return dwell_time;
}

double read_longest_time(ConfigSection& section, double least) {
  return section.number_or_infinity_in("T2", least, kLongestTimeBetween);
}

std::optional<DwellTime> read_dwell_time(ConfigSection& section) {
  const bool has_average = section.has(kAverageDwellTime);
  const bool has_reverse = section.has(kReverseAverageDwellTime);
  if (has_average && has_reverse) {
    throw section.error(kReverseAverageDwellTime,
                        "one of average_dwell_time and reverse_average_dwell_time", "both");
  }
  if (has_average) {
    return read_dwell_time(section.section(kAverageDwellTime), DwellTime::Kind::kAverage);
  }
  if (has_reverse) {
    return read_dwell_time(section.section(kReverseAverageDwellTime),
                           DwellTime::Kind::kReverseAverage);
  }
  return std::nullopt;
}

void read_event_times(ConfigSection& section, CertificateSubject& subject) {
  subject.dwell_time = read_dwell_time(section);
  if (subject.dwell_time) {
    subject.T1 = 0.0;
    subject.T2 = kNoLongest;
    return;
  }
  subject.T1 = section.number("T1");
  if (subject.T1 < 0.0) throw section.error("T1", "a number not less than 0", "a negative one");
  subject.T2 = read_longest_time(section, 0.0);
  if (subject.T1 > subject.T2) throw section.error("T2", "0 <= T1 <= T2", "T1 > T2");
}

}  // namespace sampled_data_observers
