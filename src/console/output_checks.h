#pragma once

#include <string>
#include <vector>

namespace sampled_data_observers {

/// A file of a command line: the option or argument that it was given as, and its name.
struct GivenFile {
  std::string title;
  std::string path;  ///< empty: not given
};

/// The files of an argument.
std::vector<GivenFile> given_files(const std::string& title, const std::vector<std::string>& paths);

/// To be called before anything is computed.
/// @throws UsageError for an output that is one of the inputs or another output, which would be
/// lost
void refuse_overwriting(const std::vector<GivenFile>& inputs,
                        const std::vector<GivenFile>& outputs);

}  // namespace sampled_data_observers
