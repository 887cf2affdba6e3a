#include "messages/decoded_fields.h"

#include <utility>

#include "messages/rotation_angles.h"

namespace sampled_data_observers {

DecodedFields::DecodedFields(const TopicSource& source, const MessageDefinition& definition,
                             PlanCompiler& compiler, std::shared_ptr<LocalPlane> plane)
    : plane_(std::move(plane)) {
  if (source.has_mode) add(source, "mode", source.mode, definition, compiler);
  for (const std::string& text : source.fields) add(source, "fields", text, definition, compiler);
  const bool lacks_fields = !source.of_jumps && source.fields.empty();
  if (lacks_fields) add(source, "fields", "", definition, compiler);
}

void DecodedFields::add(const TopicSource& source, const std::string& key, const std::string& text,
                        const MessageDefinition& definition, PlanCompiler& compiler) {
  const std::optional<MessageField> field = find_field(definition, text);
  if (!field) {
    throw ConfigError(
        source.origin, source.path + "/" + key,
        "fields of " + source.type + ", one per value: " + describe_fields(definition),
        text.empty() ? "none" : "'" + text + "'");
  }
  Value value;
  value.derived = field->derived;
  const auto want = [&](const std::vector<std::string>& parts) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      value.slots[i] = compiler.want_number(path_to(definition, field->path, {parts[i]}));
    }
  };
  MessagePath path = field->path;
  if (field->is_in_plane()) {
    if (plane_ == nullptr) {
      throw ConfigError(source.origin, source.path + "/" + key,
                        "navsat/datum beside it: from where east, north and up are measured",
                        "'" + text + "' without");
    }
    is_in_plane_ = true;
    want({"latitude", "longitude", "altitude"});
    path = path_to(definition, path, {"latitude"});
  } else if (field->derived == Derived::kNone) {
    value.slots[0] = compiler.want_number(path);
  } else {
    want({"x", "y", "z", "w"});
  }
  values_.push_back(value);
  paths_.push_back(path);
  add_conditions(path, definition, compiler);
}

void DecodedFields::add_conditions(const MessagePath& path, const MessageDefinition& definition,
                                   PlanCompiler& compiler) {
  using Kind = Condition::Kind;
  for (std::size_t depth = 0; depth < path.size(); ++depth) {
    const MessagePath within(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(depth));
    const std::string& type = type_at(definition, within);
    const std::string& member = definition.members(type)[path[depth].member].name;
    const auto number = [&](const std::vector<std::string>& names) {
      return compiler.want_number(path_to(definition, within, names));
    };
    const bool is_of_imu =
        type == "sensor_msgs/Imu" && (member == "orientation" || member == "angular_velocity" ||
                                      member == "linear_acceleration");
    if (is_of_imu) {
      MessagePath variance = path_to(definition, within, {member + "_covariance"});
      variance.back().entry = PathStep::Entry::kIndex;
      conditions_.push_back({Kind::kNotMinusOne, {compiler.want_number(variance)}});
    } else if (type == "sensor_msgs/Range" && member == "range") {
      conditions_.push_back(
          {Kind::kWithin, {number({"range"}), number({"min_range"}), number({"max_range"})}});
    } else if (type == "sensor_msgs/NavSatFix" && member != "header") {
      conditions_.push_back({Kind::kNotNegative, {number({"status", "status"})}});
    }
  }
}

bool DecodedFields::holds(const Condition& condition, const DecodedMessage& message) {
  const double value = message.number(condition.slots[0]);
  switch (condition.kind) {
    case Condition::Kind::kNotMinusOne:
      return value != -1.0;
    case Condition::Kind::kNotNegative:
      return value >= 0.0;
    case Condition::Kind::kWithin:
      break;
  }
  const double least = message.number(condition.slots[1]);
  const double most = message.number(condition.slots[2]);
  const bool is_limited = least < most;
  return !is_limited || (least <= value && value <= most);
}

/// Values in the local plane; returns false for those of before its datum.
bool DecodedFields::read_in_plane(const DecodedMessage& message, Stamp stamp,
                                  double* values) const {
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const Value& value = values_[i];
    if (value.derived < Derived::kEast) continue;
    const auto number = [&](std::size_t slot) { return message.number(value.slots[slot]); };
    const std::optional<Eigen::Vector3d> point =
        plane_->project({number(0), number(1), number(2)}, stamp);
    if (!point) return false;
    const int axis = static_cast<int>(value.derived) - static_cast<int>(Derived::kEast);
    values[i] = (*point)(axis);
  }
  return true;
}

double DecodedFields::angle(const Value& value, const DecodedMessage& message) const {
  const auto number = [&](std::size_t slot) { return message.number(value.slots[slot]); };
  const RotationQuaternion q{number(0), number(1), number(2), number(3)};
  if (value.derived == Derived::kRoll) return roll_of(q);
  return value.derived == Derived::kPitch ? pitch_of(q) : yaw_of(q);
}

Reading DecodedFields::read(const DecodedMessage& message, Stamp stamp, double* values) const {
  for (const Condition& condition : conditions_) {
    if (!holds(condition, message)) return Reading::kNoField;
  }
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const Value& value = values_[i];
    if (!message.holds(value.slots[0])) return Reading::kNoField;
    if (value.derived >= Derived::kEast) continue;
    values[i] =
        value.derived == Derived::kNone ? message.number(value.slots[0]) : angle(value, message);
  }
  const bool counts = !is_in_plane_ || read_in_plane(message, stamp, values);
  return counts ? Reading::kEvent : Reading::kBeforeDatum;
}

}  // namespace sampled_data_observers
