#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "console/option_checks.h"
#include "design/design_method.h"
#include "design/ell_check.h"
#include "messages/plant_plugins.h"
#include "observer/transformed_high_gain_observer.h"
#include "sampled_data_observers/config/observer_config.h"
#include "tools/design/commands.h"

namespace sampled_data_observers {
namespace {

struct CheckEllArguments {
  std::vector<std::string> files;
  std::size_t points = 2000;
  std::optional<double> dwell_time;  // [s]
};

void check_ell_command(const CheckEllArguments& arguments) {
  const ObserverConfig config = read_observer_config(arguments.files, load_plant_plugin);
  const auto* law = dynamic_cast<const TransformedHighGainObserver*>(&config.law->observer());
  if (law == nullptr) {
    throw DesignError(
        "expected a HighGainObserver of the form transformed, which has Theta and Phi to try, "
        "found another one. The linear form converges with any ell; the original one can be tried "
        "as a "
        "transformed one");
  }
  if (law->plant().outputs(SensorTiming::kContinuous) != 1) {
    throw DesignError("expected a plant with one output, found several: they are not tried");
  }
  if (arguments.dwell_time && (!law->plant().jumps() || law->plant().switches())) {
    throw DesignError("--dwell-time: expected a plant that jumps and does not switch");
  }
  std::vector<EllCheck> checks;
  bool has_second = false;
  for (std::size_t mode = 0; mode < law->maps().size(); ++mode) {
    checks.push_back(check_ell(*law, mode, arguments.points, arguments.dwell_time));
    has_second = has_second || checks.back().second.has_value();
  }
  std::printf("%s", ell_report(*law, checks).c_str());
  if (has_second) throw ExitStatus{kNotVerified};
}

}  // namespace

void add_check_ell(CommandLine& tool) {
  CommandLine& command = tool.command(
      "check_ell", "Whether ell of a high-gain observer is large enough for its saturations");
  auto arguments = std::make_shared<CheckEllArguments>();
  command.argument("CONFIG...", arguments->files, "Files of an observer: plant, sensors, gains");
  command.option("--points N", arguments->points, "How many points of the box to try")
      .check(whole_number_between(10, 1000000));
  command
      .option("--dwell-time SECONDS", arguments->dwell_time,
              "Shortest time between jumps, or an average one: for the ell of corollary 4.1")
      .check(number_above(0));
  command.action([arguments] {
    check_ell_command(*arguments);
    return 0;
  });
}

}  // namespace sampled_data_observers
