#pragma once

#include <string>

#include "console/command_line.h"

namespace sampled_data_observers {

// Each adds a subcommand, with what it does, to the tool `design`.
void add_check_ell(CommandLine& tool);
void add_explain(CommandLine& tool);
void add_jump_observability(CommandLine& tool);
void add_sweep(CommandLine& tool, const std::string& command_line);
void add_synthesize(CommandLine& tool, const std::string& command_line);
void add_analyze(CommandLine& tool, const std::string& command_line);
void add_verify(CommandLine& tool);

/// What a subcommand found that is no fault: the tool's exit status, thrown after all is printed.
struct ExitStatus {
  int status = 0;
};
constexpr int kNotVerified = 2;
constexpr int kNoDesign = 3;
constexpr int kUndecided = 4;
constexpr int kInterrupted = 130;

}  // namespace sampled_data_observers
