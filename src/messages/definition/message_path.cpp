#include "messages/definition/message_path.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <set>
#include <utility>

namespace sampled_data_observers {
namespace {

using Derived = MessageField::Derived;

/// What follows from a message, by name.
using DerivedFields = std::array<std::pair<const char*, Derived>, 3>;

std::optional<DerivedFields> derived_from(const std::string& type) {
  if (type == "geometry_msgs/Quaternion") {
    return DerivedFields{
        {{"roll", Derived::kRoll}, {"pitch", Derived::kPitch}, {"yaw", Derived::kYaw}}};
  }
  if (type == "sensor_msgs/NavSatFix") {
    return DerivedFields{
        {{"east", Derived::kEast}, {"north", Derived::kNorth}, {"up", Derived::kUp}}};
  }
  return std::nullopt;
}

constexpr std::size_t kMostDescribed = 150;
constexpr int kMostLookedAt = 1000;  // a definition may hold many types within that hold nothing

std::optional<std::size_t> index_of(const std::string& text) {
  std::size_t index = 0;
  const char* const end = text.data() + text.size();
  const auto [last, fault] = std::from_chars(text.data(), end, index);
  if (fault != std::errc() || last != end) return std::nullopt;
  return index;
}

bool is_plain(const std::string& type) { return type.find('/') == std::string::npos; }

/// Entries of which names can be told: their places follow from their number.
bool are_named(const MessageDefinition& definition, const std::vector<MessageMember>& members,
               const MessageMember& member) {
  return names_of(members) && member.is_list() && definition.fixed_size(member.type);
}

/// Finds fields by their names, from one type to those within.
class FieldSearch {
 public:
  explicit FieldSearch(const MessageDefinition& definition) : definition_(definition) {}

  std::optional<MessageField> find(const std::string& type, const std::string& text) {
    if (const std::optional<DerivedFields> derived = derived_from(type)) {
      for (const auto& [name, field] : *derived) {
        if (text == name) return MessageField{path_, field};
      }
    }
    const std::vector<MessageMember>& members = definition_.members(type);
    for (std::size_t i = 0; i < members.size(); ++i) {
      const std::string& name = members[i].name;
      if (text.compare(0, name.size(), name) != 0) continue;
      const bool goes_on = text.size() > name.size();
      if (goes_on && text[name.size()] != '.') continue;
      if (goes_on != (members[i].is_several || !is_plain(members[i].type))) return std::nullopt;
      const std::string rest = goes_on ? text.substr(name.size() + 1) : "";
      return members[i].is_several ? find_entry(members, i, rest) : go_on({i}, members[i], rest);
    }
    return std::nullopt;
  }

 private:
  /// What lies behind a step.
  std::optional<MessageField> go_on(const PathStep& step, const MessageMember& member,
                                    const std::string& rest) {
    path_.push_back(step);
    std::optional<MessageField> found;
    if (!is_plain(member.type)) {
      found = find(member.type, rest);
    } else if (rest.empty() && number_type(member.type)) {
      found = MessageField{path_, Derived::kNone};
    }
    path_.pop_back();
    return found;
  }

  std::optional<MessageField> find_entry(const std::vector<MessageMember>& members,
                                         std::size_t position, const std::string& text) {
    const MessageMember& member = members[position];
    const bool is_named = are_named(definition_, members, member);
    // A name may hold dots itself.
    std::size_t dot = is_plain(member.type) ? text.size() : text.find('.');
    for (; dot != std::string::npos; dot = text.find('.', dot + 1)) {
      PathStep step{position, PathStep::Entry::kName, 0, text.substr(0, dot)};
      if (!is_named) {
        const std::optional<std::size_t> index = index_of(step.name);
        if (!index || *index >= member.length.value_or(*index + 1)) return std::nullopt;
        step = {position, PathStep::Entry::kIndex, *index, ""};
      }
      if (is_named && step.name.empty()) return std::nullopt;
      const std::string rest = dot < text.size() ? text.substr(dot + 1) : "";
      if (std::optional<MessageField> found = go_on(step, member, rest)) return found;
      if (!is_named || dot == text.size()) return std::nullopt;
    }
    return std::nullopt;
  }

  const MessageDefinition& definition_;
  MessagePath path_;
};

class FieldList {
 public:
  explicit FieldList(const MessageDefinition& definition) : definition_(definition) {}

  std::string text() {
    add(definition_.type(), "");
    return text_.empty() ? "none" : text_;
  }

 private:
  void add(const std::string& type, const std::string& prefix) {
    if (++looked_at_ > kMostLookedAt) return;
    const std::vector<MessageMember>& members = definition_.members(type);
    for (const MessageMember& member : members) {
      if (described_ > kMostDescribed) return;
      std::string name = prefix + member.name;
      if (member.is_several) name += are_named(definition_, members, member) ? ".NAME" : ".INDEX";
      if (!is_plain(member.type)) add(member.type, name + ".");
      if (number_type(member.type)) add_name(name);
    }
    if (const std::optional<DerivedFields> derived = derived_from(type)) {
      for (const auto& field : *derived) add_name(prefix + field.first);
    }
  }

  void add_name(const std::string& name) {
    if (++described_ > kMostDescribed) {
      if (described_ == kMostDescribed + 1) text_ += " …";
      return;
    }
    text_ += (text_.empty() ? "" : ", ") + name;
  }

  const MessageDefinition& definition_;
  std::string text_;
  std::size_t described_ = 0;
  int looked_at_ = 0;
};

std::optional<MessagePath> header_within(const MessageDefinition& definition,
                                         const std::string& type, std::set<std::string>& seen) {
  if (!seen.insert(type).second) return std::nullopt;
  const std::vector<MessageMember>& members = definition.members(type);
  for (std::size_t i = 0; i < members.size(); ++i) {
    const bool is_header = members[i].type == "std_msgs/Header" && !members[i].is_several;
    if (is_header) return MessagePath{{i}};
  }
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (members[i].is_several || is_plain(members[i].type)) continue;
    if (std::optional<MessagePath> path = header_within(definition, members[i].type, seen)) {
      path->insert(path->begin(), PathStep{i});
      return path;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<MessageField> find_field(const MessageDefinition& definition,
                                       const std::string& text) {
  return FieldSearch(definition).find(definition.type(), text);
}

std::string describe_fields(const MessageDefinition& definition) {
  return FieldList(definition).text();
}

std::optional<std::size_t> names_of(const std::vector<MessageMember>& members) {
  for (std::size_t i = 0; i < members.size(); ++i) {
    const bool is_called_so = members[i].name == "name" || members[i].name == "names";
    if (is_called_so && members[i].type == "string" && members[i].is_list()) return i;
  }
  return std::nullopt;
}

std::optional<MessagePath> find_header(const MessageDefinition& definition) {
  if (definition.type() == "std_msgs/Header") return MessagePath();
  std::set<std::string> seen;
  return header_within(definition, definition.type(), seen);
}

MessagePath path_to(const MessageDefinition& definition, MessagePath from,
                    const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const std::vector<MessageMember>& members = definition.members(type_at(definition, from));
    const auto found =
        std::find_if(members.begin(), members.end(),
                     [&](const MessageMember& member) { return member.name == name; });
    from.push_back({static_cast<std::size_t>(found - members.begin())});
  }
  return from;
}

std::optional<std::size_t> fixed_offset(const MessageDefinition& definition,
                                        const MessagePath& path) {
  std::size_t offset = 0;
  const std::string* type = &definition.type();
  for (const PathStep& step : path) {
    const std::vector<MessageMember>& members = definition.members(*type);
    for (std::size_t i = 0; i < step.member; ++i) {
      const std::optional<std::size_t> size = definition.fixed_size(members[i].type);
      if (!size || members[i].is_list()) return std::nullopt;
      offset += *size * members[i].length.value_or(1);
    }
    type = &members[step.member].type;
  }
  return offset;
}

const std::string& type_at(const MessageDefinition& definition, const MessagePath& path) {
  const std::string* type = &definition.type();
  for (const PathStep& step : path) type = &definition.members(*type)[step.member].type;
  return *type;
}

}  // namespace sampled_data_observers
