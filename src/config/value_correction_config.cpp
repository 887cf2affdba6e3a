#include "config/value_correction_config.h"

#include <string>

namespace sampled_data_observers {
namespace {

constexpr double kLargestStampOffset = 1e6;  // s

/// One number for all values, or a list of one for each; nothing where there is none.
Eigen::VectorXd read_numbers(ConfigSection& source, const char* key, Eigen::Index size) {
  if (!source.has(key)) return {};
  if (source.is_number(key)) return Eigen::VectorXd::Constant(size, source.number(key));
  return source.vector(key, size);
}

}  // namespace

ValueCorrection read_value_correction(ConfigSection& source, std::size_t size) {
  const auto values = static_cast<Eigen::Index>(size);
  ValueCorrection correction;
  correction.scale = read_numbers(source, "scale", values);
  correction.offset = read_numbers(source, "offset", values);
  for (Eigen::Index i = 0; i < correction.scale.size(); ++i) {
    if (correction.scale(i) == 0.0) throw source.error("scale", "numbers other than 0", "0");
  }
  if (!source.has("limits")) return correction;
  const std::string expected = "[lowest, highest] for all values, or a list of " +
                               std::to_string(size) + " such, lowest < highest";
  const std::vector<Eigen::VectorXd> limits = source.vectors("limits");
  if (limits.size() != 1 && limits.size() != size) {
    throw source.error("limits", expected, std::to_string(limits.size()) + " of them");
  }
  for (std::size_t i = 0; i < size; ++i) {
    const Eigen::VectorXd& of_value = limits[limits.size() == 1 ? 0 : i];
    if (of_value.size() != 2 || !(of_value(0) < of_value(1))) {
      throw source.error("limits", expected, "others");
    }
    correction.limits.emplace_back(of_value);
  }
  return correction;
}

Duration read_stamp_offset(ConfigSection& source) {
  return from_seconds(
      source.number_in("stamp_offset", -kLargestStampOffset, kLargestStampOffset, 0.0));
}

}  // namespace sampled_data_observers
