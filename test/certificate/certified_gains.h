#pragma once

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/certificate_config.h"
#include "config/law_config.h"
#include "config/plant_fingerprint.h"
#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/config/plant_config.h"
#include "sampled_data_observers/config/yaml_file.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers::test {

/// A configuration whose claims are about the plant as it is now.
inline ConfigNode with_own_hash(const ConfigNode& tree) {
  ConfigNode result = tree;
  for (const char* section : {kCertificate, kRunTimeCertificate}) {
    if (tree.find(section) == nullptr) continue;
    const std::string hash =
        std::string(section) + ": {plant: {hash: " + plant_fingerprint(tree) + "}}";
    result = override_with(result, read_yaml_text(hash, "test.yaml"));
  }
  return result;
}

/// A gain file of this repository with the plant that it names, as one configuration.
class CertifiedGains {
 public:
  /// @param file  relative to the repository
  explicit CertifiedGains(const std::string& file) {
    const std::string path = std::string(SDO_SOURCE_DIR) + "/" + file;
    const ConfigNode gains = read_yaml_file(path);
    const std::string plant =
        ConfigSection(gains, "").section("certificate").section("plant").text("file");
    const auto folder = std::filesystem::path(path).parent_path();
    tree_ = merge({gains, read_yaml_file((folder / plant).lexically_normal().string())});
  }

  /// Keys that replace or join those of the files.
  CertifiedGains& with(const std::string& yaml) {
    tree_ = override_with(tree_, read_yaml_text(yaml, "test.yaml"));
    return *this;
  }
  CertifiedGains& assuming(const std::string& assumptions) {
    return with("error_assumptions: " + assumptions);
  }

  /// Without a section that the files have.
  CertifiedGains& without(const std::string& key) {
    auto& entries = tree_.entries;
    entries.erase(std::remove_if(entries.begin(), entries.end(),
                                 [&](const auto& entry) { return entry.first == key; }),
                  entries.end());
    return *this;
  }

  const ConfigNode& tree() const { return tree_; }
  ObserverConfig config() const { return read_observer_config(tree_, no_plant_plugins); }
  /// Nothing where the file has no such section.
  std::optional<CertificateConfig> claim(const std::string& section = kCertificate) const {
    ConfigSection root(tree_, "");
    const PlantConfig plant = read_plant(root, no_plant_plugins);
    return read_certificate(root, *plant.plant, read_law(root, plant)->observer().gains(), section);
  }
  Certificate certificate(const std::string& section = kCertificate) const {
    return claim(section)->certificate;
  }
  /// Makes its claims about the plant as it is now.
  CertifiedGains& with_own_hash() {
    tree_ = test::with_own_hash(tree_);
    return *this;
  }

 private:
  ConfigNode tree_;
};

}  // namespace sampled_data_observers::test
