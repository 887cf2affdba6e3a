#pragma once

#include <charconv>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sampled_data_observers {

/// Takes one number out of a message; nothing where this message does not hold it.
template <class M>
using FieldGetter = std::function<std::optional<double>(const M&)>;

/// The numbers in a message of type M that events can be made of, by the paths that configurations
/// use. Which these are, the function `add_fields(MessageFields<M>&)` of each type says.
template <class M>
class MessageFields {
 public:
  /// A member that is a number.
  template <class T>
  MessageFields& value(const std::string& name, T M::*member) {
    return computed(name, [member](const M& message) {
      return std::optional<double>(static_cast<double>(message.*member));
    });
  }

  /// A number that is computed from the message.
  MessageFields& computed(std::string name, FieldGetter<M> get) {
    fields_.push_back({std::move(name), std::move(get)});
    return *this;
  }

  /// The fields of a member that is a message itself.
  /// @param is_held  says of a message whether it holds that member
  template <class N>
  MessageFields& nested(const std::string& name, N M::*member,
                        bool (*is_held)(const M&) = nullptr) {
    MessageFields<N> inner;
    add_fields(inner);
    for (const auto& [path, get] : inner.listed()) {
      computed(name + "." + path, [member, is_held, get = get](const M& message) {
        const bool held = is_held == nullptr || is_held(message);
        return held ? get(message.*member) : std::nullopt;
      });
    }
    return *this;
  }

  /// Numbers that are found by a key of the configuration: `prefix` and the key make the path.
  /// @param placeholder  stands for the key in messages
  /// @param make  the getter of a key; empty for one that cannot be
  MessageFields& keyed(const std::string& prefix, const std::string& placeholder,
                       std::function<FieldGetter<M>(const std::string& key)> make) {
    families_.push_back({prefix, prefix + placeholder, std::move(make)});
    return *this;
  }

  /// The numbers of a list, by their indices from 0: "name.0", "name.1" …
  template <class List>
  MessageFields& indexed(const std::string& name, List M::*member) {
    return keyed(name + ".", "INDEX", [member](const std::string& key) -> FieldGetter<M> {
      std::size_t index = 0;
      const char* end = key.data() + key.size();
      const auto [last, fault] = std::from_chars(key.data(), end, index);
      if (fault != std::errc() || last != end) return {};
      return [member, index](const M& message) {
        const List& list = message.*member;
        return index < list.size() ? std::optional<double>(list[index]) : std::nullopt;
      };
    });
  }

  /// The getter of a path, empty where there is no such field.
  FieldGetter<M> find(const std::string& path) const {
    for (const auto& [name, get] : fields_) {
      if (name == path) return get;
    }
    for (const Family& family : families_) {
      const std::size_t size = family.prefix.size();
      if (path.size() > size && path.compare(0, size, family.prefix) == 0) {
        return family.make(path.substr(size));
      }
    }
    return {};
  }

  /// All paths, for people.
  std::string describe() const {
    std::string text;
    for (const auto& [name, get] : fields_) text += (text.empty() ? "" : ", ") + name;
    for (const Family& family : families_) text += (text.empty() ? "" : ", ") + family.shown;
    return text.empty() ? "none" : text;
  }

  const std::vector<std::pair<std::string, FieldGetter<M>>>& listed() const { return fields_; }

 private:
  struct Family {
    std::string prefix;
    std::string shown;
    std::function<FieldGetter<M>(const std::string&)> make;
  };

  std::vector<std::pair<std::string, FieldGetter<M>>> fields_;
  std::vector<Family> families_;
};

}  // namespace sampled_data_observers
