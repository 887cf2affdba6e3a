#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sampled_data_observers/config/config_node.h"
#include "sampled_data_observers/config/frame_config.h"
#include "sampled_data_observers/config/navsat_config.h"
#include "sampled_data_observers/config/outputs_config.h"
#include "sampled_data_observers/config/plant_config.h"
#include "sampled_data_observers/config/topic_config.h"
#include "sampled_data_observers/real_time/real_time_options.h"
#include "sampled_data_observers/runtime/runtime_setup.h"

namespace sampled_data_observers {

/// Everything that a configuration says, checked. doc/configuration.md describes each key.
struct ObserverConfig : RuntimeSetup {
  /// Observer type, such as "ConstantGainObserver".
  std::string type;
  /// Priority and memory of the publishing thread.
  RealTimeOptions real_time;
  /// What to do when time goes back by more than the tolerance: start anew, or only say so.
  bool reset_on_time_jump_back = false;
  /// By how much time may go back and is taken for corrected [ns].
  Duration jump_back_tolerance = 0;
  /// The directory of the files that may be loaded while running; empty: none may.
  std::string gains_directory;
  /// One per sensor, in the order of the plant's sensors. Empty for a sensor that measures at jumps
  /// and whose outputs the jump events carry.
  std::vector<std::optional<TopicSource>> sensors;
  /// One per channel of inputs, in the order of the plant's.
  std::vector<TopicSource> inputs;
  /// Set when the plant jumps; its size is the number of outputs measured at jumps.
  std::optional<TopicSource> jumps;
  /// Set where the estimate is also given in standard messages.
  std::optional<OutputsConfig> outputs;
  /// Of states, inputs and outputs, where they are named.
  Units units;
  /// Known without tf, and not overruled by it.
  std::vector<StaticTransform> static_transforms;
  /// The origin of the local plane of satellite navigation, where there is one.
  std::optional<NavSatDatum> navsat;
  /// Name of the theorem that guarantees something for these gains, and what; empty without a
  /// certificate that holds.
  std::string guarantee;
  /// Why there is no guarantee although there is a certificate; else empty.
  std::string warning;
  /// What else a person should know before it runs, such as gains with which the estimate diverges.
  std::vector<std::string> warnings;
};

/// Reads and checks a whole configuration tree, and the certificate where it has one. The key
/// `scenario`, which `simulate` reads, is left alone.
/// @throws ConfigError for the first fault found.
ObserverConfig read_observer_config(const ConfigNode& root, const PlantPluginLoader& load_plugin);

/// The same from YAML files, which are merged; a key may stand in one of them only.
ObserverConfig read_observer_config(const std::vector<std::string>& files,
                                    const PlantPluginLoader& load_plugin);

/// Refuses every plug-in: for programs that have no plug-ins.
std::shared_ptr<const PlantPlugin> no_plant_plugins(const std::string& type);

}  // namespace sampled_data_observers
