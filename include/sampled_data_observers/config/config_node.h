#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace sampled_data_observers {

/// A text as messages quote it: its first 1000 characters, where it has more.
std::string shortened(const std::string& text);

/// A fault in the configuration. The message names the file and line or the parameter, the path of
/// the key, what was expected and what was found.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;

  /// @param origin    file and line, or "parameters of" a node
  /// @param path      keys joined by '/'
  /// @param expected  completes "expected ..."
  /// @param found     completes "found ..."
  ConfigError(const std::string& origin, const std::string& path, const std::string& expected,
              const std::string& found)
      : std::runtime_error(origin + ": " + (path.empty() ? "" : shortened(path) + ": ") +
                           "expected " + shortened(expected) + ", found " + shortened(found)) {}
};

/// One node of a configuration tree, whether it was read from a YAML file or from the ROS parameter
/// server. Scalars are kept as text and converted strictly where they are used.
struct ConfigNode {
  /// A scalar has its text in `scalar`, a sequence its nodes in `items`, a map its in `entries`; an
  /// empty node has none of them.
  enum class Kind { kEmpty, kScalar, kSequence, kMap };

  /// kEmpty where nothing stands behind a key.
  Kind kind = Kind::kEmpty;
  /// Where it stands: "file.yaml:12" or "parameters of /observer".
  std::string origin;
  /// As written, without quotes.
  std::string scalar;
  /// In order; they may be of different kinds.
  std::vector<ConfigNode> items;
  /// In order of appearance; keys are unique.
  std::vector<std::pair<std::string, ConfigNode>> entries;

  /// The node below a key, as long as this node is not changed; null where there is no such key, or
  /// this is no map.
  const ConfigNode* find(const std::string& key) const;

  /// What it is, for "found ...": "the text 'abc'", "a list of 3", "nothing", ...
  std::string describe() const;
};

/// One tree from several: maps are joined key by key.
/// @throws ConfigError for a key that has a value in two of them.
ConfigNode merge(const std::vector<ConfigNode>& trees);

/// One tree from two: what `overriding` says replaces what `base` says, key by key.
ConfigNode override_with(ConfigNode base, const ConfigNode& overriding);

}  // namespace sampled_data_observers
