#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sampled_data_observers {

/// How the bytes of a message are laid out, by the definition that its bag holds. Whoever
/// deserializes takes memory for as many entries as a list claims to have, before it finds that
/// they are not there.
class MessageShape {
 public:
  /// @param type  "package/Type"
  /// @param definition  of the type and of those in it, as connections of bags have it
  /// @throws BagDamage for one that is none
  MessageShape(const std::string& type, const std::string& definition);

  /// @throws BagDamage where the bytes are not exactly one message.
  void require(const std::uint8_t* bytes, std::size_t size) const;

 private:
  /// In bytes; nothing: it varies.
  using Size = std::optional<std::size_t>;
  struct Field {
    std::string name;
    Size size;               ///< of a number; nothing for a text
    std::string type;        ///< of a message within; empty: a text, or a number
    bool is_list = false;    ///< with its length before it
    std::size_t length = 1;  ///< of an array of fixed length
  };
  using Fields = std::vector<Field>;

  void add_type(const std::string& name, const std::string& definition);
  Field field_of(std::string type, const std::string& name, const std::string& within) const;
  /// The size of all messages of a type.
  Size find_size(const std::string& type, int depth);

  std::string type_;
  std::map<std::string, Fields> types_;
  std::map<std::string, Size> sizes_;

  class Walk;
};

}  // namespace sampled_data_observers
