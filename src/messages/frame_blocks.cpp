#include "messages/frame_blocks.h"

#include <algorithm>
#include <set>

namespace sampled_data_observers {
namespace {

using Names = std::vector<std::string>;

Eigen::Vector3d vector_at(const DecodedMessage& message, const std::size_t* slots) {
  return {message.number(slots[0]), message.number(slots[1]), message.number(slots[2])};
}

Eigen::Quaterniond quaternion_at(const DecodedMessage& message, const std::size_t* slots) {
  return {message.number(slots[3]), message.number(slots[0]), message.number(slots[1]),
          message.number(slots[2])};
}

void assign(const Eigen::Vector3d& from, const std::size_t* slots, DecodedMessage& message) {
  for (int i = 0; i < 3; ++i) message.number(slots[i]) = from(i);
}

void assign(const Eigen::Quaterniond& from, const std::size_t* slots, DecodedMessage& message) {
  message.number(slots[0]) = from.x();
  message.number(slots[1]) = from.y();
  message.number(slots[2]) = from.z();
  message.number(slots[3]) = from.w();
}

void rotate(const Eigen::Isometry3d& transform, const std::size_t* slots, DecodedMessage& message) {
  assign(transform.linear() * vector_at(message, slots), slots, message);
}

/// Of twists (free: ω, bound: v) and wrenches (free: f, bound: τ) alike.
void transform_screw(const Eigen::Isometry3d& transform, const std::size_t* free,
                     const std::size_t* bound, DecodedMessage& message) {
  rotate(transform, free, message);
  assign(transform.linear() * vector_at(message, bound) +
             transform.translation().cross(vector_at(message, free)),
         bound, message);
}

bool has_child_frame(const MessageDefinition& definition) {
  const std::vector<MessageMember>& members = definition.members(definition.type());
  return std::any_of(members.begin(), members.end(), [](const MessageMember& member) {
    return member.name == "child_frame_id" && member.type == "string" && !member.is_several;
  });
}

/// The names of the members of a type that has only those.
Names member_names(const MessageDefinition& definition, const std::string& type) {
  Names names;
  for (const MessageMember& member : definition.members(type)) names.push_back(member.name);
  return names;
}

}  // namespace

std::optional<FrameBlocks::Kind> FrameBlocks::kind_of(const std::string& type) {
  if (type == "geometry_msgs/Point" || type == "geometry_msgs/Point32") return Kind::kPoint;
  if (type == "geometry_msgs/Vector3") return Kind::kVector;
  if (type == "geometry_msgs/Pose" || type == "geometry_msgs/Transform") return Kind::kPose;
  if (type == "geometry_msgs/Twist") return Kind::kTwist;
  if (type == "geometry_msgs/Wrench") return Kind::kWrench;
  if (type == "geometry_msgs/Accel") return Kind::kAccel;
  if (type == "sensor_msgs/Imu") return Kind::kImu;
  return std::nullopt;
}

/// Whether there is one anywhere, or a pose that is one of its own.
bool FrameBlocks::has_block(const MessageDefinition& definition, bool is_pose) {
  std::set<std::string> seen = {definition.type()};
  std::vector<std::string> left = {definition.type()};
  while (!left.empty()) {
    const std::string type = left.back();
    left.pop_back();
    const std::optional<Kind> kind = kind_of(type);
    if (kind && (!is_pose || *kind == Kind::kPose)) return true;
    for (const MessageMember& member : definition.members(type)) {
      const bool is_looked_into =
          member.type.find('/') != std::string::npos && !(is_pose && member.is_several);
      if (is_looked_into && seen.insert(member.type).second) left.push_back(member.type);
    }
  }
  return false;
}

FrameBlocks::FrameBlocks(const TopicSource& source, const MessageDefinition& definition,
                         const std::vector<MessagePath>& fields, PlanCompiler& compiler)
    : frames_(source.frames) {
  if (!frames_.any()) return;
  has_child_ = has_child_frame(definition);
  require_use(source, definition);
  for (const MessagePath& field : fields) add(source, definition, field, compiler);
  if (const std::optional<MessagePath> header = find_header(definition)) {
    header_frame_ = compiler.want_text(path_to(definition, *header, {"frame_id"}));
  }
  if (has_child_) child_frame_ = compiler.want_text(path_to(definition, {}, {"child_frame_id"}));
}

void FrameBlocks::require_use(const TopicSource& source,
                              const MessageDefinition& definition) const {
  const bool is_pose = true;
  const bool has_frame = find_header(definition) && has_block(definition, !is_pose);
  if (!frames_.frame.empty() && !has_frame) {
    throw ConfigError(source.origin, source.path + "/frame",
                      "none (nothing in " + source.type + " depends on a frame)",
                      "'" + frames_.frame + "'");
  }
  if (frames_.body_frame.empty()) return;
  if (!find_header(definition) || !has_block(definition, is_pose)) {
    throw ConfigError(source.origin, source.path + "/body_frame",
                      "none (" + source.type + " is not the pose of a sensor; see frame)",
                      "'" + frames_.body_frame + "'");
  }
  if (frames_.sensor_frame.empty() && !has_child_) {
    throw ConfigError(source.origin, source.path + "/sensor_frame",
                      "the frame of the sensor (" + source.type + " does not name it)",
                      "nothing (the key is missing)");
  }
}

/// The block that a field lies in.
void FrameBlocks::add(const TopicSource& source, const MessageDefinition& definition,
                      const MessagePath& field, PlanCompiler& compiler) {
  MessagePath path;
  std::optional<Kind> kind = kind_of(definition.type());
  while (!kind && path.size() < field.size()) {
    if (type_at(definition, path) == "geometry_msgs/Quaternion") {
      throw ConfigError(source.origin, source.path + "/frame",
                        "none (nobody can tell whose orientation the quaternion in " + source.type +
                            " is, outside of a pose)",
                        "one");
    }
    path.push_back(field[path.size()]);
    kind = kind_of(type_at(definition, path));
  }
  if (!kind || std::find(known_.begin(), known_.end(), path) != known_.end()) return;
  known_.push_back(path);
  Block block;
  block.kind = *kind;
  block.is_of_child = *kind == Kind::kTwist && has_child_;
  std::size_t next = 0;
  const auto add_numbers = [&](const MessagePath& to) {
    for (const std::string& name : member_names(definition, type_at(definition, to))) {
      block.slots[next++] = compiler.want_number(path_to(definition, to, {name}));
    }
  };
  if (*kind == Kind::kPoint || *kind == Kind::kVector) {
    add_numbers(path);
  } else {
    const Names parts = *kind == Kind::kImu
                            ? Names{"orientation", "angular_velocity", "linear_acceleration"}
                            : member_names(definition, type_at(definition, path));
    for (const std::string& part : parts) add_numbers(path_to(definition, path, {part}));
  }
  blocks_.push_back(block);
}

bool FrameBlocks::transform(DecodedMessage& message, Stamp stamp,
                            const TransformBuffer* transforms) {
  if (!frames_.any()) return true;
  std::optional<Eigen::Isometry3d> pose;
  std::optional<Eigen::Isometry3d> body;
  if (!frames_.frame.empty()) {
    pose = transforms->find(frames_.frame, header_frame(message), stamp);
    if (!pose) return false;
  }
  if (!frames_.body_frame.empty()) {
    body = transforms->find(sensor_frame(message), frames_.body_frame, stamp);
    if (!body) return false;
  }
  for (const Block& block : blocks_) {
    if (pose) to_frame(*pose, block, message);
    if (body) to_body(*body, block, message);
  }
  return true;
}

void FrameBlocks::to_frame(const Eigen::Isometry3d& pose, const Block& block,
                           DecodedMessage& message) {
  const std::size_t* const first = block.slots.data();
  switch (block.kind) {
    case Kind::kPoint:
      assign(pose * vector_at(message, first), first, message);
      break;
    case Kind::kVector:
      rotate(pose, first, message);
      break;
    case Kind::kPose:
      assign(pose * vector_at(message, first), first, message);
      assign(Eigen::Quaterniond(pose.linear()) * quaternion_at(message, first + 3), first + 3,
             message);
      break;
    case Kind::kTwist:
      if (!block.is_of_child) transform_screw(pose, first + 3, first, message);
      break;
    case Kind::kWrench:
      transform_screw(pose, first, first + 3, message);
      break;
    case Kind::kAccel:
      rotate(pose, first, message);
      rotate(pose, first + 3, message);
      break;
    case Kind::kImu:
      rotate(pose, first + 4, message);
      rotate(pose, first + 7, message);
      assign(quaternion_at(message, first) * Eigen::Quaterniond(pose.linear()).conjugate(), first,
             message);
      break;
  }
}

/// The pose of a sensor becomes that of the body that bears it, T_GB = T_GS T_SB, and the twist in
/// the sensor's frame that in the body's. Not finite where the orientation is no rotation.
/// @param body  the pose of the body in the frame of the sensor
void FrameBlocks::to_body(const Eigen::Isometry3d& body, const Block& block,
                          DecodedMessage& message) {
  const std::size_t* const first = block.slots.data();
  if (block.kind == Kind::kPose) {
    Eigen::Quaterniond q = quaternion_at(message, first + 3);
    q.coeffs() /= q.norm();  // normalize() would take zero for a rotation
    assign(vector_at(message, first) + q * body.translation(), first, message);
    assign(q * Eigen::Quaterniond(body.linear()), first + 3, message);
  } else if (block.is_of_child) {
    transform_screw(body.inverse(), first + 3, first, message);
  }
}

std::string FrameBlocks::header_frame(const DecodedMessage& message) const {
  return std::string(message.text(header_frame_));
}

std::string FrameBlocks::sensor_frame(const DecodedMessage& message) const {
  return frames_.sensor_frame.empty() ? std::string(message.text(child_frame_))
                                      : frames_.sensor_frame;
}

void FrameBlocks::name_missing(const DecodedMessage& message, Stamp stamp,
                               const TransformBuffer& transforms, std::string& text) const {
  const bool is_of_body =
      !frames_.body_frame.empty() &&
      (frames_.frame.empty() || transforms.find(frames_.frame, header_frame(message), stamp));
  if (is_of_body) {
    write_pair(frames_.body_frame, sensor_frame(message), text);
  } else {
    write_pair(header_frame(message), frames_.frame, text);
  }
}

}  // namespace sampled_data_observers
