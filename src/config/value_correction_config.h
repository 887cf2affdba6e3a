#pragma once

#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/config/topic_config.h"

namespace sampled_data_observers {

/// Reads the keys `scale`, `offset` and `limits` of a source of `size` values.
/// @throws ConfigError for a fault in them.
ValueCorrection read_value_correction(ConfigSection& source, std::size_t size);

/// Reads the key `stamp_offset` of a source [ns].
Duration read_stamp_offset(ConfigSection& source);

}  // namespace sampled_data_observers
