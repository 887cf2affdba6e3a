#pragma once

#include "config/law_config.h"
#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/config/plant_config.h"
#include "sampled_data_observers/config/topic_config.h"

namespace sampled_data_observers {

/// Reads the section `jumps` of a plant that jumps: where they come from, and, into `layers`, how
/// the law takes them.
/// @param stamp_error  set to how much their stamps may be off [ns]
/// @throws ConfigError for the first fault found.
TopicSource read_jumps(ConfigSection& root, const PlantConfig& plant, LawLayers& layers,
                       Duration& stamp_error);

}  // namespace sampled_data_observers
