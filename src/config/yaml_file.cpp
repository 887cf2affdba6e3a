#include "sampled_data_observers/config/yaml_file.h"

#include <yaml-cpp/yaml.h>

#include <fstream>
#include <sstream>

namespace sampled_data_observers {
namespace {

std::string place(const std::string& name, const YAML::Mark& mark) {
  return mark.is_null() ? name : name + ":" + std::to_string(mark.line + 1);
}

// Deeper than any configuration; a file that nests further is not one, and would exhaust the stack.
constexpr int kMaxDepth = 16;

ConfigNode convert(const YAML::Node& yaml, const std::string& name, const std::string& path,
                   int depth) {
  ConfigNode node;
  node.origin = place(name, yaml.Mark());
  if (depth > kMaxDepth) {
    throw ConfigError(node.origin, path, "at most " + std::to_string(kMaxDepth) + " levels",
                      "more");
  }
  switch (yaml.Type()) {
    case YAML::NodeType::Undefined:
    case YAML::NodeType::Null:
      break;
    case YAML::NodeType::Scalar:
      node.kind = ConfigNode::Kind::kScalar;
      node.scalar = yaml.Scalar();
      break;
    case YAML::NodeType::Sequence:
      node.kind = ConfigNode::Kind::kSequence;
      for (const YAML::Node& item : yaml) {
        const std::string item_path = path + "[" + std::to_string(node.items.size()) + "]";
        node.items.push_back(convert(item, name, item_path, depth + 1));
      }
      break;
    case YAML::NodeType::Map:
      node.kind = ConfigNode::Kind::kMap;
      for (const auto& entry : yaml) {
        const std::string origin = place(name, entry.first.Mark());
        if (!entry.first.IsScalar())
          throw ConfigError(origin, path, "a name as key", "a structure");
        const std::string& key = entry.first.Scalar();
        const std::string key_path = path.empty() ? key : path + "/" + key;
        if (const ConfigNode* first = node.find(key)) {
          throw ConfigError(origin, key_path, "each key once", "it at " + first->origin + " too");
        }
        node.entries.emplace_back(key, convert(entry.second, name, key_path, depth + 1));
      }
      break;
  }
  return node;
}

}  // namespace

ConfigNode read_yaml_text(const std::string& text, const std::string& name) {
  ConfigNode root;
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.size() > 1) throw ConfigError(name, "", "one YAML document", "several");
    if (!documents.empty()) root = convert(documents.front(), name, "", 0);
  } catch (const YAML::Exception& error) {
    throw ConfigError(place(name, error.mark), "", "valid YAML", error.msg);
  }
  if (root.kind != ConfigNode::Kind::kMap) {
    throw ConfigError(name, "", "a map of keys at the top", root.describe());
  }
  return root;
}

ConfigNode read_yaml_file(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  // A folder opens, but can not be read.
  if (!file || text.bad()) {
    throw ConfigError(path, "", "a readable YAML file", "none (check path and permissions)");
  }
  return read_yaml_text(text.str(), path);
}

}  // namespace sampled_data_observers
