#include "console/tool_main.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>

namespace sampled_data_observers {
namespace {

bool is_all_printed() {
  errno = 0;
  std::cout.flush();
  return std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good();
}

/// Why not all could be printed. Where a part was refused before the last one, its cause is lost by
/// now, but another line would be refused for the same.
const char* what_kept_from_printing() {
  if (errno == 0) {
    std::clearerr(stdout);
    std::fputc('\n', stdout);
    std::fflush(stdout);
  }
  return errno != 0 ? std::strerror(errno) : "something is missing in it";
}

}  // namespace

int tool_main(const char* name, int (*tool)(int argc, char** argv), int argc,
              char** argv) noexcept {
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on file sizes is a fault of writing
  try {
    const int status = tool(argc, argv);
    if (is_all_printed()) return status;
    std::fprintf(stderr, "%s: standard output: can't be written: %s\n", name,
                 what_kept_from_printing());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
  } catch (...) {
    std::fprintf(stderr, "%s: unknown fault\n", name);
  }
  return 1;
}

}  // namespace sampled_data_observers
