#include "messages/message_covariance.h"

#include <algorithm>
#include <cmath>

#include "linear_algebra/ordered_linear_algebra.h"

namespace sampled_data_observers {
namespace {

using Derived = MessageField::Derived;

/// Of a vector's component, or of an angle or a place that follows from a part of the message.
std::optional<std::size_t> component_of(const std::string& last, Derived derived) {
  switch (derived) {
    case Derived::kRoll:
    case Derived::kEast:
      return 0;
    case Derived::kPitch:
    case Derived::kNorth:
      return 1;
    case Derived::kYaw:
    case Derived::kUp:
      return 2;
    case Derived::kNone:
      break;
  }
  if (last == "x") return 0;
  if (last == "y") return 1;
  if (last == "z") return 2;
  return std::nullopt;
}

bool is_scalar_with_variance(const std::string& type, const std::string& member) {
  return (type == "sensor_msgs/FluidPressure" && member == "fluid_pressure") ||
         (type == "sensor_msgs/Temperature" && member == "temperature") ||
         (type == "sensor_msgs/RelativeHumidity" && member == "relative_humidity") ||
         (type == "sensor_msgs/Illuminance" && member == "illuminance");
}

bool has_pose_or_twist(const std::string& type) {
  return type == "geometry_msgs/PoseWithCovariance" ||
         type == "geometry_msgs/TwistWithCovariance" || type == "geometry_msgs/AccelWithCovariance";
}

bool is_of_matrix(const std::string& type, const std::string& member) {
  return (type == "sensor_msgs/Imu" && (member == "orientation" || member == "angular_velocity" ||
                                        member == "linear_acceleration")) ||
         (type == "sensor_msgs/MagneticField" && member == "magnetic_field");
}

}  // namespace

std::string CovarianceFields::member_at(const MessageDefinition& definition,
                                        const MessagePath& path, std::size_t depth) {
  if (depth >= path.size()) return "";
  const MessagePath within(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(depth));
  return definition.members(type_at(definition, within))[path[depth].member].name;
}

std::optional<CovarianceFields::Place> CovarianceFields::place_of(
    const MessageDefinition& definition, const MessageField& field) {
  const MessagePath& path = field.path;
  for (std::size_t depth = 0; depth <= path.size(); ++depth) {
    const MessagePath within(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(depth));
    const std::string& type = type_at(definition, within);
    if (type == "sensor_msgs/NavSatFix" && field.is_in_plane()) {
      return Place{path_to(definition, within, {"position_covariance"}), 3,
                   *component_of("", field.derived)};
    }
    if (depth == path.size()) break;
    const std::string member = member_at(definition, path, depth);
    if (is_scalar_with_variance(type, member)) {
      return Place{path_to(definition, within, {"variance"}), 1, 0};
    }
    const std::string last = member_at(definition, path, path.size() - 1);
    const std::optional<std::size_t> component = component_of(last, field.derived);
    if (!component) continue;
    const bool is_angle = field.derived != Derived::kNone;
    if (is_of_matrix(type, member)) {
      if (member == "orientation" && !is_angle) return std::nullopt;
      return Place{path_to(definition, within, {member + "_covariance"}), 3, *component};
    }
    if (has_pose_or_twist(type) && member != "covariance") {
      const std::string half = member_at(definition, path, depth + 1);
      if (half == "orientation" && !is_angle) return std::nullopt;
      const bool is_second = half == "orientation" || half == "angular";
      return Place{path_to(definition, within, {"covariance"}), 6,
                   *component + (is_second ? 3U : 0U)};
    }
  }
  return std::nullopt;
}

MessagePath CovarianceFields::Place::path_with(const Place& other) const {
  MessagePath path = array;
  if (rows > 1) {
    path.back().entry = PathStep::Entry::kIndex;
    path.back().index = index * rows + other.index;
  }
  return path;
}

std::optional<MessagePath> CovarianceFields::type_of(const MessageDefinition& definition,
                                                     const Place& place) {
  const MessagePath within(place.array.begin(), place.array.end() - 1);
  if (type_at(definition, within) != "sensor_msgs/NavSatFix") return std::nullopt;
  return path_to(definition, within, {"position_covariance_type"});
}

CovarianceFields::CovarianceFields(const TopicSource& source, const MessageDefinition& definition,
                                   PlanCompiler& compiler)
    : outputs_(source.fields.size()), factor_(outputs_ * outputs_) {
  std::vector<Place> places;
  for (const std::string& text : source.fields) {
    const std::optional<MessageField> field = find_field(definition, text);
    const std::optional<Place> place = field ? place_of(definition, *field) : std::nullopt;
    if (!place) {
      throw ConfigError(source.origin, source.path + "/fields",
                        "fields that the message gives a covariance of, for an R from the message: "
                        "of poses, twists and accelerations with covariance (position and angles), "
                        "Imu, MagneticField, NavSatFix (east, north, up), and numbers beside a "
                        "variance",
                        "'" + text + "' of " + source.type);
    }
    places.push_back(*place);
  }
  for (std::size_t i = 0; i < outputs_; ++i) {
    for (std::size_t j = 0; j <= i; ++j) add(source, places[i], places[j], i, j, compiler);
    const std::optional<MessagePath> type = type_of(definition, places[i]);
    if (type) types_.push_back(compiler.want_number(*type));
  }
}

void CovarianceFields::add(const TopicSource& source, const Place& row, const Place& column,
                           std::size_t i, std::size_t j, PlanCompiler& compiler) {
  Entry& entry = entries_.emplace_back();
  entry.is_variance = i == j;
  const MessageCovariance& wanted = *source.covariance;
  const auto scale = [&](std::size_t value) {
    const Eigen::VectorXd& scales = source.correction.scale;
    return scales.size() == 0 ? 1.0 : scales(static_cast<Eigen::Index>(value));
  };
  entry.factor = wanted.scale * scale(i) * scale(j);
  if (i == j) entry.floor = wanted.floor(static_cast<Eigen::Index>(i));
  if (!(row.array == column.array)) return;
  entry.slot = compiler.want_number(row.path_with(column));
}

bool CovarianceFields::read(const DecodedMessage& message, double* R) {
  const bool is_known = std::all_of(types_.begin(), types_.end(),
                                    [&](std::size_t slot) { return message.number(slot) != 0.0; });
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    const Entry& entry = entries_[k];
    const double found = entry.slot && is_known ? message.number(*entry.slot) : 0.0;
    if (!std::isfinite(found) || (entry.is_variance && found < 0.0)) return false;
    R[k] = entry.factor * found;
    if (entry.is_variance) R[k] = std::max(R[k], entry.floor);
  }
  const auto m = static_cast<Eigen::Index>(outputs_);
  unpack_lower(R, m, factor_.data());
  return factor_cholesky(factor_.data(), m);
}

}  // namespace sampled_data_observers
