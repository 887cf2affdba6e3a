#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "sampled_data_observers/config/config_node.h"
#include "sampled_data_observers/config/observer_config.h"
#include "simulation/scenario.h"
#include "simulation/simulator.h"
#include "support/told_jumps.h"
#include "support/trajectory.h"

namespace sampled_data_observers::test {

/// What came of running a scenario against an observer. Times are in seconds since the start, and
/// estimates rest on all events up to their stamp, however late these came.
struct ExampleRun {
  struct Jump {
    double time;
    std::vector<double> values;  ///< that the jump event carried
    Eigen::VectorXd estimate;    ///< after it
  };

  explicit ExampleRun(double period)
      : truth(period), estimate(period), error(period), error_bound(period), state_bounds(period) {}

  Trajectory truth;  ///< where there is an estimate
  Trajectory estimate;
  Trajectory error;        ///< estimate minus truth
  Trajectory error_bound;  ///< the guaranteed one, and those on each state
  Trajectory state_bounds;
  std::vector<double> sample_times;
  std::vector<Jump> jumps;  ///< of which the observer was told
  Simulator::End end = Simulator::End::kNone;
  double end_time = 0.0;
  /// Events that came twice, and those that were refused or had no effect for another reason.
  std::size_t duplicates = 0;
  std::size_t refused = 0;
};

/// The gains that a paper prints for its example.
constexpr char kPrinted[] = "gains_printed.yaml";

/// A directory in config/examples, with one of its files of gains, and
/// with what a test changes in it.
class Example {
 public:
  explicit Example(std::string name, std::string gains = "gains.yaml")
      : name_(std::move(name)), gains_(std::move(gains)) {}

  /// The estimate begins at t = 0, as in the papers' figures. As shipped it begins with the first
  /// event.
  Example& from_zero();
  Example& change_scenario(std::function<void(Scenario&)> change);
  /// Changes what the observer is told of the jumps of the plant, which jumps as it does.
  Example& tell(std::function<void(ToldJumps&)> change);
  Example& seed(std::uint64_t seed);
  Example& duration(double seconds);
  /// Replaces keys of the observer's files by those of a YAML text.
  Example& override_observer(const std::string& yaml);

  /// The files as `simulate` and the observers read them: plant.yaml, where there is one, comes
  /// with each scenario.
  Scenario scenario(const std::string& file) const;
  ConfigNode observer_tree(const std::string& scenario_file,
                           const std::string& observer_file) const;
  ObserverConfig observer(const std::string& scenario_file, const std::string& observer_file) const;

  ExampleRun run(const std::string& scenario_file = "scenario.yaml",
                 const std::string& observer_file = "observer.yaml") const;

 private:
  std::vector<ConfigNode> plant_and(const std::string& scenario_file) const;

  std::string name_;
  std::string gains_;
  bool from_zero_ = false;
  std::vector<std::function<void(Scenario&)>> changes_;
  std::function<void(ToldJumps&)> tell_;
  ConfigNode overriding_;
};

/// config/examples
std::string examples_folder();

}  // namespace sampled_data_observers::test
