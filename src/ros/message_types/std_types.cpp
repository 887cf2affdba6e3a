#include <std_msgs/Float64.h>
#include <std_msgs/Float64MultiArray.h>

#include <charconv>

#include "typed_source.h"

namespace sampled_data_observers {

void add_fields(MessageFields<std_msgs::Float64>& fields) {
  fields.value("data", &std_msgs::Float64::data);
}

void add_fields(MessageFields<std_msgs::Float64MultiArray>& fields) {
  using Getter = FieldGetter<std_msgs::Float64MultiArray>;
  fields.keyed("data.", "INDEX", [](const std::string& key) -> Getter {
    std::size_t index = 0;
    const char* end = key.data() + key.size();
    const auto [last, fault] = std::from_chars(key.data(), end, index);
    if (fault != std::errc() || last != end) return {};
    return [index](const std_msgs::Float64MultiArray& message) {
      return index < message.data.size() ? std::optional<double>(message.data[index])
                                         : std::nullopt;
    };
  });
}

// Bare stamps of jumps.
void add_fields(MessageFields<std_msgs::Header>&) {}
void add_fields(MessageFields<std_msgs::Time>&) {}

void add_std_types(MessageTypes& types) {
  add_types<std_msgs::Float64, std_msgs::Float64MultiArray, std_msgs::Header, std_msgs::Time>(
      types);
}

}  // namespace sampled_data_observers
