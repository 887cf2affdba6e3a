#pragma once

#include <iosfwd>
#include <string>

#include "sampled_data_observers/design/synthesis.h"

namespace sampled_data_observers {

/// Where a gain file says its plant is, and how it was made.
struct GainFileOrigin {
  std::string plant_file;  ///< as the gain file names it
  std::string plant_hash;
  std::string command;  ///< for the comment on top
  std::string date;     ///< YYYY-MM-DD
};

/// Writes a design as a gain file: a configuration that the nodelets read beside that of the plant,
/// with the certificate of its gains. Numbers have 17 digits, so that reading gives the same.
void write_gain_file(const Design& design, const GainFileOrigin& origin, std::ostream& out);

}  // namespace sampled_data_observers
