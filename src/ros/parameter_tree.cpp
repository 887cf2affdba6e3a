#include "ros/parameter_tree.h"

#include <xmlrpcpp/XmlRpcValue.h>

#include <algorithm>
#include <limits>
#include <locale>
#include <sstream>
#include <vector>

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

ConfigNode convert(XmlRpc::XmlRpcValue& value, const std::string& origin, const std::string& path) {
  ConfigNode node;
  node.origin = origin;
  node.kind = ConfigNode::Kind::kScalar;
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      node.scalar = static_cast<bool>(value) ? "true" : "false";
      return node;
    case XmlRpc::XmlRpcValue::TypeInt:
      node.scalar = std::to_string(static_cast<int>(value));
      return node;
    case XmlRpc::XmlRpcValue::TypeDouble:
      node.scalar = exact_text(static_cast<double>(value));
      return node;
    case XmlRpc::XmlRpcValue::TypeString:
      node.scalar = static_cast<std::string>(value);
      return node;
    case XmlRpc::XmlRpcValue::TypeArray:
      node.kind = ConfigNode::Kind::kSequence;
      for (int i = 0; i < value.size(); ++i) {
        node.items.push_back(convert(value[i], origin, path + "[" + std::to_string(i) + "]"));
      }
      return node;
    case XmlRpc::XmlRpcValue::TypeStruct:
      node.kind = ConfigNode::Kind::kMap;
      for (auto& member : value) {
        const std::string member_path = path.empty() ? member.first : path + "/" + member.first;
        node.entries.emplace_back(member.first, convert(member.second, origin, member_path));
      }
      return node;
    default:
      throw ConfigError(node.origin, path, "a number, text, list or map", "binary data or a time");
  }
}

/// One file below `config`: its text and path, as observer.launch gives them, or its tree.
ConfigNode read_file(const ConfigNode& node, const std::string& name) {
  const ConfigNode* text = node.find("text");
  const ConfigNode* path = node.find("path");
  if (text != nullptr && path != nullptr && node.entries.size() == 2) {
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
  return convert(copy, "parameters of " + name, "");
}

ConfigNode read_parameter_tree(const ros::NodeHandle& private_handle) {
  const std::string& name = private_handle.getNamespace();
  XmlRpc::XmlRpcValue value;
  if (!private_handle.getParam("", value) || value.getType() != XmlRpc::XmlRpcValue::TypeStruct) {
    throw ConfigError("parameters of " + name, "",
                      "a configuration in the node's private parameters",
                      "none (load one with launch/observer.launch, or with rosparam)");
  }
  ConfigNode direct = to_config_node(value, name);
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
