#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace sampled_data_observers {

/// A definition that is none; the text says what is wrong with it.
class DefinitionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// How a number lies in the bytes of a message: in little-endian order, as roscpp has it.
enum class NumberType : std::uint8_t {
  kUint8,
  kInt8,
  kUint16,
  kInt16,
  kUint32,
  kInt32,
  kUint64,
  kInt64,
  kFloat32,
  kFloat64
};

/// What a number's name says ("float64", "bool"); nothing for another type.
std::optional<NumberType> number_type(const std::string& name);

/// Bytes of a number.
std::size_t size_of(NumberType type);

/// A member of a message type.
struct MessageMember {
  std::string name;
  /// Of the member, or of its entries: of a number, "string", "time", "duration", or
  /// "package/Type".
  std::string type;
  /// Whether it is several: a list of any length, which the message tells, or an array.
  bool is_several = false;
  /// Of an array: how many entries; nothing for a list.
  std::optional<std::size_t> length;

  bool is_list() const { return is_several && !length; }
};

/// What a message type and all types within consist of, as .msg files say it.
class MessageDefinition {
 public:
  /// @param type  "package/Type"
  /// @param text  its definition, and behind lines of '=' those of the types within, each below a
  ///   line "MSG: package/Type": as bags and publishers give it
  /// @throws DefinitionError for a text that is no definition, or leaves out a type.
  MessageDefinition(std::string type, std::string text);

  const std::string& type() const { return type_; }

  /// As it was given.
  const std::string& text() const { return text_; }

  /// The sum by which ROS tells definitions of one type apart.
  const std::string& md5sum() const { return md5sums_.at(type_); }

  /// @pre `type` is this one or one within
  const std::vector<MessageMember>& members(const std::string& type) const {
    return types_.at(type).members;
  }

  /// Bytes that every value of a type has, a number's among them; nothing where they vary.
  std::optional<std::size_t> fixed_size(const std::string& type) const;

 private:
  struct Type {
    std::vector<MessageMember> members;
    /// "type name=value", one a line, for the sum.
    std::string constants;
    /// Of each member, for the sum: how many entries, "", "[]" or "[3]".
    std::vector<std::string> brackets;
  };

  void add_type(const std::string& name, const std::string& text);
  /// Finds the sum and the size of a type and of all within.
  void complete(const std::string& type, int depth);
  std::optional<std::size_t> size_of_members(const Type& type) const;

  std::string type_;
  std::string text_;
  std::map<std::string, Type> types_;
  std::map<std::string, std::string> md5sums_;
  std::map<std::string, std::optional<std::size_t>> sizes_;
};

/// The message types that a definition of one type alone names.
/// @param package  that of the type, for those named without one
/// @throws DefinitionError
std::vector<std::string> types_within(const std::string& package, const std::string& text);

}  // namespace sampled_data_observers
