#pragma once

#include <string>

namespace sampled_data_observers {

/// Where links lead.
struct LinkTarget {
  /// Neither this nor what it leads to need exist.
  std::string path;
  /// Whether they lead to a file that a process has open, as /dev/stdout does.
  bool is_open_file = false;
};

/// Follows the links of a name as far as they go.
LinkTarget link_target(const std::string& path);

/// Whether two names are of one file, through links or not; also of one that does not exist yet.
/// Devices, pipes and open files are nobody's alone, and the same as nothing.
bool is_same_file(const std::string& first, const std::string& second);

}  // namespace sampled_data_observers
