#include "sampled_data_observers/config/detector_config.h"

#include "config/expression_config.h"

namespace sampled_data_observers {
namespace {

using Direction = JumpDetector::Direction;
using Kind = JumpDetector::Kind;
using Options = JumpDetector::Options;

constexpr double kLargest = 1e100;
constexpr double kLongestSpan = 1e6;  // s
constexpr std::size_t kLongestWindow = 1000;
constexpr std::size_t kFewestForScale = 20;
constexpr std::size_t kMostForScale = 10000;
constexpr std::size_t kForScale = 500;

Kind read_kind(ConfigSection& section) {
  if (!section.has("kind")) return Kind::kThreshold;
  const std::string kind = section.choice("kind", {"threshold", "deviation", "step", "guard"});
  if (kind == "deviation") return Kind::kDeviation;
  if (kind == "step") return Kind::kStep;
  return kind == "guard" ? Kind::kGuard : Kind::kThreshold;
}

Direction read_direction(ConfigSection& section, const std::vector<std::string>& choices) {
  if (!section.has("direction")) return Direction::kRising;
  const std::string direction = section.choice("direction", choices);
  if (direction == "either") return Direction::kEither;
  return direction == "rising" ? Direction::kRising : Direction::kFalling;
}

/// A number above 0 of this key.
double read_positive(ConfigSection& section, const std::string& key) {
  const double number = section.number_in(key, 0.0, kLargest, std::nullopt);
  if (number > 0.0) return number;
  throw section.error(key, "a number above 0", section.text(key));
}

void read_noise(ConfigSection& detector, Options& options) {
  ConfigSection section = detector.section("noise");
  options.noise_factor = read_positive(section, "factor");
  options.noise_samples = section.count("samples", kFewestForScale, kMostForScale, kForScale);
  section.finish();
}

/// What is particular to its kind.
void read_jump(ConfigSection& section, Options& options) {
  options.kind = read_kind(section);
  switch (options.kind) {
    case Kind::kThreshold:
      options.threshold = section.number_in("threshold", -kLargest, kLargest, std::nullopt);
      options.direction = read_direction(section, {"rising", "falling"});
      break;
    case Kind::kDeviation:
      options.threshold = read_positive(section, "threshold");
      options.direction = read_direction(section, {"rising", "falling", "either"});
      read_noise(section, options);
      break;
    case Kind::kStep:
      options.threshold = read_positive(section, "threshold");
      options.direction = read_direction(section, {"rising", "falling", "either"});
      options.window = section.count("window", 1, kLongestWindow, 1);
      if (section.has("noise")) read_noise(section, options);
      return;  // a step has no hysteresis
    case Kind::kGuard: {
      ExpressionNames names;
      names.x = {"signal", "since"};
      options.guard = ExpressionReader(names).read_text(section, "when");
      break;
    }
  }
  options.hysteresis = section.number_in("hysteresis", 0.0, kLargest, 0.0);
}

}  // namespace

DetectorConfig read_detector(ConfigSection& section, const std::vector<std::string>& fields) {
  ExpressionNames names;
  names.x = fields;
  DetectorConfig detector;
  const ExpressionReader formulas(names);
  detector.signal = formulas.read_text(section, "signal");
  constexpr std::size_t kAnyNumber = 0;
  if (section.has("outputs")) {
    detector.outputs = formulas.read_list(section, "outputs", kAnyNumber);
  }
  if (section.has("mode")) detector.mode = formulas.read_text(section, "mode");
  Options& options = detector.options;
  read_jump(section, options);
  options.refractory = from_seconds(section.number_in("refractory", 0.0, kLongestSpan, 0.0));
  if (section.has("energy")) {
    ConfigSection energy = section.section("energy");
    detector.energy = formulas.read_text(energy, "formula");
    options.least_energy = energy.number_in("at_least", -kLargest, kLargest, std::nullopt);
    energy.finish();
  }
  return detector;
}

}  // namespace sampled_data_observers
