#include "sampled_data_observers/config/yaml_file.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <fstream>
#include <sstream>

namespace sampled_data_observers {
namespace {

std::string place(const std::string& name, const YAML::Mark& mark) {
  return mark.is_null() ? name : name + ":" + std::to_string(mark.line + 1);
}

/// Sees a document go by.
class Bystander : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}
};

/// YAML::LoadAll() would tell as well, but never ends where a token belongs to no document.
bool has_several_documents(const std::string& text) {
  std::istringstream in(text);
  YAML::Parser parser(in);
  Bystander bystander;
  return parser.HandleNextDocument(bystander) && parser.HandleNextDocument(bystander);
}

// More than any configuration has. A file that nests further would exhaust the stack, and one of a
// few aliases of aliases the memory.
constexpr int kMaxDepth = 16;
constexpr std::size_t kMaxNodes = 200000;

class Converter {
 public:
  explicit Converter(const std::string& name) : name_(name) {}

  ConfigNode convert(const YAML::Node& yaml, const std::string& path, int depth) {
    ConfigNode node;
    node.origin = place(name_, yaml.Mark());
    if (depth > kMaxDepth) {
      throw ConfigError(node.origin, path, "at most " + std::to_string(kMaxDepth) + " levels",
                        "more");
    }
    if (++nodes_ > kMaxNodes) {
      throw ConfigError(node.origin, path,
                        "at most " + std::to_string(kMaxNodes) + " values, aliases written out",
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
          node.items.push_back(convert(item, item_path, depth + 1));
        }
        break;
      case YAML::NodeType::Map:
        node.kind = ConfigNode::Kind::kMap;
        for (const auto& entry : yaml) add_entry(entry.first, entry.second, path, depth, node);
        break;
    }
    return node;
  }

 private:
  void add_entry(const YAML::Node& key, const YAML::Node& value, const std::string& path, int depth,
                 ConfigNode& map) {
    const std::string origin = place(name_, key.Mark());
    if (!key.IsScalar()) throw ConfigError(origin, path, "a name as key", "a structure");
    const std::string& name = key.Scalar();
    const std::string key_path = path.empty() ? name : path + "/" + name;
    if (const ConfigNode* first = map.find(name)) {
      throw ConfigError(origin, key_path, "each key once", "it at " + first->origin + " too");
    }
    map.entries.emplace_back(name, convert(value, key_path, depth + 1));
  }

  const std::string& name_;
  std::size_t nodes_ = 0;
};

}  // namespace

ConfigNode read_yaml_text(const std::string& text, const std::string& name) {
  ConfigNode root;
  try {
    if (has_several_documents(text)) throw ConfigError(name, "", "one YAML document", "several");
    root = Converter(name).convert(YAML::Load(text), "", 0);
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
