#pragma once

#include <cstddef>
#include <string>

#include "sampled_data_observers/config/config_section.h"

namespace sampled_data_observers {

// What a plant may have. More than any robot's, and such that loading ends within seconds: tables
// of exact flows take the third power of the states, formulas the product of their number and of
// the names that they may use.

constexpr std::size_t kMostModes = 100;
constexpr std::size_t kMostParameters = 200;
constexpr std::size_t kMostDefinitions = 200;
/// Formulas in a list.
constexpr std::size_t kMostFormulas = 120;
/// Of a grid over timers: there is a matrix at each, below a key of a map.
constexpr std::size_t kMostTimerNodes = 1000;
/// Of a plant of one mode, together: states (those of biases included), inputs, outputs of all
/// sensors.
constexpr std::size_t kMostVariables = 120;
/// The same for an observer whose covariance flows, too.
constexpr std::size_t kMostWithCovariance = 60;

/// @throws ConfigError at a key of a section with more than `most` of what it holds.
void require_at_most(std::size_t most, std::size_t found, const std::string& what,
                     const ConfigSection& section, const std::string& key);

/// @param most  of a plant of one mode; there are as many tables as modes
/// @throws ConfigError at a key for more variables in each mode.
void require_bounded(std::size_t variables, std::size_t modes, std::size_t most,
                     const ConfigSection& section, const std::string& key);

}  // namespace sampled_data_observers
