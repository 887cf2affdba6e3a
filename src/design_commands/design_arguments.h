#pragma once

#include <string>
#include <vector>

#include "sampled_data_observers/design/design_method.h"
#include "sampled_data_observers/design/gain_file.h"

namespace sampled_data_observers {

/// Adds to `parameters` what NAME=NUMBER says.
/// @throws CLI::ValidationError for another form.
void assign(const std::vector<std::string>& assignments, Parameters& parameters);

/// What a gain file in the folder of `output` says of a plant file and of how it was made, today.
GainFileOrigin origin_of(const std::string& output, const std::string& plant_file,
                         const std::string& plant_hash, const std::string& command_line);

/// For the help of --method: each with what it does.
std::string help_on_methods();
std::vector<std::string> method_names();

}  // namespace sampled_data_observers
