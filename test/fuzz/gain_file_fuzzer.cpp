// Whatever a gain file holds beside a shipped plant, it is read and its certificate checked, or it
// is refused by a ConfigError. The first byte chooses the plant.
#include <cstdint>
#include <string>
#include <vector>

#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/config/yaml_file.h"

using namespace sampled_data_observers;

namespace {

/// One of each kind of theorem.
const std::vector<const char*> kExamples = {"ferrante2016_scalar",        "ferrante2019_oscillator",
                                            "sferlazza2019_aircraft_1_3", "etienne2019_dc_drive",
                                            "bernard2022_impulsive",      "bernard2022_switched"};

/// What stands beside the gains: the plant of the scenario and the observer's topics.
std::vector<ConfigNode> read_plants() {
  std::vector<ConfigNode> plants;
  for (const char* example : kExamples) {
    const std::string folder = std::string(SDO_SOURCE_DIR) + "/config/examples/" + example + "/";
    plants.push_back(merge(
        {read_yaml_file(folder + "scenario.yaml"), read_yaml_file(folder + "observer.yaml")}));
  }
  return plants;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::vector<ConfigNode> kPlants = read_plants();
  if (size == 0) return 0;
  const std::size_t example = (data[0] + kPlants.size() - '0') % kPlants.size();
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    read_observer_config(override_with(kPlants[example], read_yaml_text(text, "fuzz.yaml")),
                         no_plant_plugins);
  } catch (const ConfigError&) {
  }
  return 0;
}
