#include "support/example_run.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <utility>

#include "sampled_data_observers/config/yaml_file.h"
#include "sampled_data_observers/runtime/estimator.h"
#include "simulation/scenario_config.h"

namespace sampled_data_observers::test {
namespace {

/// Gives the messages of a simulation to an estimator, as the nodelets do, and asks it for the
/// estimates at the stamps of the truth and of the jumps once all events up to these have come.
class Runner {
 public:
  Runner(Scenario scenario, const ObserverConfig& config, bool from_zero)
      : config_(config),
        start_(scenario.start),
        simulator_(std::move(scenario)),
        estimator_(config.law, config.options),
        estimate_(estimator_.make_estimate()),
        run_(to_seconds(simulator_.scenario().truth_period)) {
    if (from_zero) estimator_.restart(start_ - 1);
  }

  ExampleRun run(const std::function<void(ToldJumps&)>& change) {
    std::vector<SimulatedMessage> messages;
    while (auto message = simulator_.next()) messages.push_back(std::move(*message));
    if (change) {
      ToldJumps jumps(simulator_, std::move(messages));
      change(jumps);
      messages = std::move(jumps).messages();
    }
    Duration longest_latency = 0;
    for (const SimulatedMessage& message : messages) {
      longest_latency = std::max(longest_latency, message.arrival - message.stamp);
    }
    for (const SimulatedMessage& message : messages) {
      while (!questions_.empty() && questions_.begin()->first + longest_latency < message.arrival) {
        answer_next();
      }
      take(message);
    }
    while (!questions_.empty()) answer_next();
    run_.end = simulator_.end();
    run_.end_time = to_seconds(simulator_.time());
    return std::move(run_);
  }

 private:
  void take(const SimulatedMessage& message) {
    const SimulatedChannel& channel = simulator_.channels()[message.channel];
    const std::vector<double>& values = message.values;
    Event event;
    event.stamp = message.stamp;
    switch (channel.kind) {
      case SimulatedChannel::Kind::kTruth:
        questions_.emplace(message.stamp, message);
        return;
      case SimulatedChannel::Kind::kSignal:
        return;
      case SimulatedChannel::Kind::kInput:
        event.kind = EventKind::kInput;
        event.sensor = static_cast<int>(*channel.readings.front().input_channel);
        break;
      case SimulatedChannel::Kind::kJump:
        event.kind = EventKind::kJump;
        event.release = message.arrival;
        if (config_.plant->switches()) event.mode = message.mode;
        break;
      case SimulatedChannel::Kind::kMeasurement:
        event.sensor = sensor_of(channel.topic);
        event.kind = is_continuous(event.sensor) ? EventKind::kOutput : EventKind::kSample;
        break;
    }
    event.values = values.data();
    event.size = static_cast<Eigen::Index>(values.size());
    count(estimator_.submit(event, message.arrival), event);
    if (channel.kind == SimulatedChannel::Kind::kJump) questions_.emplace(message.stamp, message);
  }

  int sensor_of(const std::string& topic) const {
    for (std::size_t i = 0; i < config_.sensors.size(); ++i) {
      if (config_.sensors[i] && config_.sensors[i]->topic == topic) return static_cast<int>(i);
    }
    throw std::logic_error("no sensor listens to " + topic);
  }
  bool is_continuous(int sensor) const {
    return config_.plant->sensors()[static_cast<std::size_t>(sensor)].timing ==
           SensorTiming::kContinuous;
  }

  void count(const EventReport& report, const Event& event) {
    if (report.outcome == EventOutcome::kDuplicate) {
      ++run_.duplicates;
    } else if (!report.used()) {
      ++run_.refused;
    } else if (event.kind == EventKind::kSample) {
      run_.sample_times.push_back(to_seconds(event.stamp - start_));
    }
  }

  void answer_next() {
    const SimulatedMessage question = std::move(questions_.begin()->second);
    questions_.erase(questions_.begin());
    const Timeline::Query query = estimator_.estimate_at(question.stamp, estimate_);
    if (query == Timeline::Query::kNoEvent || query == Timeline::Query::kBeforeStart) return;
    if (query != Timeline::Query::kOk) throw std::runtime_error("an estimate is missing");
    const double time = to_seconds(question.stamp - start_);
    const Eigen::VectorXd estimate = estimate_.state.head(config_.plant->states());
    if (simulator_.channels()[question.channel].kind == SimulatedChannel::Kind::kJump) {
      run_.jumps.push_back({time, question.values, estimate});
      return;
    }
    const Eigen::VectorXd truth =
        Eigen::Map<const Eigen::VectorXd>(question.values.data(), estimate.size());
    run_.truth.add(time, truth);
    run_.estimate.add(time, estimate);
    run_.error.add(time, estimate - truth);
    run_.error_bound.add(
        time, Eigen::VectorXd::Constant(1, config_.law->error_bound(estimate_.state.data())));
    if (!config_.law->has_bound()) return;
    Eigen::VectorXd bounds(estimate.size());
    Eigen::VectorXd workspace(config_.law->workspace_size());
    config_.law->state_bounds(estimate_.state.data(), workspace.data(), bounds);
    run_.state_bounds.add(time, bounds);
  }

  const ObserverConfig& config_;
  Stamp start_;
  Simulator simulator_;
  Estimator estimator_;
  Estimate estimate_;
  ExampleRun run_;
  /// Truth and jumps.
  std::multimap<Stamp, SimulatedMessage> questions_;
};

}  // namespace

std::string examples_folder() { return std::string(SDO_SOURCE_DIR) + "/config/examples/"; }

Example& Example::from_zero() {
  from_zero_ = true;
  return *this;
}

Example& Example::change_scenario(std::function<void(Scenario&)> change) {
  changes_.push_back(std::move(change));
  return *this;
}

Example& Example::tell(std::function<void(ToldJumps&)> change) {
  tell_ = std::move(change);
  return *this;
}

Example& Example::seed(std::uint64_t seed) {
  return change_scenario([=](Scenario& scenario) { scenario.seed = seed; });
}

Example& Example::duration(double seconds) {
  return change_scenario([=](Scenario& scenario) { scenario.duration = from_seconds(seconds); });
}

Example& Example::override_observer(const std::string& yaml) {
  overriding_ = override_with(overriding_, read_yaml_text(yaml, "overriding"));
  return *this;
}

std::vector<ConfigNode> Example::plant_and(const std::string& scenario_file) const {
  const std::string folder = examples_folder() + name_ + "/";
  std::vector<ConfigNode> trees;
  if (std::filesystem::exists(folder + "plant.yaml")) {
    trees.push_back(read_yaml_file(folder + "plant.yaml"));
  }
  trees.push_back(read_yaml_file(folder + scenario_file));
  return trees;
}

Scenario Example::scenario(const std::string& file) const {
  Scenario scenario = read_scenario(merge(plant_and(file)), no_plant_plugins);
  for (const auto& change : changes_) change(scenario);
  return scenario;
}

ConfigNode Example::observer_tree(const std::string& scenario_file,
                                  const std::string& observer_file) const {
  std::vector<ConfigNode> trees = plant_and(scenario_file);
  for (const std::string& file : {observer_file, gains_}) {
    trees.push_back(read_yaml_file(examples_folder() + name_ + "/" + file));
  }
  return override_with(merge(trees), overriding_);
}

ObserverConfig Example::observer(const std::string& scenario_file,
                                 const std::string& observer_file) const {
  return read_observer_config(observer_tree(scenario_file, observer_file), no_plant_plugins);
}

ExampleRun Example::run(const std::string& scenario_file, const std::string& observer_file) const {
  return Runner(scenario(scenario_file), observer(scenario_file, observer_file), from_zero_)
      .run(tell_);
}

}  // namespace sampled_data_observers::test
