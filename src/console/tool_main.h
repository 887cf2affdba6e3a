#pragma once

namespace sampled_data_observers {

/// What the main function of a command-line tool returns: the tool's own exit status, or 1, after a
/// message on standard error, when it throws.
int tool_main(const char* name, int (*tool)(int argc, char** argv), int argc, char** argv) noexcept;

}  // namespace sampled_data_observers
