// Whatever a configuration file holds, it gives an observer that runs or a ConfigError.
#include <cstdint>
#include <string>

#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/config/yaml_file.h"

using namespace sampled_data_observers;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const ObserverConfig config =
        read_observer_config(read_yaml_text(text, "fuzz.yaml"), no_plant_plugins);
  } catch (const ConfigError&) {
  }
  return 0;
}
