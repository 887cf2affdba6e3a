#pragma once

#include <ros/datatypes.h>

#include <string>

namespace sampled_data_observers {

/// What is said of messages by another definition than the one expected: who sends them, and both
/// types and MD5 sums, in at most kLongestDetail characters.
/// @param connection  what the publisher, or a bag, says of itself
/// @param type        that is expected, "package/Type"
/// @param md5sum      of its definition
std::string describe_other_definition(const std::string& topic, const ros::M_string& connection,
                                      const std::string& type, const std::string& md5sum);

}  // namespace sampled_data_observers
