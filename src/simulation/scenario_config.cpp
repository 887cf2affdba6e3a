#include "simulation/scenario_config.h"

#include <algorithm>
#include <utility>

#include "config/expression_config.h"
#include "config/sampling_config.h"
#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/config/topic_config.h"
#include "sampled_data_observers/config/yaml_file.h"
#include "simulation/sampling_check.h"
#include "simulation/schedule_config.h"
#include "simulation/topic_check.h"

namespace sampled_data_observers {
namespace {

constexpr double kLatestStart = 4e9;  // s: ros::Time ends at 2^32 s
constexpr std::size_t kLargestSeed = std::size_t{1} << 53;

const char kTimeName[] = "t";

/// What only an observer reads from the same tree.
const char* const kObserverKeys[] = {"observer",
                                     "gains",
                                     "sampling",
                                     "history",
                                     "rate",
                                     "outputs",
                                     "start",
                                     "static_transforms",
                                     "publish_on_event",
                                     "reset_on_time_jump_back",
                                     "jump_back_tolerance",
                                     "gains_directory",
                                     "real_time",
                                     "initial_estimate",
                                     "publish_delay",
                                     "frame_id",
                                     "future_tolerance",
                                     "certificate",
                                     "design",
                                     "error_assumptions",
                                     "allow_uncertified",
                                     "run_time_certificate"};

class ScenarioReader {
 public:
  ScenarioReader(ConfigSection& root, const PlantPluginLoader& load_plugin)
      : root_(root), names_(read_plant_into(load_plugin)), section_(root.section("scenario")) {}

  Scenario read() {
    read_clock();
    read_start();
    read_truth();
    if (plant().inputs() > 0) read_input();
    if (section_.has("disturbance")) read_disturbance();
    read_sensors();
    read_signals();
    read_jumps();
    section_.finish();
    check_topics(scenario_);
    return std::move(scenario_);
  }

 private:
  const Plant& plant() const { return *scenario_.plant; }

  ExpressionNames read_plant_into(const PlantPluginLoader& load_plugin) {
    PlantConfig config = read_plant(root_, load_plugin);
    scenario_.plant = std::move(config.plant);
    return std::move(config.names);
  }

  void read_clock() {
    scenario_.duration =
        from_seconds(section_.number_in("duration", kShortest, kLongest, std::nullopt));
    scenario_.start = from_seconds(section_.number_in("start", 1.0, kLatestStart, 1000.0));
    scenario_.seed = section_.count("seed", 0, kLargestSeed, 1);
  }

  void read_start() {
    scenario_.initial_state.resize(plant().states());
    ConfigSection values = section_.section("initial_state");
    for (Eigen::Index i = 0; i < plant().states(); ++i) {
      scenario_.initial_state(i) =
          values.number(plant().state_names()[static_cast<std::size_t>(i)]);
    }
    values.finish();
    if (!plant().switches()) return;
    if (!section_.has("initial_mode")) return;
    const std::optional<std::size_t> mode = plant().find_mode(section_.number("initial_mode"));
    if (!mode) {
      throw section_.error("initial_mode", "the label of a mode (" + labels() + ")",
                           "'" + section_.text("initial_mode") + "'");
    }
    scenario_.initial_mode = *mode;
  }

  std::string labels() const {
    std::string text;
    for (const PlantMode& mode : plant().modes()) {
      text += (text.empty() ? "" : ", ") + std::to_string(mode.label);
    }
    return text;
  }

  void read_truth() {
    ConfigSection truth = section_.section_or_empty("truth");
    scenario_.truth_topic = truth.text("topic", "truth");
    scenario_.truth_period = from_seconds(1.0 / truth.number_in("rate", 1e-3, 1e5, 100.0));
    truth.finish();
  }

  /// Names for formulas of the time, and of the states where `with_states`.
  ExpressionNames timed_names(const ConfigSection& section, const std::string& key,
                              bool with_states) const {
    ExpressionNames names;
    names.x = {kTimeName};
    names.constants = names_.constants;
    if (with_states) names.x.insert(names.x.end(), names_.x.begin(), names_.x.end());
    const auto is_time = [](const auto& constant) { return constant.first == kTimeName; };
    if (std::count(names.x.begin(), names.x.end(), kTimeName) > 1 ||
        std::any_of(names.constants.begin(), names.constants.end(), is_time)) {
      throw section.error(key, "formulas in which t is the time",
                          "a state or parameter that is called t as well");
    }
    return names;
  }

  /// A source whose messages can be simulated.
  TopicSource simulated(const TopicSource& source) {
    if (source.detector) {
      throw ConfigError(source.origin, source.path,
                        "a topic of jumps (no messages are simulated "
                        "that a detector finds them in; see scenario/signals)",
                        "a detector");
    }
    if (!source.frames.body_frame.empty()) {
      throw ConfigError(source.origin, source.path + "/body_frame",
                        "none (no transforms are simulated)", "'" + source.frames.body_frame + "'");
    }
    return source;
  }

  void read_input() {
    ConfigSection section = section_.section("input");
    InputScenario input;
    for (const TopicSource& source : read_input_sources(root_, plant())) {
      input.sources.push_back(simulated(source));
    }
    input.period = from_seconds(1.0 / section.number_in("rate", 1e-3, 1e5, 100.0));
    input.formulas = ExpressionReader(timed_names(section, "formulas", true))
                         .read_map(section, "formulas", plant().input_names());
    section.finish();
    scenario_.input = std::move(input);
  }

  void read_disturbance() {
    ConfigSection section = section_.section("disturbance");
    Disturbance disturbance;
    disturbance.N = section.matrix("N", plant().states(), -1);
    disturbance.formulas =
        ExpressionReader(timed_names(section, "formulas", false))
            .read_list(section, "formulas", static_cast<std::size_t>(disturbance.N.cols()));
    section.finish();
    scenario_.disturbance = std::move(disturbance);
  }

  void read_sensors() {
    const auto sources = read_sensor_sources(root_, plant());
    ConfigSection sensors = section_.section_or_empty("sensors");
    for (std::size_t i = 0; i < sources.size(); ++i) {
      const Sensor& sensor = plant().sensors()[i];
      SensorScenario scenario;
      if (sources[i]) scenario.source = simulated(*sources[i]);
      const bool at_jumps = sensor.timing == SensorTiming::kAtJumps;
      ConfigSection section =
          at_jumps ? sensors.section_or_empty(sensor.name) : sensors.section(sensor.name);
      if (!at_jumps) {
        scenario.schedule = read_schedule(section, FirstOfPeriod::kAtStart);
      } else if (section.has("schedule")) {
        throw section.error("schedule", "none for a sensor that measures at jumps", "one");
      }
      scenario.noise = read_noise(section, static_cast<std::size_t>(sensor.outputs()));
      if (sources[i]) scenario.delivery = read_delivery(section);
      section.finish();
      scenario_.sensors.push_back(std::move(scenario));
    }
    sensors.finish();
  }

  void read_signals() {
    ConfigSection signals = section_.section_or_empty("signals");
    for (const std::string& name : signals.keys()) {
      ConfigSection section = signals.section(name);
      SignalScenario signal;
      signal.name = name;
      signal.topic = section.text("topic", name);
      constexpr std::size_t kAnyNumber = 0;
      signal.formulas = ExpressionReader(timed_names(section, "formulas", true))
                            .read_list(section, "formulas", kAnyNumber);
      signal.schedule = read_schedule(section, FirstOfPeriod::kAtStart);
      signal.noise = read_noise(section, static_cast<std::size_t>(signal.formulas->size()));
      signal.delivery = read_delivery(section);
      section.finish();
      scenario_.signals.push_back(std::move(signal));
    }
    signals.finish();
  }

  Noise read_noise(ConfigSection& sensor, std::size_t outputs) const {
    Noise noise;
    if (!sensor.has("noise")) return noise;
    ConfigSection section = sensor.section("noise");
    const std::string key = only_key(section, {"uniform", "gaussian", "formulas"});
    if (key == "formulas") {
      noise.kind = Noise::Kind::kFormulas;
      noise.formulas =
          ExpressionReader(timed_names(section, key, false)).read_list(section, key, outputs);
    } else {
      noise.kind = key == "gaussian" ? Noise::Kind::kGaussian : Noise::Kind::kUniform;
      noise.size = read_sizes(section, key, outputs);
    }
    return noise;
  }

  /// One for all outputs, or one for each.
  static Eigen::VectorXd read_sizes(ConfigSection& section, const std::string& key,
                                    std::size_t outputs) {
    constexpr double kLargest = 1e100;
    const auto size = static_cast<Eigen::Index>(outputs);
    if (!section.is_list(key)) {
      return Eigen::VectorXd::Constant(size, section.number_in(key, 0.0, kLargest, std::nullopt));
    }
    Eigen::VectorXd sizes = section.vector(key, size);
    if (sizes.minCoeff() < 0.0 || sizes.maxCoeff() > kLargest) {
      throw section.error(key, "numbers from 0 to 1e100, in the units of the outputs", "others");
    }
    return sizes;
  }

  static Delivery read_delivery(ConfigSection& section) {
    Delivery delivery;
    if (section.has("latency")) {
      const Eigen::VectorXd bounds = section.vector("latency", 2);
      if (!(0.0 <= bounds(0) && bounds(0) <= bounds(1) && bounds(1) <= kLongest)) {
        throw section.error("latency", "[shortest, longest] with 0 <= shortest <= longest",
                            "bounds that are not so");
      }
      delivery.shortest = from_seconds(bounds(0));
      delivery.longest = from_seconds(bounds(1));
    }
    delivery.loss = section.number_in("loss", 0.0, 1.0, 0.0);
    delivery.duplication = section.number_in("duplication", 0.0, 1.0, 0.0);
    delivery.reordering = section.number_in("reordering", 0.0, 1.0, 0.0);
    if (delivery.reordering > 0.0 && delivery.longest == 0) {
      throw section.error("reordering", "a latency above 0 beside it: messages overtake late ones",
                          "none");
    }
    return delivery;
  }

  void read_jumps() {
    if (!plant().jumps()) {
      if (section_.has("jumps")) {
        throw section_.error("jumps", "a plant with a jump_map or modes", "one that never jumps");
      }
      return;
    }
    ConfigSection topic = root_.section_or_empty("jumps");
    scenario_.jumps_source = simulated(read_jump_source(root_, topic, plant()));
    // Of an observer.
    for (const char* key :
         {"late", "min_separation", "max_per_second", "stamp_error", "gate", "missing", "rest",
          "dwell_time", "average_dwell_time", "reverse_average_dwell_time"}) {
      topic.has(key);
    }
    topic.finish();
    if (!section_.has("jumps")) {
      if (plant().outputs(SensorTiming::kAtJumps) == 0) return;
      throw section_.error("jumps", "when the plant jumps: some sensors measure at jumps only",
                           "nothing (the key is missing)");
    }
    ConfigSection section = section_.section("jumps");
    JumpScenario jumps;
    if (section.has("when") == section.has("schedule")) {
      throw section_.error("jumps", "one of the keys when and schedule",
                           section.has("when") ? "both" : "none");
    }
    if (section.has("when")) {
      jumps.guard = read_guard(section);
    } else {
      jumps.schedule = read_schedule(section, FirstOfPeriod::kAfterPeriod);
    }
    if (plant().switches()) jumps.modes = read_modes(section);
    jumps.min_separation =
        from_seconds(section.number_in("min_separation", kShortest, kLongest, 1e-6));
    if (section.has("rest")) jumps.rest = read_rest(section);
    jumps.faults = read_detection_faults(section);
    jumps.delivery = read_delivery(section);
    section.finish();
    scenario_.jumps = std::move(jumps);
  }

  std::shared_ptr<const VectorMap> read_guard(ConfigSection& section) const {
    ExpressionNames names = names_;
    names.u.clear();
    const NamedExpression guard{"when", section.text("when")};
    try {
      return std::make_shared<const ExpressionMap>(names, std::vector<NamedExpression>{},
                                                   std::vector<NamedExpression>{guard});
    } catch (const ExpressionError& fault) {
      throw section.error("when", "a formula of the states that can be evaluated", fault.what());
    }
  }

  RestScenario read_rest(ConfigSection& jumps) const {
    if (!jumps.has("when")) {
      throw jumps.error("rest", "the key when beside it: only jumps at crossings end", "none");
    }
    ExpressionNames names = names_;
    names.u.clear();
    ConfigSection section = jumps.section("rest");
    RestScenario rest;
    std::vector<NamedExpression> state;
    for (const std::string& name : plant().state_names()) {
      rest.held.push_back(section.has(name));
      state.push_back({name, rest.held.back() ? section.text(name) : name});
    }
    section.finish();
    if (section.keys().empty()) throw jumps.error("rest", "at least one state", "none");
    try {
      rest.state =
          std::make_shared<const ExpressionMap>(names, std::vector<NamedExpression>{}, state);
    } catch (const ExpressionError& fault) {
      throw section.error(fault.name(), "a formula of the states that can be evaluated",
                          fault.what());
    }
    return rest;
  }

  static DetectionFaults read_detection_faults(ConfigSection& section) {
    DetectionFaults faults;
    faults.stamp_error = from_seconds(section.number_in("stamp_error", 0.0, kLongest, 0.0));
    faults.missed = section.number_in("missed", 0.0, 1.0, 0.0);
    faults.duplicate = section.number_in("duplicate", 0.0, 1.0, 0.0);
    faults.false_rate = section.number_in("false_rate", 0.0, 1e6, 0.0);
    return faults;
  }

  std::vector<int> read_modes(ConfigSection& section) const {
    std::vector<int> modes;
    for (const std::string& text : section.texts("modes")) {
      const auto fits = [&](const PlantMode& mode) { return std::to_string(mode.label) == text; };
      const auto found = std::find_if(plant().modes().begin(), plant().modes().end(), fits);
      if (found == plant().modes().end()) {
        throw section.error("modes", "labels of modes (" + labels() + ")", "'" + text + "'");
      }
      modes.push_back(found->label);
    }
    if (modes.empty()) throw section.error("modes", "at least one label", "an empty list");
    return modes;
  }

  ConfigSection& root_;
  Scenario scenario_;
  ExpressionNames names_;
  ConfigSection section_;
};

}  // namespace

Scenario read_scenario(const ConfigNode& tree, const PlantPluginLoader& load_plugin) {
  ConfigSection root(tree, "");
  for (const char* key : kObserverKeys) root.has(key);
  Scenario scenario = ScenarioReader(root, load_plugin).read();
  scenario.navsat = read_navsat(root);
  scenario.warnings = schedules_outside(scenario, read_sampling(root, *scenario.plant));
  root.finish();
  return scenario;
}

Scenario read_scenario(const std::vector<std::string>& files,
                       const PlantPluginLoader& load_plugin) {
  std::vector<ConfigNode> trees;
  for (const std::string& file : files) trees.push_back(read_yaml_file(file));
  return read_scenario(merge(trees), load_plugin);
}

}  // namespace sampled_data_observers
