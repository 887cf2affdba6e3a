// rosrun sampled_data_observers compare_estimates A.bag B.bag
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "console/option_checks.h"
#include "console/tool_main.h"
#include "replay/estimate_comparison.h"

namespace {

int run(int argc, char** argv) {
  CLI::App app{
      "Compares the estimates of two bags, say of a live run and of its replay. Where both rest on "
      "the same number of events they must be identical, bit for bit."};
  std::string first;
  std::string second;
  std::string topic = "/estimate";
  double at_least = 50.0;
  app.add_option("first", first, "A bag")->required()->type_name("BAG");
  app.add_option("second", second, "Another")->required()->type_name("BAG");
  app.add_option("--topic", topic, "Topic of the estimates (default /estimate)");
  app.add_option("--at-least", at_least,
                 "Percentage of all stamps that must be in both, on the same events (default 50)")
      ->check(sampled_data_observers::number_between(0.0, 100.0));
  app.footer(
      "Exit status: 0 they agree, 1 they do not, agree on too few or can't be read, else wrong "
      "usage.");
  CLI11_PARSE(app, argc, argv);
  const sampled_data_observers::EstimateComparison result =
      sampled_data_observers::compare_estimates(first, second, topic);
  const std::size_t all = std::max(result.first, result.second);
  const double share = 100.0 * static_cast<double>(result.identical) / static_cast<double>(all);
  std::printf("%zu and %zu estimates, %zu stamps in both\n", result.first, result.second,
              result.common);
  std::printf("identical bit for bit on %zu of %zu that rest on the same events: %.1f %% of all\n",
              result.identical, result.same_events, share);
  if (result.repeated_stamps) std::printf("a bag has estimates with repeated stamps\n");
  if (result.identical != result.same_events || result.repeated_stamps) {
    std::printf("they do not agree\n");
    return 1;
  }
  if (result.identical > 0 && share >= at_least) return 0;
  std::printf(
      "they agree, but on too few: expected %.9g %% of all (--at-least). Of the others, %zu rest\n"
      "on different events and %zu are in one bag only. With a publish_delay above the latency of\n"
      "all messages, estimates wait for their events.\n",
      at_least, result.common - result.same_events, all - result.common);
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  return sampled_data_observers::tool_main("compare_estimates", run, argc, argv);
}
