#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/plant/vector_map.h"
#include "sampled_data_observers/runtime/jump_detector.h"

namespace sampled_data_observers {

/// How jumps are detected in the fields of messages.
struct DetectorConfig {
  /// From one value per field to the signal.
  std::shared_ptr<const VectorMap> signal;
  /// From them to the energy that must be reached between jumps; null where none must.
  std::shared_ptr<const VectorMap> energy;
  /// From them to the outputs measured at a jump, evaluated for the message that shows it, or for
  /// the last one before a step; null where it tells none.
  std::shared_ptr<const VectorMap> outputs;
  /// From them to the label of the mode that follows, evaluated for the newest message; null where
  /// it tells none.
  std::shared_ptr<const VectorMap> mode;
  /// What of the signal is a jump.
  JumpDetector::Options options;
  /// How far a stamp may lie after the time of its arrival [ns].
  Duration future_tolerance = kNanosecondsPerSecond / 2;
  /// By how much time may go back and is taken for corrected [ns].
  Duration jump_back_tolerance = kNanosecondsPerSecond;
};

/// Reads the signal of a section `detector` and what is looked for in it; other keys of the section
/// are left alone.
/// @param section  `detector`
/// @param fields   the names of the fields, which the formulas of what is read from them may use
/// @throws ConfigError for the first fault found.
DetectorConfig read_detector(ConfigSection& section, const std::vector<std::string>& fields);

}  // namespace sampled_data_observers
