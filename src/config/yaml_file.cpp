#include "sampled_data_observers/config/yaml_file.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "config/tree_limits.h"

namespace sampled_data_observers {
namespace {

std::string place(const std::string& name, const YAML::Mark& mark) {
  return mark.is_null() ? name : name + ":" + std::to_string(mark.line + 1);
}

ConfigError too_large(const std::string& name, const std::string& found) {
  return ConfigError(name, "", "at most " + std::to_string(kMostBytes) + " bytes", found);
}

/// Sees a document go by, and stops it where it is too large: before it takes memory and time.
class SizeGate : public YAML::EventHandler {
 public:
  explicit SizeGate(const std::string& name) : name_(name) {}

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { count(mark); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { count(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                const std::string&) override {
    count(mark);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    enter(mark, false);
  }
  void OnSequenceEnd() override { levels_.pop_back(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    enter(mark, true);
  }
  void OnMapEnd() override { levels_.pop_back(); }

 private:
  struct Level {
    bool is_map = false;
    std::size_t nodes = 0;
  };

  void count(const YAML::Mark& mark) {
    if (++nodes_ > 2 * kMostNodes) {
      throw ConfigError(place(name_, mark), "",
                        "at most " + std::to_string(2 * kMostNodes) + " keys and values", "more");
    }
    if (levels_.empty()) return;
    Level& level = levels_.back();
    if (++level.nodes <= 2 * kMostKeys || !level.is_map) return;
    throw too_many_keys(place(name_, mark), "");
  }

  void enter(const YAML::Mark& mark, bool is_map) {
    count(mark);
    if (levels_.size() > static_cast<std::size_t>(kMostLevels))
      throw too_deep(place(name_, mark), "");
    levels_.push_back({is_map, 0});
  }

  const std::string& name_;
  std::size_t nodes_ = 0;
  std::vector<Level> levels_;
};

/// YAML::LoadAll() would tell as well, but never ends where a token belongs to no document.
bool has_several_documents(const std::string& text, const std::string& name) {
  std::istringstream in(text);
  YAML::Parser parser(in);
  SizeGate gate(name);
  return parser.HandleNextDocument(gate) && parser.HandleNextDocument(gate);
}

/// The first line that a tab indents, of a text that is no YAML: nobody sees it, and the parser's
/// words don't name it. Empty where there is none.
std::string describe_tab(const std::string& text) {
  std::size_t line = 1;
  bool is_indentation = true;
  for (const char c : text) {
    if (c == '\t' && is_indentation) {
      return "line " + std::to_string(line) + " is indented by a tab, where YAML takes spaces only";
    }
    if (c == '\n') ++line;
    is_indentation = c == '\n' || (is_indentation && c == ' ');
  }
  return "";
}

class Converter {
 public:
  explicit Converter(const std::string& name) : name_(name) {}

  ConfigNode convert(const YAML::Node& yaml, const std::string& path, int depth) {
    ConfigNode node;
    node.origin = place(name_, yaml.Mark());
    if (depth > kMostLevels) throw too_deep(node.origin, path);
    if (++nodes_ > kMostNodes) {
      throw ConfigError(node.origin, path,
                        "at most " + std::to_string(kMostNodes) + " values, aliases written out",
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
  if (text.size() > kMostBytes) throw too_large(name, std::to_string(text.size()));
  ConfigNode root;
  try {
    if (has_several_documents(text, name))
      throw ConfigError(name, "", "one YAML document", "several");
    root = Converter(name).convert(YAML::Load(text), "", 0);
  } catch (const YAML::Exception& error) {
    const std::string tab = describe_tab(text);
    throw ConfigError(place(name, error.mark), "", "valid YAML",
                      error.msg + (tab.empty() ? "" : "; " + tab));
  }
  if (root.kind != ConfigNode::Kind::kMap) {
    throw ConfigError(name, "", "a map of keys at the top", root.describe());
  }
  return root;
}

ConfigNode read_yaml_file(const std::string& path) {
  std::ifstream file(path);
  // What has no end, such as a device, is given up after that.
  std::string text(kMostBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  // A folder opens, but can not be read.
  if (!file.eof() && file.gcount() <= 0) {
    throw ConfigError(path, "", "a readable YAML file", "none (check path and permissions)");
  }
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > kMostBytes) {
    std::error_code none;
    const auto size = std::filesystem::file_size(path, none);
    throw too_large(path, none ? "more" : std::to_string(size));
  }
  return read_yaml_text(text, path);
}

}  // namespace sampled_data_observers
