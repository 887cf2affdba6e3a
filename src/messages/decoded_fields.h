#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "messages/definition/plan_compiler.h"
#include "messages/local_plane.h"
#include "sampled_data_observers/config/topic_config.h"
#include "sampled_data_observers/messages/message_source.h"

namespace sampled_data_observers {

/// The values of an event in the messages of one definition: of a jump of a switched plant, the
/// mode first. What a nested type means, it means wherever it stands: the angles of a
/// geometry_msgs/Quaternion, a sensor_msgs/Imu that says what it does not measure, a
/// sensor_msgs/Range outside of its own limits, a sensor_msgs/NavSatFix without a fix and where it
/// is in the local plane.
class DecodedFields {
 public:
  /// Asks the compiler for all that they take.
  /// @param plane  null: there is none
  /// @throws ConfigError for a field that the definition does not have, or too few, or one that
  /// takes a plane where there is none.
  DecodedFields(const TopicSource& source, const MessageDefinition& definition,
                PlanCompiler& compiler, std::shared_ptr<LocalPlane> plane);

  std::size_t size() const { return values_.size(); }
  /// Where each of them comes from.
  const std::vector<MessagePath>& paths() const { return paths_; }

  /// Computes them into memory for size() values. Returns kEvent, kNoField where the message does
  /// not hold one of them, or kBeforeDatum.
  Reading read(const DecodedMessage& message, Stamp stamp, double* values) const;

  /// Told that those read last are used.
  void confirm() const {
    if (is_in_plane_) plane_->confirm();
  }

 private:
  using Derived = MessageField::Derived;
  struct Value {
    Derived derived = Derived::kNone;
    /// Of the number, of x, y, z and w, or of latitude, longitude and altitude.
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

  double angle(const Value& value, const DecodedMessage& message) const;
  bool read_in_plane(const DecodedMessage& message, Stamp stamp, double* values) const;

  std::shared_ptr<LocalPlane> plane_;
  bool is_in_plane_ = false;  ///< whether a value is
  std::vector<Value> values_;
  std::vector<Condition> conditions_;
  std::vector<MessagePath> paths_;
};

}  // namespace sampled_data_observers
