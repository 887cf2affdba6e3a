#pragma once

#include <stdexcept>
#include <string>

namespace sampled_data_observers {

/// An output that can't be written; the message names the file and the cause.
class OutputError : public std::runtime_error {
 public:
  /// @param fault  an errno
  OutputError(const std::string& path, int fault);
};

/// An output of a program, whole or not there. It is written beside its final name, in the same
/// folder, and finish() gives it that name; until then a file that has the name stays as it was.
/// What is not finished is removed, also when SIGINT, SIGTERM or SIGHUP ends the process. A link
/// stays one: the file that it leads to is replaced. Devices, pipes and open files (/dev/stdout)
/// are written as they are.
class OutputFile {
 public:
  /// @throws OutputError where nothing can be written there.
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Where to write; it ends as the final name does.
  const std::string& path() const { return written_; }

  /// To be called when all is written and closed.
  /// @throws OutputError where it can't be brought to the disk, or be given its name.
  void finish();

 private:
  std::string name_;
  std::string target_;
  /// Differs from the target where it is to be renamed.
  std::string written_;
  bool is_finished_ = false;
};

/// Writes an output in one go.
/// @throws OutputError
void write_output(const std::string& path, const std::string& text);

/// Writes all of a text to an open file. @return 0, or an errno.
int write_fully(int file, const std::string& text);

}  // namespace sampled_data_observers
