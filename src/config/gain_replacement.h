#pragma once

#include "sampled_data_observers/config/config_node.h"

namespace sampled_data_observers {

/// The configuration `base` with the gains of a gain file, as `design` writes it, in place of its
/// own: `gains` and `certificate`, and `sampling` where the file has it. `output_injection` stays
/// where the file's gains have none.
/// @throws ConfigError for a file without gains, and for any other key in it.
ConfigNode replace_gains(ConfigNode base, const ConfigNode& gain_file);

}  // namespace sampled_data_observers
