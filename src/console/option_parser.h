#pragma once

#include <list>
#include <string>
#include <vector>

#include "console/option.h"

namespace sampled_data_observers {

/// A part of a command line: an option with as many values as it takes at least, or one text beside
/// options.
struct ParsedPart {
  const Option* option = nullptr;
  std::vector<std::string> texts;
};

struct ParsedArguments {
  std::vector<ParsedPart> parts;
  /// What stands behind "--": never an option, nor the value of one.
  std::vector<std::string> rest;
};

/// Tells options, by their whole names, from what stands beside them. What follows an option is its
/// value even where it begins with "-", as negative numbers do.
/// @throws UsageError for an option that is not among these, or that lacks values
ParsedArguments parse_arguments(const std::list<Option>& options,
                                const std::vector<std::string>& arguments);

}  // namespace sampled_data_observers
