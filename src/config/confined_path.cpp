#include "config/confined_path.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

namespace sampled_data_observers {

std::string confined_path(const std::string& directory, const std::string& name) {
  std::error_code fault;
  const std::filesystem::path root = std::filesystem::canonical(directory, fault);
  std::filesystem::path file;
  if (!fault) file = std::filesystem::canonical(root / name, fault);
  const bool is_below =
      !fault &&
      std::mismatch(root.begin(), root.end(), file.begin(), file.end()).first == root.end();
  // Of what lies outside, nobody learns whether it exists.
  if (!is_below || !std::filesystem::is_regular_file(file, fault)) {
    throw std::runtime_error("expected a file below " + directory + ", found '" + name + "'");
  }
  return file.string();
}

}  // namespace sampled_data_observers
