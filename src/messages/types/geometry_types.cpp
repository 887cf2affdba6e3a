#include "messages/types/geometry_fields.h"
#include "messages/types/typed_source.h"

namespace sampled_data_observers {

void add_geometry_types(MessageTypes& types) {
  add_types<geometry_msgs::Accel, geometry_msgs::Point, geometry_msgs::Pose,
            geometry_msgs::PoseWithCovariance, geometry_msgs::Transform, geometry_msgs::Twist,
            geometry_msgs::TwistWithCovariance, geometry_msgs::Vector3, geometry_msgs::Wrench>(
      types);
}

}  // namespace sampled_data_observers
