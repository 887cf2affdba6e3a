#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "messages/definition/message_path.h"
#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// What is to be written at one place of a message.
struct MessageItem {
  enum class Kind : std::uint8_t { kNumber, kText, kTime };

  /// Of a number also an angle of the quaternion at the end of the path.
  MessageField field;
  Kind kind = Kind::kNumber;
  double number = 0.0;
  std::string text = {};
  Stamp time = 0;
};

/// Writes messages of one definition: all is zero and empty but what is said. Lists are as long as
/// it takes, lists of names hold those that entries are named by; a quaternion is the rotation of
/// the angles that are said of it, without any the identity. Whole numbers are rounded, and kept in
/// the range of their type.
class MessageWriter {
 public:
  /// @param definition  must outlive the writer
  explicit MessageWriter(const MessageDefinition& definition) : definition_(definition) {}

  /// The bytes of a message, as roscpp sends it.
  std::vector<std::uint8_t> write(const std::vector<MessageItem>& items);

 private:
  /// An item seen from a type within: its path from the given step on.
  struct View {
    const MessageItem* item = nullptr;
    std::size_t first = 0;
    const PathStep& step() const { return item->field.path[first]; }
    bool ends() const { return first == item->field.path.size(); }
  };
  using Views = std::vector<View>;

  void write_value(const std::string& type, const Views& views);
  void write_message(const std::string& type, const Views& views);
  void write_entries(const MessageMember& member, const Views& views,
                     const std::vector<std::string>& names);
  void write_quaternion(const Views& views);
  void write_number(NumberType type, double value);
  void write_text(const std::string& text);
  template <class T>
  void append(T value);
  template <class T>
  void append_rounded(double value);

  const MessageDefinition& definition_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace sampled_data_observers
