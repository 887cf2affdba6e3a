#pragma once

#include <string>

namespace sampled_data_observers {

/// The regular file `name` below `directory`, with all symbolic links resolved.
/// @throws std::runtime_error where there is none, or where the path leads out of the directory.
std::string confined_path(const std::string& directory, const std::string& name);

}  // namespace sampled_data_observers
