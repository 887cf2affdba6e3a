#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "messages/definition/message_definition.h"

namespace sampled_data_observers {

/// From a message to a member of it, and to which entry where that is several.
struct PathStep {
  enum class Entry : std::uint8_t { kWhole, kIndex, kName };

  /// Position among the members.
  std::size_t member = 0;
  Entry entry = Entry::kWhole;
  /// Of kIndex.
  std::size_t index = 0;
  /// Of kName: the text beside which it stands in the list of names (names_of()).
  std::string name = {};

  bool operator==(const PathStep& other) const {
    return member == other.member && entry == other.entry && index == other.index &&
           name == other.name;
  }
};

/// From a message to something within.
using MessagePath = std::vector<PathStep>;

/// A number that a message holds, or that follows from a part of it: the angles from a
/// geometry_msgs/Quaternion, the place in the local plane from a sensor_msgs/NavSatFix.
struct MessageField {
  enum class Derived : std::uint8_t { kNone, kRoll, kPitch, kYaw, kEast, kNorth, kUp };

  /// To the number, or to that part.
  MessagePath path;
  Derived derived = Derived::kNone;

  /// Whether it is a place in the local plane.
  bool is_in_plane() const { return derived >= Derived::kEast; }
};

/// The field of a text such as "pose.orientation.yaw", "ranges.0" or "position.JOINT"; nothing
/// where there is no such field.
std::optional<MessageField> find_field(const MessageDefinition& definition,
                                       const std::string& text);

/// All fields, for people; the first of very many.
std::string describe_fields(const MessageDefinition& definition);

/// The member that names the entries of the lists beside it: a list of texts called `name` or
/// `names`.
std::optional<std::size_t> names_of(const std::vector<MessageMember>& members);

/// To the first std_msgs/Header: that at the top, else the first within, lists apart.
std::optional<MessagePath> find_header(const MessageDefinition& definition);

/// To a member by the names of members, none of them several. @pre they exist
MessagePath path_to(const MessageDefinition& definition, MessagePath from,
                    const std::vector<std::string>& names);

/// How many bytes of a message lie before what a path leads to; nothing where that is not so in all
/// messages. @pre it goes through no lists and arrays
std::optional<std::size_t> fixed_offset(const MessageDefinition& definition,
                                        const MessagePath& path);

/// The type of what a path leads to.
const std::string& type_at(const MessageDefinition& definition, const MessagePath& path);

}  // namespace sampled_data_observers
