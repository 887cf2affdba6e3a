#include "replay/report/beside_run.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "replay/bag_source.h"

namespace sampled_data_observers {

std::vector<std::string> with_gains(std::vector<std::string> files, const std::string& gains) {
  const auto has_gains = [](const std::string& path) {
    const YAML::Node root = YAML::LoadFile(path);
    return root.IsMap() && root["gains"].IsDefined();
  };
  const auto found = std::find_if(files.begin(), files.end(), has_gains);
  if (found == files.end()) {
    throw ReplayError("--beside: expected a CONFIG with the key gains, in whose place " + gains +
                      " would be read; found none");
  }
  *found = gains;
  return files;
}

}  // namespace sampled_data_observers
