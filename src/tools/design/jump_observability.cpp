#include "design/jump_observability.h"

#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/design_config.h"
#include "console/option_checks.h"
#include "design/design_method.h"
#include "design/paragraphs.h"
#include "messages/plant_plugins.h"
#include "tools/design/commands.h"

namespace sampled_data_observers {
namespace {

struct JumpObservabilityArguments {
  std::vector<std::string> files;
  std::optional<double> T1;  // [s]
  std::optional<double> T2;  // [s]
  std::optional<std::size_t> jumps;
  std::size_t points = 9;
};

/// Of the largest gramian that outputs of such plants have, what is taken for rounding.
constexpr double kRoundingOfTimes = 1e-12;

void jump_observability_command(const JumpObservabilityArguments& arguments) {
  CertificateSubject subject = read_design_config(arguments.files, load_plant_plugin).subject;
  if (arguments.T2) subject.T2 = *arguments.T2;
  if (arguments.T1) subject.T1 = *arguments.T1;
  if (!(subject.T2 > 0.0)) throw DesignError("T2 is not given: --T2 or design/sampling");
  if (std::isinf(subject.T2)) {
    throw DesignError("T2 = inf: intervals are tried up to a longest one; give --T2");
  }
  if (subject.T1 > subject.T2) throw DesignError("T1 > T2");
  const std::size_t jumps =
      arguments.jumps.value_or(static_cast<std::size_t>(subject.plant.states()));
  const JumpObservability found = jump_observability(subject, jumps, arguments.points);
  std::string intervals;
  for (const double tau : found.worst_intervals)
    intervals += (intervals.empty() ? "" : ", ") + brief(tau);
  const bool is_seen = found.least_gramian > kRoundingOfTimes;
  std::printf(
      "the state before %zu intervals of flow in [%s, %s] s, from the outputs at the jumps behind "
      "them:\n",
      jumps, brief(subject.T1).c_str(), brief(subject.T2).c_str());
  std::printf("  %s: least eigenvalue of the observability gramian %s, with intervals of %s s\n",
              is_seen ? "observable" : "NOT OBSERVABLE",
              brief(is_seen ? found.least_gramian : 0.0).c_str(), intervals.c_str());
  std::printf("  found by trying all sequences of %zu equidistant lengths, no proof\n",
              arguments.points);
  if (!is_seen) throw ExitStatus{kNotVerified};
}

}  // namespace

void add_jump_observability(CommandLine& tool) {
  CommandLine& command = tool.command(
      "jump_observability", "Whether outputs at jumps show the state, over several jumps");
  auto arguments = std::make_shared<JumpObservabilityArguments>();
  command.argument("PLANT...", arguments->files, "Files with plant, sensors and design");
  command.option("--T1 SECONDS", arguments->T1, "Instead of design/sampling/T1 [s]")
      .check(number_at_least(0));
  command.option("--T2 SECONDS", arguments->T2, "Instead of design/sampling/T2 [s]")
      .check(number_above(0));
  command.option("--jumps N", arguments->jumps, "Over how many jumps; by default as many as states")
      .check(whole_number_between(1, 20));
  command
      .option("--points N", arguments->points,
              "How many lengths of each interval in [T1, T2] to try")
      .check(whole_number_between(1, 1000));
  command.action([arguments] {
    jump_observability_command(*arguments);
    return 0;
  });
}

}  // namespace sampled_data_observers
