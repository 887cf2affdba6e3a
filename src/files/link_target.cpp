#include "files/link_target.h"

#include <filesystem>
#include <system_error>

namespace sampled_data_observers {
namespace {

namespace fs = std::filesystem;

/// As many as the kernel follows.
constexpr int kMostLinks = 40;

bool is_shared(const LinkTarget& target) {
  std::error_code none;
  const fs::file_status status = fs::status(target.path, none);
  return target.is_open_file || (fs::exists(status) && fs::is_other(status));
}

}  // namespace

LinkTarget link_target(const std::string& path) {
  LinkTarget target = {path, false};
  for (int links = 0; links <= kMostLinks; ++links) {
    const fs::path place = fs::absolute(target.path).lexically_normal();
    for (const std::string folder : {"/proc/", "/dev/fd/"}) {
      if (place.string().compare(0, folder.size(), folder) == 0) target.is_open_file = true;
    }
    std::error_code none;
    const fs::path next = fs::read_symlink(target.path, none);
    if (target.is_open_file || none) break;
    target.path = (fs::path(target.path).parent_path() / next).string();
  }
  return target;
}

bool is_same_file(const std::string& first, const std::string& second) {
  const LinkTarget a = link_target(first);
  const LinkTarget b = link_target(second);
  if (is_shared(a) || is_shared(b)) return false;
  std::error_code none;
  if (fs::equivalent(a.path, b.path, none)) return true;
  const fs::path canonical_a = fs::weakly_canonical(fs::absolute(a.path), none);
  const fs::path canonical_b = fs::weakly_canonical(fs::absolute(b.path), none);
  if (canonical_a.empty() || canonical_b.empty()) return a.path == b.path;  // out of reach
  return canonical_a == canonical_b;
}

}  // namespace sampled_data_observers
