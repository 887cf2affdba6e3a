#include "sampled_data_observers/config/gain_replacement.h"

#include <algorithm>

#include "sampled_data_observers/config/config_section.h"

namespace sampled_data_observers {
namespace {

void remove(ConfigNode& tree, const std::string& key) {
  tree.entries.erase(std::remove_if(tree.entries.begin(), tree.entries.end(),
                                    [&](const auto& entry) { return entry.first == key; }),
                     tree.entries.end());
}

}  // namespace

ConfigNode replace_gains(ConfigNode base, const ConfigNode& gain_file) {
  ConfigSection file(gain_file, "");
  file.section("gains");
  for (const char* key : {"observer", "certificate", "sampling"}) file.has(key);
  file.finish();
  for (const char* key : {"gains", "certificate"}) remove(base, key);
  for (const auto& [key, value] : gain_file.entries) {
    remove(base, key);
    base.entries.emplace_back(key, value);
  }
  return base;
}

}  // namespace sampled_data_observers
