// rosrun sampled_data_observers design COMMAND ...
#include <string>

#include "console/command_line.h"
#include "console/tool_main.h"
#include "tools/design/commands.h"

namespace {

namespace sdo = sampled_data_observers;

int run(int argc, char** argv) {
  std::string command_line = "design";
  for (int i = 1; i < argc; ++i) command_line += std::string(" ") + argv[i];

  sdo::CommandLine tool(
      "design",
      "Offline design: from a plant file to a gain file with a certificate that anybody can check.",
      "Exit status: 0 done, 1 a fault in files or usage of the plant, 2 a claim that does not "
      "hold, 3 no design found, 4 a claim that ball arithmetic can't decide, 130 interrupted, else "
      "wrong usage.");
  sdo::add_synthesize(tool, command_line);
  sdo::add_analyze(tool, command_line);
  sdo::add_verify(tool);
  sdo::add_sweep(tool, command_line);
  sdo::add_explain(tool);
  sdo::add_check_ell(tool);
  sdo::add_jump_observability(tool);
  try {
    return tool.run(argc, argv);
  } catch (const sdo::ExitStatus& exit) {
    return exit.status;
  }
}

}  // namespace

int main(int argc, char** argv) {
  return sampled_data_observers::tool_main("design", run, argc, argv);
}
