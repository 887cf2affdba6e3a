#include "files/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "files/link_target.h"

namespace sampled_data_observers {
namespace {

namespace fs = std::filesystem;

/// Names of unfinished files, for a handler of signals.
std::array<std::atomic<const char*>, 8> unfinished = {};

extern "C" void remove_unfinished_and_end(int signal) {
  for (const auto& name : unfinished) {
    if (const char* path = name.load()) ::unlink(path);
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void remove_at_end(const char* path) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction present = {};
    ::sigaction(signal, nullptr, &present);
    if (present.sa_handler == SIG_DFL) std::signal(signal, remove_unfinished_and_end);
  }
  for (auto& name : unfinished) {
    const char* none = nullptr;
    if (name.compare_exchange_strong(none, path)) return;
  }
}

void forget(const char* path) {
  for (auto& name : unfinished) {
    const char* present = path;
    if (name.compare_exchange_strong(present, nullptr)) return;
  }
}

/// Makes a file of a new name in a folder.
std::string make_beside(const fs::path& target) {
  for (int number = 0;; ++number) {
    const std::string name = ".unfinished_" + std::to_string(::getpid()) + "_" +
                             std::to_string(number) + target.extension().string();
    std::string path = (target.parent_path() / name).string();
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file >= 0) {
      ::close(file);
      return path;
    }
    if (errno != EEXIST) return "";
  }
}

/// Whether a full disk or a broken one kept a file's data off.
bool is_lost(int fault) { return fault == EIO || fault == ENOSPC || fault == EDQUOT; }

}  // namespace

OutputError::OutputError(const std::string& path, int fault)
    : std::runtime_error(path + ": can't be written: " + std::generic_category().message(fault)) {}

OutputFile::OutputFile(const std::string& path) : name_(path) {
  if (name_.empty()) throw OutputError("''", ENOENT);
  const LinkTarget target = link_target(name_);
  target_ = target.path;
  written_ = target_;
  struct stat present = {};
  const bool exists = ::stat(target_.c_str(), &present) == 0;
  if (exists && S_ISDIR(present.st_mode)) throw OutputError(name_, EISDIR);
  if (target.is_open_file || (exists && !S_ISREG(present.st_mode))) return;
  if (exists && ::access(target_.c_str(), W_OK) != 0) throw OutputError(name_, errno);
  written_ = make_beside(target_);
  if (written_.empty()) throw OutputError(name_, errno);
  if (exists) ::chmod(written_.c_str(), present.st_mode & 07777);
  remove_at_end(written_.c_str());
}

OutputFile::~OutputFile() {
  if (is_finished_ || written_ == target_) return;
  ::unlink(written_.c_str());
  forget(written_.c_str());
}

void OutputFile::finish() {
  if (written_ != target_) {
    const int file = ::open(written_.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) throw OutputError(name_, errno);
    const int fault = ::fsync(file) == 0 ? 0 : errno;
    ::close(file);
    if (is_lost(fault)) throw OutputError(name_, fault);
    if (std::rename(written_.c_str(), target_.c_str()) != 0) throw OutputError(name_, errno);
    forget(written_.c_str());
  }
  is_finished_ = true;
}

int write_fully(int file, const std::string& text) {
  std::size_t written = 0;
  while (written < text.size()) {
    const ssize_t count = ::write(file, text.data() + written, text.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    written += static_cast<std::size_t>(count);
  }
  return 0;
}

void write_output(const std::string& path, const std::string& text) {
  OutputFile output(path);
  const int file = ::open(output.path().c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC);
  if (file < 0) throw OutputError(path, errno);
  int fault = write_fully(file, text);
  if (::close(file) != 0 && fault == 0) fault = errno;
  if (fault != 0) throw OutputError(path, fault);
  output.finish();
}

}  // namespace sampled_data_observers
