#include "sampled_data_observers/config/config_node.h"

#include <algorithm>

#include "config/tree_limits.h"

namespace sampled_data_observers {
namespace {

ConfigNode* find_in(ConfigNode& map, const std::string& key) {
  return const_cast<ConfigNode*>(map.find(key));
}

void merge_into(ConfigNode& target, const ConfigNode& source, const std::string& path) {
  if (source.kind == ConfigNode::Kind::kEmpty) return;
  if (target.kind == ConfigNode::Kind::kEmpty) {
    target = source;
    return;
  }
  if (target.kind != ConfigNode::Kind::kMap || source.kind != ConfigNode::Kind::kMap) {
    throw ConfigError(source.origin, path, "each key in one place only",
                      "it in " + target.origin + " as well");
  }
  for (const auto& [key, node] : source.entries) {
    if (ConfigNode* present = find_in(target, key)) {
      merge_into(*present, node, path.empty() ? key : path + "/" + key);
    } else {
      if (target.entries.size() >= kMostKeys) throw too_many_keys(source.origin, path);
      target.entries.emplace_back(key, node);
    }
  }
}

}  // namespace

std::string shortened(const std::string& text) {
  constexpr std::size_t kMost = 1000;
  if (text.size() <= kMost) return text;
  std::size_t end = kMost;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;  // UTF-8
  return text.substr(0, end) + "... (" + std::to_string(text.size()) + " characters)";
}

const ConfigNode* ConfigNode::find(const std::string& key) const {
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [&](const auto& entry) { return entry.first == key; });
  return found == entries.end() ? nullptr : &found->second;
}

std::string ConfigNode::describe() const {
  switch (kind) {
    case Kind::kEmpty:
      break;
    case Kind::kScalar:
      return "'" + scalar + "'";
    case Kind::kSequence:
      return "a list of " + std::to_string(items.size());
    case Kind::kMap:
      return "a map with " + std::to_string(entries.size()) +
             (entries.size() == 1 ? " key" : " keys");
  }
  return "nothing";
}

ConfigNode merge(const std::vector<ConfigNode>& trees) {
  ConfigNode merged;
  for (const ConfigNode& tree : trees) merge_into(merged, tree, "");
  return merged;
}

ConfigNode override_with(ConfigNode base, const ConfigNode& overriding) {
  if (overriding.kind == ConfigNode::Kind::kEmpty) return base;
  if (base.kind != ConfigNode::Kind::kMap || overriding.kind != ConfigNode::Kind::kMap) {
    return overriding;
  }
  for (const auto& [key, node] : overriding.entries) {
    if (ConfigNode* present = find_in(base, key)) {
      *present = override_with(*present, node);
    } else {
      base.entries.emplace_back(key, node);
    }
  }
  return base;
}

}  // namespace sampled_data_observers
