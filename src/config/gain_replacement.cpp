#include "config/gain_replacement.h"

#include <algorithm>
#include <optional>

#include "certificate/certificate.h"
#include "sampled_data_observers/config/config_section.h"

namespace sampled_data_observers {
namespace {

void remove(ConfigNode& tree, const std::string& key) {
  tree.entries.erase(std::remove_if(tree.entries.begin(), tree.entries.end(),
                                    [&](const auto& entry) { return entry.first == key; }),
                     tree.entries.end());
}

/// Which states come from outputs is no gain, and stays where the file does not say it.
const char kInjection[] = "output_injection";

std::optional<ConfigNode> injection_of(const ConfigNode& tree) {
  const ConfigNode* gains = tree.find("gains");
  const ConfigNode* injection = gains == nullptr ? nullptr : gains->find(kInjection);
  return injection == nullptr ? std::nullopt : std::optional<ConfigNode>(*injection);
}

}  // namespace

ConfigNode replace_gains(ConfigNode base, const ConfigNode& gain_file) {
  ConfigSection file(gain_file, "");
  file.section("gains");
  for (const char* key : {"observer", kCertificate, kRunTimeCertificate, "sampling"}) file.has(key);
  file.finish();
  const std::optional<ConfigNode> injection = injection_of(base);
  for (const char* key : {"gains", kCertificate, kRunTimeCertificate}) remove(base, key);
  for (const auto& [key, value] : gain_file.entries) {
    remove(base, key);
    base.entries.emplace_back(key, value);
    if (key != "gains" || !injection || injection_of(gain_file)) continue;
    base.entries.back().second.entries.emplace_back(kInjection, *injection);
  }
  return base;
}

}  // namespace sampled_data_observers
