#include "console/plot_program.h"

#include <stdio.h>
#include <unistd.h>

#include <climits>
#include <csignal>
#include <stdexcept>

#include "files/output_file.h"

namespace sampled_data_observers {
namespace {

std::string folder_of_this_program() {
  char path[PATH_MAX];
  const ssize_t length = readlink("/proc/self/exe", path, sizeof path);
  if (length <= 0) throw std::runtime_error("can't find the folder of this program");
  const std::string program(path, static_cast<std::size_t>(length));
  return program.substr(0, program.rfind('/'));
}

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

}  // namespace

void run_plot_program(const std::string& program, const std::string& json,
                      const std::string& path) {
  std::signal(SIGPIPE, SIG_IGN);
  OutputFile picture(path);
  FILE* pipe = popen((quoted(SDO_PYTHON) + " " + quoted(folder_of_this_program() + "/" + program) +
                      " " + quoted(picture.path()) + " " + quoted(path))
                         .c_str(),
                     "w");
  if (pipe == nullptr) throw std::runtime_error(path + ": can't start " + program);
  const bool written = fwrite(json.data(), 1, json.size(), pipe) == json.size();
  if (pclose(pipe) != 0 || !written) {
    throw std::runtime_error(path + ": " + program +
                             " failed (see above; it needs python3-matplotlib)");
  }
  picture.finish();
}

}  // namespace sampled_data_observers
