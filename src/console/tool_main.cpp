#include "console/tool_main.h"

#include <cstdio>
#include <exception>

namespace sampled_data_observers {

int tool_main(const char* name, int (*tool)(int argc, char** argv), int argc,
              char** argv) noexcept {
  try {
    return tool(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
  } catch (...) {
    std::fprintf(stderr, "%s: unknown fault\n", name);
  }
  return 1;
}

}  // namespace sampled_data_observers
