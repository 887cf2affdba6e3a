#pragma once

#include <CLI/App.hpp>
#include <string>

namespace sampled_data_observers {

// Each adds a subcommand, with what it does, to the tool `design`.
void add_explain(CLI::App& app);
void add_sweep(CLI::App& app, const std::string& command_line);
void add_synthesize(CLI::App& app, const std::string& command_line);
void add_analyze(CLI::App& app, const std::string& command_line);
void add_verify(CLI::App& app);

/// What a subcommand found that is no fault: the tool's exit status, thrown after all is printed.
struct ExitStatus {
  int status = 0;
};
constexpr int kNotVerified = 2;
constexpr int kNoDesign = 3;
constexpr int kUndecided = 4;
constexpr int kInterrupted = 130;

}  // namespace sampled_data_observers
