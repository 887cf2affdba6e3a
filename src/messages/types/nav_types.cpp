#include <nav_msgs/Odometry.h>

#include "messages/types/geometry_fields.h"
#include "messages/types/typed_source.h"

namespace sampled_data_observers {

void add_fields(MessageFields<nav_msgs::Odometry>& fields) {
  using M = nav_msgs::Odometry;
  fields.nested("pose", &M::pose).nested("twist", &M::twist);
}

void add_nav_types(MessageTypes& types) { add_types<nav_msgs::Odometry>(types); }

}  // namespace sampled_data_observers
