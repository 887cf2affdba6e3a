#include "sampled_data_observers/config/outputs_config.h"

#include <algorithm>
#include <array>

namespace sampled_data_observers {
namespace {

constexpr double kLongestOffset = 10.0;   // s
constexpr double kLongestTimeout = 10.0;  // s

std::optional<Eigen::Index> position_of(const std::string& name,
                                        const std::vector<std::string>& names) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return found - names.begin();
}

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

BodyNumber read_body_number(ConfigSection& section, const std::string& key,
                            const BodyNames& names) {
  BodyNumber number;
  if (!section.has(key)) return number;
  if (section.is_number(key)) {
    number.constant = section.number(key);
    return number;
  }
  const std::string name = section.text(key);
  number.state = position_of(name, names.states);
  if (!number.state) number.input = position_of(name, names.inputs);
  if (!number.state && !number.input) {
    std::string known = "a number or the name of a state (" + listed(names.states) + ")";
    if (!names.inputs.empty()) known += " or of an input (" + listed(names.inputs) + ")";
    throw section.error(key, known, "'" + name + "'");
  }
  return number;
}

template <std::size_t N>
std::array<BodyNumber, N> read_body_numbers(ConfigSection section,
                                            const std::array<const char*, N>& keys,
                                            const BodyNames& names) {
  std::array<BodyNumber, N> numbers;
  for (std::size_t i = 0; i < N; ++i) numbers[i] = read_body_number(section, keys[i], names);
  section.finish();
  return numbers;
}

void read_orientation(ConfigSection& outputs, const BodyNames& names, BodyStates& body) {
  if (!outputs.has("orientation")) return;
  ConfigSection section = outputs.section("orientation");
  const std::array<const char*, 4> components = {"x", "y", "z", "w"};
  const bool is_quaternion = std::any_of(components.begin(), components.end(),
                                         [&](const char* key) { return section.has(key); });
  if (!is_quaternion) {
    const std::array<const char*, 3> angles = {"roll", "pitch", "yaw"};
    body.roll_pitch_yaw = read_body_numbers(section, angles, names);
    return;
  }
  for (const char* key : components) {
    if (!section.has(key)) {
      throw section.error(key, "all of x, y, z, w (a quaternion), or roll, pitch, yaw",
                          section.absence_of(key));
    }
  }
  body.quaternion = read_body_numbers(section, components, names);
}

std::array<double, 6> read_variances(ConfigSection& section, const std::string& key) {
  std::array<double, 6> variances{};
  if (!section.has(key)) return variances;
  const Eigen::VectorXd values = section.vector(key, 6);
  if (values.minCoeff() < 0.0) throw section.error(key, "six variances >= 0", "a negative one");
  std::copy_n(values.data(), variances.size(), variances.begin());
  return variances;
}

BodyStates read_body(ConfigSection& outputs, const BodyNames& names) {
  const std::array<const char*, 3> axes = {"x", "y", "z"};
  BodyStates body;
  body.position = read_body_numbers(outputs.section_or_empty("position"), axes, names);
  read_orientation(outputs, names, body);
  body.linear_velocity =
      read_body_numbers(outputs.section_or_empty("linear_velocity"), axes, names);
  body.angular_velocity =
      read_body_numbers(outputs.section_or_empty("angular_velocity"), axes, names);
  if (outputs.has("velocity_frame")) {
    body.velocity_in_world = outputs.choice("velocity_frame", {"base", "world"}) == "world";
  }
  body.pose_variances = read_variances(outputs, "pose_covariance_diagonal");
  body.twist_variances = read_variances(outputs, "twist_covariance_diagonal");
  return body;
}

std::optional<std::string> read_topic(ConfigSection& outputs, const std::string& key) {
  if (!outputs.has(key)) return std::nullopt;
  ConfigSection section = outputs.section(key);
  std::string topic = section.text("topic");
  section.finish();
  return topic;
}

TransformOutput read_transform(ConfigSection section) {
  TransformOutput transform;
  if (section.choice("mode", {"odom", "map"}) == "map") {
    transform.odom_frame = section.text("odom_frame");
    transform.timeout = from_seconds(section.number_in("timeout", 0.0, kLongestTimeout, 0.5));
  }
  transform.time_offset = from_seconds(
      section.number_in("transform_time_offset", -kLongestOffset, kLongestOffset, 0.0));
  section.finish();
  return transform;
}

std::size_t count_states(const BodyNumber* numbers, std::size_t size) {
  return static_cast<std::size_t>(std::count_if(
      numbers, numbers + size, [](const BodyNumber& number) { return number.state.has_value(); }));
}

/// An ellipsoid of the pose follows from that of the states where the pose's error is linear in
/// theirs: a rotation about one axis that is known turns by the error of its angle.
bool reads_bounded_pose(ConfigSection& section, const OutputsConfig& outputs, bool has_bound) {
  const std::string key = "pose_covariance";
  if (!section.has(key)) return false;
  if (section.choice(key, {"observer", "guaranteed_ellipsoid"}) == "observer") return false;
  if (!outputs.odometry && !outputs.pose) {
    throw section.error(key, "odometry or pose beside guaranteed_ellipsoid", "neither");
  }
  if (!has_bound) {
    throw section.error(key,
                        "with guaranteed_ellipsoid, error_assumptions and a certificate that "
                        "holds, from which a bound on the error follows",
                        "no such bound");
  }
  const BodyStates& body = outputs.body;
  const std::size_t turns =
      body.quaternion ? 2 * count_states(body.quaternion->data(), body.quaternion->size())
                      : count_states(body.roll_pitch_yaw.data(), body.roll_pitch_yaw.size());
  if (turns > 1) {
    throw section.error(key,
                        "with guaranteed_ellipsoid, one state at most among roll, pitch and yaw: "
                        "the error of a rotation is linear in no more",
                        body.quaternion ? "a quaternion of states" : "several");
  }
  return true;
}

/// What the outputs need to mean anything.
void require_frames(ConfigSection& section, const OutputsConfig& outputs) {
  if (outputs.world_frame.empty()) {
    throw ConfigError(section.origin(), "frame_id",
                      "the name of the world frame, since there are outputs",
                      section.absence_of("frame_id"));
  }
  if (outputs.base_frame.empty() && (outputs.odometry || outputs.twist || outputs.transform)) {
    throw section.error("base_frame", "the name of the body's frame",
                        section.absence_of("base_frame"));
  }
  if (outputs.base_frame == outputs.world_frame) {
    throw section.error("base_frame", "another frame than frame_id",
                        "'" + outputs.base_frame + "'");
  }
  if (!outputs.transform) return;
  const std::string& odom_frame = outputs.transform->odom_frame;
  if (odom_frame == outputs.world_frame || odom_frame == outputs.base_frame) {
    throw section.error("tf", "another odom_frame than frame_id and base_frame",
                        "'" + odom_frame + "'");
  }
}

void require_states(ConfigSection& section, const OutputsConfig& outputs) {
  const bool has_pose = section.has("position") || section.has("orientation");
  const bool has_velocity = section.has("linear_velocity") || section.has("angular_velocity");
  if (!has_pose && (outputs.odometry || outputs.pose || outputs.transform)) {
    throw section.error("position", "the states of the body's position, or of its orientation",
                        "neither");
  }
  if (!has_velocity && outputs.twist) {
    throw section.error("linear_velocity", "the states or inputs of the body's velocity, for twist",
                        "none");
  }
  if (!outputs.odometry && !outputs.pose && !outputs.twist && !outputs.transform) {
    throw section.error("odometry", "one of odometry, pose, twist and tf", "none");
  }
}

}  // namespace

std::optional<OutputsConfig> read_outputs(ConfigSection& root, const BodyNames& names,
                                          const std::string& world_frame, bool has_bound) {
  if (!root.has("outputs")) return std::nullopt;
  ConfigSection section = root.section("outputs");
  OutputsConfig outputs;
  outputs.body = read_body(section, names);
  outputs.world_frame = world_frame;
  outputs.base_frame = section.text("base_frame", "");
  outputs.odometry = read_topic(section, "odometry");
  outputs.pose = read_topic(section, "pose");
  outputs.twist = read_topic(section, "twist");
  if (section.has("tf")) outputs.transform = read_transform(section.section("tf"));
  outputs.pose_is_bounded = reads_bounded_pose(section, outputs, has_bound);
  section.finish();
  require_frames(section, outputs);
  require_states(section, outputs);
  return outputs;
}

}  // namespace sampled_data_observers
