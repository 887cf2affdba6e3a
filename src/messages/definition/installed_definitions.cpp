#include "messages/definition/installed_definitions.h"

#include <ros/package.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <vector>

#include "config/misspelling.h"

namespace sampled_data_observers {
namespace {

namespace fs = std::filesystem;

struct TypeName {
  std::string package;
  std::string name;
};

TypeName split_type(const std::string& type) {
  const std::size_t slash = type.find('/');
  const char* const kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
  const auto is_word = [&](const std::string& text) {
    return !text.empty() && text.find_first_not_of(kLetters) == std::string::npos;
  };
  TypeName parts;
  if (slash != std::string::npos) parts = {type.substr(0, slash), type.substr(slash + 1)};
  if (!is_word(parts.package) || !is_word(parts.name)) {
    throw DefinitionError("is no name of a type, package/Type");
  }
  return parts;
}

std::vector<std::string> types_of_folder(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code fault;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, fault)) {
    if (entry.path().extension() == ".msg") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string dashed(std::string name) {
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

[[noreturn]] void refuse(const TypeName& type, const fs::path& folder) {
  const std::vector<std::string> names = types_of_folder(folder);
  const std::string meant =
      misspelling_of(type.name, names.empty() ? compiled_types(type.package) : names);
  const std::string hint =
      meant.empty() ? "" : " (did you mean " + type.package + "/" + meant + "?)";
  if (names.empty()) {
    throw DefinitionError("is not installed" + hint + ": " + folder.parent_path().string() +
                          " has no .msg files (in Debian they are in ros-" + dashed(type.package) +
                          ")");
  }
  std::string known;
  for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
  throw DefinitionError("does not exist" + hint + ": " + type.package + " has " + known);
}

/// The text of one type alone.
std::string text_of(const std::string& type) {
  if (const char* const compiled = compiled_definition(type)) {
    const std::string whole = compiled;
    return whole.substr(0, whole.find("\n====="));
  }
  const TypeName parts = split_type(type);
  const std::string package = ros::package::getPath(parts.package);
  if (package.empty()) {
    throw DefinitionError("is not installed: rospack finds no package " + parts.package +
                          " (source the setup.bash of its workspace, or install it: in Debian "
                          "ros-" +
                          dashed(parts.package) + ", for ROS' own distribution ros-noetic-" +
                          dashed(parts.package) + ")");
  }
  const fs::path folder = fs::path(package) / "msg";
  std::ifstream file(folder / (parts.name + ".msg"));
  if (!file) refuse(parts, folder);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// With all types within, as publishers send it.
std::string whole_text(const std::string& type) {
  std::set<std::string> known = {type};
  std::vector<std::string> left = {type};
  std::string whole;
  while (!left.empty()) {
    const std::string next = left.back();
    left.pop_back();
    std::string text;
    try {
      text = text_of(next);
      for (const std::string& within : types_within(next.substr(0, next.find('/')), text)) {
        if (known.insert(within).second) left.push_back(within);
      }
    } catch (const DefinitionError& error) {
      if (next == type) throw;
      throw DefinitionError("can't be read: within it, " + next + " " + error.what());
    }
    if (next != type) whole += std::string(80, '=') + "\nMSG: " + next + "\n";
    whole += text + "\n";
  }
  return whole;
}

}  // namespace

std::shared_ptr<const MessageDefinition> installed_definition(const std::string& type) {
  const char* const compiled = compiled_definition(type);
  return std::make_shared<const MessageDefinition>(type, compiled ? compiled : whole_text(type));
}

}  // namespace sampled_data_observers
