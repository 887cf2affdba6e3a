#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>

#include "design/design_search.h"

namespace sampled_data_observers {

/// Where a gain file says its plant is, and how it was made.
struct GainFileOrigin {
  std::string plant_file;  ///< as the gain file names it
  std::string plant_hash;
  std::string command;  ///< for the comment on top
  std::string date;     ///< YYYY-MM-DD
};

/// Writes a design as a gain file: a configuration that the nodelets read beside that of the plant,
/// with the certificate of its gains, and that for their bound at run time. Numbers have 17 digits,
/// so that reading gives the same.
void write_gain_file(const Design& design, const GainFileOrigin& origin, std::ostream& out);

/// The lines of a section such as `certificate` that record a proof in ball arithmetic.
/// @param conditions  how many were proved
std::string proof_record(const Certificate& certificate, std::size_t conditions);

/// The text of a gain file with such lines in a section, in place of any there.
/// @throws std::invalid_argument for a section that is not written in lines of its own.
std::string with_proof_record(const std::string& text, const std::string& section,
                              const std::string& record);

/// The text of a gain file for people to read: of more than six lines in a row below one key, such
/// as the matrices at the nodes of a grid, the first two, and long lines cut.
std::string abridged_gain_file(const std::string& text);

}  // namespace sampled_data_observers
