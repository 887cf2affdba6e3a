#pragma once

#include <string>

namespace sampled_data_observers {

/// A text as double-quoted scalar of YAML.
/// @throws std::invalid_argument for one that is not UTF-8, which YAML can't say.
std::string yaml_scalar(const std::string& text);

/// A text as it may stand in a comment of one line: what may not, or ends a line, as in
/// yaml_scalar(), bytes that are not UTF-8 as \xNN.
std::string yaml_comment(const std::string& text);

}  // namespace sampled_data_observers
