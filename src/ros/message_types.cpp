#include "sampled_data_observers/ros/message_types.h"

#include "sampled_data_observers/ros/value_reader.h"

namespace sampled_data_observers {

void refuse_type(const TopicSource& source) {
  throw ConfigError(source.origin, source.path + "/type",
                    "one of sampled_data_observers/Measurement, geometry_msgs/PointStamped, "
                    "geometry_msgs/PoseStamped",
                    "'" + source.type + "'");
}

void refuse_fields(const TopicSource& source) {
  if (source.fields.empty()) return;
  throw ConfigError(source.origin, source.path + "/fields",
                    "no fields (" + source.type + " has its values in order)",
                    std::to_string(source.fields.size()));
}

}  // namespace sampled_data_observers
