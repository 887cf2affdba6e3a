#include "messages/definition/message_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>

#include "messages/rotation_angles.h"

namespace sampled_data_observers {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

}  // namespace

std::vector<std::uint8_t> MessageWriter::write(const std::vector<MessageItem>& items) {
  bytes_.clear();
  Views views;
  for (const MessageItem& item : items) views.push_back({&item, 0});
  write_message(definition_.type(), views);
  return bytes_;
}

void MessageWriter::write_message(const std::string& type, const Views& views) {
  if (type == "geometry_msgs/Quaternion") return write_quaternion(views);
  const std::vector<MessageMember>& members = definition_.members(type);
  std::set<std::string> named;
  for (const View& view : views) {
    if (view.step().entry == PathStep::Entry::kName) named.insert(view.step().name);
  }
  const std::vector<std::string> names(named.begin(), named.end());
  const std::optional<std::size_t> names_member = names_of(members);
  for (std::size_t i = 0; i < members.size(); ++i) {
    Views inner;
    for (const View& view : views) {
      if (view.step().member == i) inner.push_back(view);
    }
    if (names_member == i && !names.empty()) {
      append(static_cast<std::uint32_t>(names.size()));
      for (const std::string& name : names) write_text(name);
    } else if (members[i].is_several) {
      write_entries(members[i], inner, names);
    } else {
      for (View& view : inner) ++view.first;
      write_value(members[i].type, inner);
    }
  }
}

void MessageWriter::write_entries(const MessageMember& member, const Views& views,
                                  const std::vector<std::string>& names) {
  const auto place_of = [&](const PathStep& step) {
    if (step.entry == PathStep::Entry::kIndex) return step.index;
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), step.name) -
                                    names.begin());
  };
  std::size_t length = member.length.value_or(0);
  for (const View& view : views) {
    const bool is_named = view.step().entry == PathStep::Entry::kName;
    length = std::max(length, is_named ? names.size() : view.step().index + 1);
  }
  if (member.is_list()) append(static_cast<std::uint32_t>(length));
  for (std::size_t i = 0; i < length; ++i) {
    Views inner;
    for (const View& view : views) {
      if (place_of(view.step()) == i) inner.push_back({view.item, view.first + 1});
    }
    write_value(member.type, inner);
  }
}

void MessageWriter::write_value(const std::string& type, const Views& views) {
  if (type.find('/') != std::string::npos) return write_message(type, views);
  const MessageItem none;
  const MessageItem& item = views.empty() ? none : *views.front().item;
  if (type == "string") {
    write_text(item.text);
  } else if (const std::optional<NumberType> number = number_type(type)) {
    write_number(*number, item.number);
  } else {
    append(static_cast<std::uint32_t>(item.time / kSecond));
    append(static_cast<std::uint32_t>(item.time % kSecond));
  }
}

void MessageWriter::write_quaternion(const Views& views) {
  using Derived = MessageField::Derived;
  double roll = 0.0;
  double pitch = 0.0;
  double yaw = 0.0;
  bool has_components = false;
  std::array<double, 4> components{};
  for (const View& view : views) {
    const double value = view.item->number;
    if (view.item->field.derived == Derived::kRoll) roll = value;
    if (view.item->field.derived == Derived::kPitch) pitch = value;
    if (view.item->field.derived == Derived::kYaw) yaw = value;
    if (view.ends()) continue;
    has_components = true;
    components.at(view.step().member) = value;
  }
  const RotationQuaternion q = rotation_of(roll, pitch, yaw);
  if (!has_components) components = {q.x, q.y, q.z, q.w};
  for (const double component : components) append(component);
}

void MessageWriter::write_number(NumberType type, double value) {
  switch (type) {
    case NumberType::kUint8:
      return append_rounded<std::uint8_t>(value);
    case NumberType::kInt8:
      return append_rounded<std::int8_t>(value);
    case NumberType::kUint16:
      return append_rounded<std::uint16_t>(value);
    case NumberType::kInt16:
      return append_rounded<std::int16_t>(value);
    case NumberType::kUint32:
      return append_rounded<std::uint32_t>(value);
    case NumberType::kInt32:
      return append_rounded<std::int32_t>(value);
    case NumberType::kUint64:
      return append_rounded<std::uint64_t>(value);
    case NumberType::kInt64:
      return append_rounded<std::int64_t>(value);
    case NumberType::kFloat32:
      return append(static_cast<float>(value));
    case NumberType::kFloat64:
      break;
  }
  append(value);
}

void MessageWriter::write_text(const std::string& text) {
  append(static_cast<std::uint32_t>(text.size()));
  bytes_.insert(bytes_.end(), text.begin(), text.end());
}

template <class T>
void MessageWriter::append(T value) {
  const std::size_t size = bytes_.size();
  bytes_.resize(size + sizeof(T));
  std::memcpy(bytes_.data() + size, &value, sizeof(T));
}

/// The limits of 64 bits are no doubles: what is not below the power of two above is the largest.
template <class T>
void MessageWriter::append_rounded(double value) {
  const double rounded = std::nearbyint(value);
  const double end = std::ldexp(1.0, std::numeric_limits<T>::digits);
  if (!(rounded > static_cast<double>(std::numeric_limits<T>::min()))) {
    append(std::numeric_limits<T>::min());
  } else {
    append(rounded < end ? static_cast<T>(rounded) : std::numeric_limits<T>::max());
  }
}

}  // namespace sampled_data_observers
