#pragma once

#include <string>
#include <vector>

#include "certificate/certificate.h"
#include "sampled_data_observers/config/config_section.h"

namespace sampled_data_observers {

/// Reads numbers, lists and matrices of given shapes: a scalar as number or [[number]], a matrix as
/// nested lists, and what has a name "K/gps/1" as key 1 of the section gps of the section K.
/// @throws ConfigError for one that is missing or has another shape, and for other keys in sections
/// below.
NamedMatrices read_named_values(ConfigSection& section, const std::vector<NamedShape>& shapes);

/// Reads the maps A and A_d of the error, n x n, where the section states them.
StatedErrorMaps read_stated_error_maps(ConfigSection& section, Eigen::Index n);

}  // namespace sampled_data_observers
