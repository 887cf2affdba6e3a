#pragma once

#include <string>
#include <vector>

#include "design/gain_file.h"

namespace sampled_data_observers {

/// The plant's files: those given, or else the one that a gain file names in its certificate.
std::vector<std::string> plant_files_of(const std::string& gain_file,
                                        const std::vector<std::string>& given);

/// NAME=NUMBER fixes a parameter.
/// @throws UsageError for anything else.
void assign(const std::string& assignment, Parameters& parameters);

/// The objective of a name of to_string(Objective).
Objective objective_of(const std::string& name);

/// What a gain file in the folder of `output` says of its plant and of how it was made, today.
/// @throws UsageError for a plant file whose name YAML can't say.
GainFileOrigin origin_of(const std::string& output, const std::string& plant_file,
                         const std::string& plant_hash, const std::string& command_line);

/// Writes a gain file.
/// @throws OutputError where it can't be written
/// @return its text
std::string save_gain_file(const Design& design, const GainFileOrigin& origin,
                           const std::string& output);

}  // namespace sampled_data_observers
