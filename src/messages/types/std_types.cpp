#include <std_msgs/Float64.h>
#include <std_msgs/Float64MultiArray.h>

#include "messages/types/typed_source.h"

namespace sampled_data_observers {

void add_fields(MessageFields<std_msgs::Float64>& fields) {
  fields.value("data", &std_msgs::Float64::data);
}

void add_fields(MessageFields<std_msgs::Float64MultiArray>& fields) {
  fields.indexed("data", &std_msgs::Float64MultiArray::data);
}

// Bare stamps of jumps.
void add_fields(MessageFields<std_msgs::Header>&) {}
void add_fields(MessageFields<std_msgs::Time>&) {}

void add_std_types(MessageTypes& types) {
  add_types<std_msgs::Float64, std_msgs::Float64MultiArray, std_msgs::Header, std_msgs::Time>(
      types);
}

}  // namespace sampled_data_observers
