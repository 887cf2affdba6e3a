// rosrun sampled_data_observers design SUBCOMMAND ...
#include <CLI/CLI.hpp>
#include <string>

#include "console/tool_main.h"
#include "tools/design/commands.h"

namespace {

namespace sdo = sampled_data_observers;

int run(int argc, char** argv) {
  std::string command_line = "design";
  for (int i = 1; i < argc; ++i) command_line += std::string(" ") + argv[i];

  CLI::App app{
      "Offline design: from a plant file to a gain file with a certificate that anybody can "
      "check."};
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 done, 1 a fault in files or usage of the plant, 2 a claim that does not "
      "hold, 3 no design found, 4 a claim that ball arithmetic can't decide, 130 interrupted, else "
      "wrong usage.");
  sdo::add_synthesize(app, command_line);
  sdo::add_analyze(app, command_line);
  sdo::add_verify(app);
  sdo::add_sweep(app, command_line);
  sdo::add_explain(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  } catch (const sdo::ExitStatus& exit) {
    return exit.status;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return sampled_data_observers::tool_main("design", run, argc, argv);
}
