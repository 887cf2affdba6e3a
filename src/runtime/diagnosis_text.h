#pragma once

#include <cstdint>
#include <locale>
#include <sstream>
#include <string>

#include "sampled_data_observers/hybrid/time.h"
#include "sampled_data_observers/runtime/range_recorder.h"

// Figures as Diagnosis shows them.
namespace sampled_data_observers::diagnosis_text {

/// A sensor that was silent for longer than this, and than T2, is reported.
constexpr Duration kSilence = 2 * kNanosecondsPerSecond;

inline std::string shown(double value) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(6);
  out << value;
  return out.str();
}

inline std::string seconds(Duration duration) { return shown(to_seconds(duration)) + " s"; }

inline std::string longest(Duration duration) { return shown(longest_to_seconds(duration)) + " s"; }

/// All digits that matter: six would not do for the seconds since 1970.
inline std::string instant(Stamp stamp) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(3);
  out << std::fixed << to_seconds(stamp) << " s";
  return out.str();
}

inline std::string in_milliseconds(double nanoseconds) { return shown(nanoseconds * 1e-6) + " ms"; }

inline std::string in_milliseconds(std::int64_t nanoseconds) {
  return in_milliseconds(static_cast<double>(nanoseconds));
}

/// "smallest … largest", empty where nothing was recorded.
inline std::string extremes(const Range& range) {
  if (range.count == 0) return "none";
  return in_milliseconds(range.smallest) + " to " + in_milliseconds(range.largest);
}

}  // namespace sampled_data_observers::diagnosis_text
