// rosrun sampled_data_observers compare_estimates A.bag B.bag
#include <algorithm>
#include <cstdio>
#include <string>

#include "console/command_line.h"
#include "console/option_checks.h"
#include "console/tool_main.h"
#include "replay/estimate_comparison.h"

namespace {

struct Arguments {
  std::string first;
  std::string second;
  std::string topic = "/estimate";
  double at_least = 50.0;
};

int compare(const Arguments& arguments) {
  const sampled_data_observers::EstimateComparison result =
      sampled_data_observers::compare_estimates(arguments.first, arguments.second, arguments.topic);
  const std::size_t all = std::max(result.first, result.second);
  const double share = 100.0 * static_cast<double>(result.identical) / static_cast<double>(all);
  std::printf("%zu and %zu estimates, %zu stamps in both\n", result.first, result.second,
              result.common);
  std::printf("identical bit for bit on %zu of %zu that rest on the same events: %.1f %% of all\n",
              result.identical, result.same_events, share);
  if (result.common == 0) {
    std::printf(
        "nothing to compare. Live, estimates have stamps of the clock: play bags with --clock and\n"
        "/use_sim_time true, or replay what was recorded beside the estimates.\n");
    return 1;
  }
  if (result.repeated_stamps) std::printf("a bag has estimates with repeated stamps\n");
  if (result.identical != result.same_events || result.repeated_stamps) {
    std::printf("they do not agree\n");
    return 1;
  }
  if (result.identical > 0 && share >= arguments.at_least) return 0;
  std::printf(
      "they agree, but on too few: expected %.9g %% of all (--at-least). Of the others, %zu rest\n"
      "on different events and %zu are in one bag only. With a publish_delay above the latency of\n"
      "all messages, estimates wait for their events.\n",
      arguments.at_least, result.common - result.same_events, all - result.common);
  return 1;
}

int run(int argc, char** argv) {
  sampled_data_observers::CommandLine tool(
      "compare_estimates",
      "Compares the estimates of two bags, say of a live run and of its replay. Where both rest on "
      "the same events they must be identical, bit for bit.",
      "Exit status: 0 they agree, 1 they do not, agree on too few or can't be read, else wrong "
      "usage.");
  Arguments arguments;
  tool.argument("FIRST_BAG", arguments.first, "A bag");
  tool.argument("SECOND_BAG", arguments.second, "Another");
  tool.option("--topic TOPIC", arguments.topic, "Topic of the estimates");
  tool.option("--at-least PERCENTAGE", arguments.at_least,
              "Percentage of all stamps that must be in both, on the same events")
      .check(sampled_data_observers::number_between(0.0, 100.0));
  tool.action([&arguments] { return compare(arguments); });
  return tool.run(argc, argv);
}

}  // namespace

int main(int argc, char** argv) {
  return sampled_data_observers::tool_main("compare_estimates", run, argc, argv);
}
