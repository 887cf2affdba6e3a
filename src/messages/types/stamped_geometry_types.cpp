#include <geometry_msgs/AccelStamped.h>
#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <geometry_msgs/WrenchStamped.h>

#include "messages/types/geometry_fields.h"
#include "messages/types/typed_source.h"

namespace sampled_data_observers {

void add_fields(MessageFields<geometry_msgs::AccelStamped>& fields) {
  fields.nested("accel", &geometry_msgs::AccelStamped::accel);
}

void add_fields(MessageFields<geometry_msgs::PointStamped>& fields) {
  fields.nested("point", &geometry_msgs::PointStamped::point);
}

void add_fields(MessageFields<geometry_msgs::PoseStamped>& fields) {
  fields.nested("pose", &geometry_msgs::PoseStamped::pose);
}

void add_fields(MessageFields<geometry_msgs::PoseWithCovarianceStamped>& fields) {
  fields.nested("pose", &geometry_msgs::PoseWithCovarianceStamped::pose);
}

void add_fields(MessageFields<geometry_msgs::TransformStamped>& fields) {
  fields.nested("transform", &geometry_msgs::TransformStamped::transform);
}

void add_fields(MessageFields<geometry_msgs::TwistStamped>& fields) {
  fields.nested("twist", &geometry_msgs::TwistStamped::twist);
}

void add_fields(MessageFields<geometry_msgs::TwistWithCovarianceStamped>& fields) {
  fields.nested("twist", &geometry_msgs::TwistWithCovarianceStamped::twist);
}

void add_fields(MessageFields<geometry_msgs::Vector3Stamped>& fields) {
  fields.nested("vector", &geometry_msgs::Vector3Stamped::vector);
}

void add_fields(MessageFields<geometry_msgs::WrenchStamped>& fields) {
  fields.nested("wrench", &geometry_msgs::WrenchStamped::wrench);
}

void add_stamped_geometry_types(MessageTypes& types) {
  add_types<geometry_msgs::AccelStamped, geometry_msgs::PointStamped, geometry_msgs::PoseStamped,
            geometry_msgs::PoseWithCovarianceStamped, geometry_msgs::TransformStamped,
            geometry_msgs::TwistStamped, geometry_msgs::TwistWithCovarianceStamped,
            geometry_msgs::Vector3Stamped, geometry_msgs::WrenchStamped>(types);
}

}  // namespace sampled_data_observers
