#include "tools/design/claims.h"

#include "config/claim_contradiction.h"
#include "config/claimed_gains.h"
#include "config/law_config.h"
#include "config/plant_fingerprint.h"
#include "messages/plant_plugins.h"
#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/config/plant_config.h"
#include "sampled_data_observers/config/yaml_file.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {

std::vector<CertificateConfig> read_claims(const std::string& gain_file,
                                           const std::vector<std::string>& plant_files) {
  const ConfigNode gains = read_yaml_file(gain_file);
  std::vector<ConfigNode> trees;
  for (const std::string& file : plant_files) trees.push_back(read_yaml_file(file));
  const ConfigNode plant_tree = merge(trees);
  ConfigSection plant_root(plant_tree, "");
  const PlantConfig plant = read_plant(plant_root, load_plant_plugin);
  ConfigSection root(gains, "");
  if (!root.has(kCertificate)) {
    throw root.error(kCertificate, "a gain file with a certificate", "none");
  }
  ConfigSection plant_section = plant_root.section("plant");
  const std::string hash = plant_fingerprint(plant_tree);
  const LawGains law = read_law(root, plant)->observer().gains();
  std::vector<CertificateConfig> claims;
  for (const char* key : {kCertificate, kRunTimeCertificate}) {
    const auto claim = read_certificate(root, *plant.plant, law, key);
    if (!claim) continue;
    if (const auto error = objection_to_gains(root.section("gains"), *claim->certificate.theorem,
                                              claim->certificate.subject, law)) {
      throw ConfigError(*error);
    }
    ConfigSection section = root.section(key);
    require_no_contradiction(*plant.plant, claim->certificate.subject.plant.stated, plant_section,
                             section);
    if (hash != claim->plant_hash) {
      throw ConfigError(claim->origin, claim->section + "/plant/hash",
                        "the fingerprint of " + plant_files.front() + ", " + hash,
                        claim->plant_hash);
    }
    claims.push_back(*claim);
  }
  return claims;
}

}  // namespace sampled_data_observers
