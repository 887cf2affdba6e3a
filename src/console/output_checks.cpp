#include "console/output_checks.h"

#include "console/usage_error.h"
#include "files/link_target.h"

namespace sampled_data_observers {
namespace {

void refuse_same(const GivenFile& output, const GivenFile& other) {
  if (output.path.empty() || other.path.empty() || !is_same_file(output.path, other.path)) return;
  throw UsageError(output.title, output.path + " is the same file as " + other.title + " " +
                                     other.path + ", which would be lost");
}

}  // namespace

std::vector<GivenFile> given_files(const std::string& title,
                                   const std::vector<std::string>& paths) {
  std::vector<GivenFile> files;
  for (const std::string& path : paths) files.push_back({title, path});
  return files;
}

void refuse_overwriting(const std::vector<GivenFile>& inputs,
                        const std::vector<GivenFile>& outputs) {
  for (auto output = outputs.begin(); output != outputs.end(); ++output) {
    for (const GivenFile& input : inputs) refuse_same(*output, input);
    for (auto other = outputs.begin(); other != output; ++other) refuse_same(*output, *other);
  }
}

}  // namespace sampled_data_observers
