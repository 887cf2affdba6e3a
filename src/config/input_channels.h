#pragma once

#include <string>
#include <vector>

#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// Reads which inputs come together, from the section `inputs` of `root`, and for how long they
/// hold; nothing where there is none, and `input` has no timeout either. Each key is the name of a
/// channel: that of its one input, or any where `fields` is a map from the names of its inputs. The
/// rest of each is left alone.
/// @param inputs   names, in the order of u
/// @param sensors  names that no channel may have
/// @throws ConfigError for an input in no channel or in two, and for a name that is none.
std::vector<InputChannel> read_input_channels(ConfigSection& root,
                                              const std::vector<std::string>& inputs,
                                              const std::vector<std::string>& sensors);

}  // namespace sampled_data_observers
