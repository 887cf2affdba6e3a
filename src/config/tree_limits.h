#pragma once

#include <cstddef>
#include <string>

#include "sampled_data_observers/config/config_node.h"

namespace sampled_data_observers {

// What a file or a tree of parameters may hold: more than any configuration does. One that nests
// further would exhaust the stack, a few aliases of aliases the memory, and one that is larger
// would take minutes.

constexpr std::size_t kMostBytes = 4000000;
constexpr int kMostLevels = 16;
constexpr std::size_t kMostNodes = 200000;
constexpr std::size_t kMostKeys = 1000;

/// For a tree that nests further, at a place in it.
inline ConfigError too_deep(const std::string& origin, const std::string& path) {
  return ConfigError(origin, path, "at most " + std::to_string(kMostLevels) + " levels", "more");
}

/// For a map that has more.
inline ConfigError too_many_keys(const std::string& origin, const std::string& path) {
  return ConfigError(origin, path, "at most " + std::to_string(kMostKeys) + " keys in a map",
                     "more");
}

}  // namespace sampled_data_observers
