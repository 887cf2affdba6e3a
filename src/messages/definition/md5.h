#pragma once

#include <string>

namespace sampled_data_observers {

/// The MD5 sum of a text (RFC 1321), as 32 hexadecimal digits. ROS names definitions by it; it
/// keeps nothing safe.
std::string md5_of(const std::string& text);

}  // namespace sampled_data_observers
