#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "messages/definition/plan_compiler.h"
#include "sampled_data_observers/config/topic_config.h"

namespace sampled_data_observers {

/// The values of an event in the messages of one definition: of a jump of a switched plant, the
/// mode first. What a nested type means, it means wherever it stands: the angles of a
/// geometry_msgs/Quaternion, a sensor_msgs/Imu that says what it does not measure, a
/// sensor_msgs/Range outside of its own limits, a sensor_msgs/NavSatFix without a fix.
class DecodedFields {
 public:
  /// Asks the compiler for all that they take.
  /// @throws ConfigError for a field that the definition does not have, or too few.
  DecodedFields(const TopicSource& source, const MessageDefinition& definition,
                PlanCompiler& compiler);

  std::size_t size() const { return values_.size(); }
  /// Where each of them comes from.
  const std::vector<MessagePath>& paths() const { return paths_; }

  /// Computes them into memory for size() values; returns false where the message does not hold one
  /// of them.
  bool read(const DecodedMessage& message, double* values) const;

 private:
  using Angle = MessageField::Angle;
  struct Value {
    Angle angle = Angle::kNone;
    /// Of the number, or of x, y, z and w.
    std::array<std::size_t, 4> slots{};
  };
  struct Condition {
    enum class Kind : std::uint8_t {
      kNotMinusOne,  ///< slot 0
      kWithin,       ///< slot 0 between slots 1 and 2, where these are limits
      kNotNegative   ///< slot 0
    };
    Kind kind = Kind::kNotMinusOne;
    std::array<std::size_t, 3> slots{};
  };

  void add(const TopicSource& source, const std::string& key, const std::string& text,
           const MessageDefinition& definition, PlanCompiler& compiler);
  void add_conditions(const MessagePath& path, const MessageDefinition& definition,
                      PlanCompiler& compiler);
  static bool holds(const Condition& condition, const DecodedMessage& message);

  std::vector<Value> values_;
  std::vector<Condition> conditions_;
  std::vector<MessagePath> paths_;
};

}  // namespace sampled_data_observers
