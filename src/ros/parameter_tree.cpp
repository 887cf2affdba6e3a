#include "ros/parameter_tree.h"

#include <xmlrpcpp/XmlRpcValue.h>

#include <algorithm>
#include <limits>
#include <locale>
#include <sstream>
#include <utility>
#include <vector>

#include "config/tree_limits.h"
#include "sampled_data_observers/config/yaml_file.h"

namespace sampled_data_observers {
namespace {

/// All digits: the value must survive the way through text.
std::string exact_text(double value) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(std::numeric_limits<double>::max_digits10);
  out << value;
  return out.str();
}

/// Of one tree of parameters, which it measures as it goes.
class Converter {
 public:
  explicit Converter(std::string origin) : origin_(std::move(origin)) {}

  ConfigNode convert(XmlRpc::XmlRpcValue& value, const std::string& path, int depth) {
    if (depth > kMostLevels) throw too_deep(origin_, path);
    if (++nodes_ > kMostNodes) throw too_large(path, kMostNodes, "values");
    ConfigNode node;
    node.origin = origin_;
    switch (value.getType()) {
      case XmlRpc::XmlRpcValue::TypeArray:
        node.kind = ConfigNode::Kind::kSequence;
        for (int i = 0; i < value.size(); ++i) {
          node.items.push_back(convert(value[i], path + "[" + std::to_string(i) + "]", depth + 1));
        }
        return node;
      case XmlRpc::XmlRpcValue::TypeStruct:
        node.kind = ConfigNode::Kind::kMap;
        add_members(value, path, depth, node);
        return node;
      default:
        node.kind = ConfigNode::Kind::kScalar;
        node.scalar = text_of(value, path);
        count_bytes(node.scalar.size(), path);
        return node;
    }
  }

 private:
  void add_members(XmlRpc::XmlRpcValue& value, const std::string& path, int depth,
                   ConfigNode& map) {
    if (value.size() > static_cast<int>(kMostKeys)) throw too_many_keys(origin_, path);
    for (auto& member : value) {
      const std::string& key = member.first;
      // The levels of a file count from its top, two below that of the parameters.
      const bool holds_files = path.empty() && key == "config";
      const std::string key_path = path.empty() ? key : path + "/" + key;
      count_bytes(key.size(), key_path);
      map.entries.emplace_back(
          key, convert(member.second, key_path, holds_files ? depth - 1 : depth + 1));
    }
  }

  std::string text_of(XmlRpc::XmlRpcValue& value, const std::string& path) const {
    const char* found = "nothing";
    switch (value.getType()) {
      case XmlRpc::XmlRpcValue::TypeBoolean:
        return static_cast<bool>(value) ? "true" : "false";
      case XmlRpc::XmlRpcValue::TypeInt:
        return std::to_string(static_cast<int>(value));
      case XmlRpc::XmlRpcValue::TypeDouble:
        return exact_text(static_cast<double>(value));
      case XmlRpc::XmlRpcValue::TypeString:
        return static_cast<std::string>(value);
      case XmlRpc::XmlRpcValue::TypeBase64:
        found = "binary data";
        break;
      case XmlRpc::XmlRpcValue::TypeDateTime:
        found = "a time";
        break;
      default:
        break;
    }
    throw ConfigError(origin_, path, "a number, text, list or map", found);
  }

  void count_bytes(std::size_t bytes, const std::string& path) {
    bytes_ += bytes;
    if (bytes_ > kMostBytes) throw too_large(path, kMostBytes, "bytes");
  }

  ConfigError too_large(const std::string& path, std::size_t most, const std::string& what) const {
    return ConfigError(origin_, path,
                       "at most " + std::to_string(most) + " " + what + " in all parameters",
                       "more");
  }

  const std::string origin_;
  std::size_t nodes_ = 0;
  std::size_t bytes_ = 0;
};

/// One file below `config`: its text and path, as observer.launch gives them, or its tree.
ConfigNode read_file(const ConfigNode& node, const std::string& name) {
  const ConfigNode* text = node.find("text");
  const ConfigNode* path = node.find("path");
  if (text != nullptr && path != nullptr && node.entries.size() == 2) {
    for (const auto& [key, value] : node.entries) {
      if (value.kind == ConfigNode::Kind::kScalar) continue;
      throw ConfigError(node.origin, "config/" + name + "/" + key, "a text", value.describe());
    }
    return read_yaml_text(text->scalar, path->scalar);
  }
  if (node.kind != ConfigNode::Kind::kMap) {
    throw ConfigError(node.origin, "config/" + name, "a configuration file", node.describe());
  }
  return node;
}

}  // namespace

ConfigNode to_config_node(const XmlRpc::XmlRpcValue& value, const std::string& name) {
  XmlRpc::XmlRpcValue copy = value;  // its accessors are not const
  return Converter("parameters of " + name).convert(copy, "", 0);
}

ConfigNode read_parameter_tree(const ros::NodeHandle& private_handle) {
  const std::string& name = private_handle.getNamespace();
  const auto fault = [&](const std::string& found) {
    return ConfigError("parameters of " + name, "",
                       "a configuration in the node's private parameters", found);
  };
  XmlRpc::XmlRpcValue value;
  if (!private_handle.getParam("", value)) {
    throw fault(private_handle.hasParam("")
                    ? "what the ROS master can not send: hundreds of levels "
                      "or numbers beyond 32 bits"
                    : "none (load one with launch/observer.launch, or with rosparam)");
  }
  ConfigNode direct = to_config_node(value, name);
  if (direct.kind != ConfigNode::Kind::kMap) throw fault(direct.describe());
  std::vector<ConfigNode> files;
  const auto config = std::find_if(direct.entries.begin(), direct.entries.end(),
                                   [](const auto& entry) { return entry.first == "config"; });
  if (config != direct.entries.end()) {
    for (const auto& file : config->second.entries)
      files.push_back(read_file(file.second, file.first));
    if (files.empty()) {
      throw ConfigError(direct.origin, "config", "one map per configuration file",
                        config->second.describe());
    }
    direct.entries.erase(config);
  }
  return override_with(merge(files), direct);
}

}  // namespace sampled_data_observers
