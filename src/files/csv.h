#pragma once

#include <string>
#include <vector>

namespace sampled_data_observers {

/// One line of a table of comma-separated values (RFC 4180), without its end: fields that need it
/// are quoted, and ends of lines within them become "; ".
std::string csv_line(const std::vector<std::string>& fields);

/// The fields of such a line.
/// @throws std::invalid_argument for one whose quotes don't match.
std::vector<std::string> csv_fields(const std::string& line);

/// The shortest decimal, of at most 17 digits, that is read as the same number.
std::string shortest_decimal(double value);

}  // namespace sampled_data_observers
