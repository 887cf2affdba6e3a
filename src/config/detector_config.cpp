#include "sampled_data_observers/config/detector_config.h"

#include "config/expression_config.h"

namespace sampled_data_observers {

DetectorConfig read_detector(ConfigSection& section, const std::vector<std::string>& fields) {
  constexpr double kLargest = 1e100;
  constexpr double kLongest = 1e6;  // s
  ExpressionNames names;
  names.x = fields;
  DetectorConfig detector;
  const ExpressionReader formulas(names);
  detector.signal = formulas.read_text(section, "signal");
  constexpr std::size_t kAnyNumber = 0;
  if (section.has("outputs")) {
    detector.outputs = formulas.read_list(section, "outputs", kAnyNumber);
  }
  JumpDetector::Options& options = detector.options;
  options.threshold = section.number_in("threshold", -kLargest, kLargest, std::nullopt);
  options.hysteresis = section.number_in("hysteresis", 0.0, kLargest, 0.0);
  if (section.has("direction")) {
    options.rising = section.choice("direction", {"rising", "falling"}) == "rising";
  }
  options.refractory = from_seconds(section.number_in("refractory", 0.0, kLongest, 0.0));
  return detector;
}

}  // namespace sampled_data_observers
