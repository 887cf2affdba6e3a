#include "config/plant_fingerprint.h"

#include <algorithm>
#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/uuid_io.hpp>
#include <cstdlib>
#include <iomanip>
#include <locale>
#include <map>
#include <set>
#include <sstream>

namespace sampled_data_observers {
namespace {

using Skipped = std::set<std::string>;

const Skipped kNotThePlant = {"integration", "jump_set", "flow_set", "units"};
const Skipped kNotTheMeasurement = {"gate", "sampling", "source"};

/// In quotes; those within are doubled, so that no name can pass for several.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

/// A number in one way of writing; another text as it is.
std::string canonical_scalar(const std::string& text) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  double value = 0.0;
  if (!(in >> value) || in.peek() != std::char_traits<char>::eof()) return quoted(text);
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << std::setprecision(17) << value + 0.0;  // no negative zero
  return out.str();
}

void write(const ConfigNode& node, const Skipped& skipped, std::string& text) {
  switch (node.kind) {
    case ConfigNode::Kind::kEmpty:
      text += '~';
      break;
    case ConfigNode::Kind::kScalar:
      text += canonical_scalar(node.scalar);
      break;
    case ConfigNode::Kind::kSequence:
      text += '[';
      for (const ConfigNode& item : node.items) {
        write(item, {}, text);
        text += ',';
      }
      text += ']';
      break;
    case ConfigNode::Kind::kMap: {
      std::map<std::string, const ConfigNode*> sorted;
      for (const auto& [key, value] : node.entries) sorted[key] = &value;
      text += '{';
      for (const auto& [key, value] : sorted) {
        if (skipped.count(key) > 0) continue;
        text += quoted(key) + ":";
        write(*value, {}, text);
        text += ',';
      }
      text += '}';
      break;
    }
  }
}

/// A plant without the sets in which its modes can be and jump.
ConfigNode without_sets_of_modes(ConfigNode plant) {
  for (auto& [key, modes] : plant.entries) {
    if (key != "modes") continue;
    for (auto& label_and_mode : modes.entries) {
      auto& entries = label_and_mode.second.entries;
      entries.erase(std::remove_if(entries.begin(), entries.end(),
                                   [](const auto& entry) {
                                     return entry.first == "jump_set" || entry.first == "flow_set";
                                   }),
                    entries.end());
    }
  }
  return plant;
}

}  // namespace

std::string plant_fingerprint(const ConfigNode& root) {
  std::string text;
  if (const ConfigNode* plant = root.find("plant"))
    write(without_sets_of_modes(*plant), kNotThePlant, text);
  std::map<std::string, const ConfigNode*> sorted;
  if (const ConfigNode* sensors = root.find("sensors")) {
    for (const auto& [name, sensor] : sensors->entries) sorted[name] = &sensor;
  }
  for (const auto& [name, sensor] : sorted) {
    text += quoted(name) + ":";
    write(*sensor, kNotTheMeasurement, text);
  }
  const boost::uuids::name_generator_sha1 generator(boost::uuids::ns::url());
  return to_string(generator(text));
}

}  // namespace sampled_data_observers
