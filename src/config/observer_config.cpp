#include "sampled_data_observers/config/observer_config.h"

#include <stdexcept>
#include <utility>

#include "config/contraction_check.h"
#include "config/dwell_times.h"
#include "config/fault_list.h"
#include "config/gate_config.h"
#include "config/guarantee_config.h"
#include "config/integration_check.h"
#include "config/jump_config.h"
#include "config/law_config.h"
#include "config/sampling_config.h"
#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/config/gains_config.h"
#include "sampled_data_observers/config/law_registry.h"
#include "sampled_data_observers/config/plant_config.h"
#include "sampled_data_observers/config/yaml_file.h"

namespace sampled_data_observers {
namespace {

constexpr double kShortest = 1e-9;  // s: one tick of the clock
constexpr double kLongest = 1e6;    // s
/// What a ROS stamp holds reaches a little further [s].
constexpr double kLatestStart = 4e9;

SamplingBounds bounds_of(const SamplingTimes& times) {
  return {from_seconds(times.T1), longest_from_seconds(times.T2)};
}

/// Required where samples come; a plant that is measured in the flow or at jumps only needs none.
SensorSampling read_sensor_sampling(ConfigSection& root, const Plant& plant) {
  const SamplingConfig sampling = read_sampling(root, plant);
  require_sampling(root, plant, sampling);
  if (plant.outputs(SensorTiming::kSampled) == 0) {
    const SamplingBounds of_jumps =
        sampling.jumps ? bounds_of(*sampling.jumps) : SamplingBounds{0, kNoLongestTime};
    return {of_jumps.T1, of_jumps.T2};
  }
  std::vector<std::optional<SamplingBounds>> of_sensors;
  for (const auto& times : sampling.sensors) {
    of_sensors.push_back(times ? std::optional<SamplingBounds>(bounds_of(*times)) : std::nullopt);
  }
  return SensorSampling(std::move(of_sensors));
}

/// Times between events that correct: of a plant without samples those between its jumps.
SensorSampling times_of_correction(ConfigSection& root, const Plant& plant,
                                   const SensorSampling& sampling,
                                   const std::optional<DwellTimes>& of_jumps) {
  const bool is_sampled = plant.outputs(SensorTiming::kSampled) > 0;
  if (is_sampled || root.has("sampling") || !of_jumps) return sampling;
  return {of_jumps->shortest, of_jumps->longest.value_or(kNoLongestTime)};
}

Timeline::Limits read_history(ConfigSection& root) {
  Timeline::Limits limits;
  limits.history = from_seconds(2.0);
  limits.max_events = 2000;
  if (!root.has("history")) return limits;
  ConfigSection section = root.section("history");
  limits.history = from_seconds(section.number_in("duration", kShortest, kLongest, 2.0));
  limits.max_events = section.count("max_events", 1, 1000000, 2000);
  section.finish();
  return limits;
}

/// Where estimates begin; nothing for the first event.
std::optional<Stamp> read_start(ConfigSection& root) {
  if (!root.has("start")) return std::nullopt;
  ConfigSection section = root.section("start");
  std::optional<Stamp> start;
  if (section.is_number("at")) {
    start = from_seconds(section.number_in("at", kShortest, kLatestStart, std::nullopt));
  } else if (section.text("at") != "first_event") {
    throw section.error("at", "a stamp in seconds, or first_event", "'" + section.text("at") + "'");
  }
  section.finish();
  return start;
}

RealTimeOptions read_real_time(ConfigSection& root) {
  ConfigSection section = root.section_or_empty("real_time");
  RealTimeOptions options;
  if (section.has("priority")) {
    options.priority = static_cast<int>(section.count("priority", 1, 99, 1));
  }
  options.lock_memory = section.flag("lock_memory", false);
  section.finish();
  return options;
}

/// Tells sources that a covariance is wanted beside their values.
void take_covariances(ConfigSection& root, ObserverConfig& config) {
  ConfigSection gains = root.section("gains");
  const auto wanted = read_message_covariances(gains, *config.plant);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (!wanted[i]) continue;
    TopicSource& source = *config.sensors[i];
    const SourceFrames& frames = source.frames;
    if (source.is_of_own_type() || frames.are_wanted_themselves()) {
      throw ConfigError(source.origin, source.path + "/type",
                        "a message type with a covariance, for gains/R from the message",
                        source.is_of_own_type() ? source.type : "tf");
    }
    if (frames.any()) {
      const bool is_frame = !frames.frame.empty();
      throw ConfigError(
          source.origin, source.path + (is_frame ? "/frame" : "/body_frame"),
          "none beside gains/R from the message, whose covariance is in its own frame",
          "'" + (is_frame ? frames.frame : frames.body_frame) + "'");
    }
    source.covariance = wanted[i];
  }
}

/// An observer that measures what it publishes itself would believe in whatever it estimates.
void require_no_loop(const ObserverConfig& config) {
  if (!config.outputs || !config.outputs->transform) return;
  const std::string& odom = config.outputs->transform->odom_frame;
  const std::string& child = odom.empty() ? config.outputs->base_frame : odom;
  for (const std::optional<TopicSource>& source : config.sensors) {
    if (!source || source->frames.child_frame != child) continue;
    if (source->frames.frame != config.outputs->world_frame) continue;
    throw ConfigError(source->origin, source->path + "/child_frame",
                      "a transform that others publish: outputs/tf publishes this one",
                      "'" + child + "' in '" + source->frames.frame + "'");
  }
}

/// What stands at the top and depends on nothing else.
void read_settings(ConfigSection& root, ObserverConfig& config) {
  config.options.future_tolerance =
      from_seconds(root.number_in("future_tolerance", 0.0, kLongest, 0.5));
  config.period = from_seconds(1.0 / root.number_in("rate", 1e-3, 1e5, 100.0));
  config.publish_delay = from_seconds(root.number_in("publish_delay", 0.0, kLongest, 0.0));
  config.frame_id = root.text("frame_id", "");
  config.publish_on_event = root.flag("publish_on_event", false);
  config.reset_on_time_jump_back = root.flag("reset_on_time_jump_back", false);
  config.jump_back_tolerance =
      from_seconds(root.number_in("jump_back_tolerance", 0.0, kLongest, 1.0));
  config.gains_directory = root.text("gains_directory", "");
}

}  // namespace

ObserverConfig read_observer_config(const ConfigNode& tree, const PlantPluginLoader& load_plugin) {
  ConfigSection root(tree, "");
  root.has("scenario");
  root.has("design");
  ObserverConfig config;
  if (!root.has("observer")) {
    throw root.error("observer",
                     "the type of the observer, which the gain file of 'design synthesize' names, "
                     "too: is that one missing beside the plant's?",
                     root.absence_of("observer"));
  }
  config.type = root.choice("observer", observer_types());
  const PlantConfig plant_config = read_plant(root, load_plugin);
  config.plant = plant_config.plant;
  config.units = plant_config.units;
  const Plant& plant = *config.plant;

  // What does not depend on each other is read on, so that all faults are told at once.
  FaultList faults;
  LawLayers layers;
  faults.attempt([&] { config.sensors = read_sensor_sources(root, plant); });
  faults.attempt([&] {
    config.law = read_law(root, plant_config);
    if (const auto error = objection_to_step(root, plant, *config.law, false)) {
      throw ConfigError(*error);
    }
  });
  faults.attempt([&] { config.inputs = read_input_sources(root, plant); });
  faults.attempt([&] {
    if (!plant.jumps()) return;
    config.jumps = read_jumps(root, plant_config, layers, config.options.jump_stamp_error);
  });
  faults.attempt([&] { config.static_transforms = read_static_transforms(root); });
  faults.attempt([&] { config.navsat = read_navsat(root); });
  faults.attempt([&] { config.options.sampling = read_sensor_sampling(root, plant); });
  faults.attempt([&] { config.options.history = read_history(root); });
  faults.attempt([&] { config.options.start = read_start(root); });
  faults.attempt([&] { config.real_time = read_real_time(root); });
  faults.attempt([&] { read_settings(root, config); });
  faults.require_none();
  for (const auto& source : config.sensors) config.has_topic.push_back(source.has_value());
  if (config.type == "HybridKalmanFilter") take_covariances(root, config);

  Guarantee guarantee = read_guarantee(root, tree, config, layers.delays_jumps);
  config.guarantee = std::move(guarantee.text);
  config.warning = std::move(guarantee.warning);
  if (!guarantee.remark.empty()) config.warnings.push_back(std::move(guarantee.remark));
  if (config.guarantee.empty()) {
    const std::string found = find_divergence(
        *config.law, plant,
        times_of_correction(root, plant, config.options.sampling, layers.dwell_times));
    if (!found.empty()) config.warnings.push_back("gains: " + found);
  }
  config.options.latency = guarantee.latency;
  layers.bound = std::move(guarantee.bound);
  layers.noise = guarantee.noise;
  for (const DwellTime& claimed : guarantee.dwell_times) watch(claimed, layers.dwell_times);
  faults.attempt([&] { layers.gates = read_gates(root, plant, *config.law); });
  faults.attempt([&] {
    config.outputs = read_outputs(root, {config.law->estimate_names(), config.plant->input_names()},
                                  config.frame_id, layers.bound != nullptr);
  });
  faults.require_none();
  config.law = assemble(config.law, config.plant, std::move(layers));
  require_no_loop(config);
  if (config.jumps && config.jumps->detector) {
    config.jumps->detector->future_tolerance = config.options.future_tolerance;
    config.jumps->detector->jump_back_tolerance = config.jump_back_tolerance;
  }
  // Otherwise stamps would leave the window before they are due, or an event from the tolerated
  // future would push all present ones out of it.
  if (config.publish_delay >= config.options.history.history) {
    throw root.error("publish_delay", "less than history/duration", "as much or more");
  }
  if (config.options.latency >= config.options.history.history) {
    throw root.error("error_assumptions/latency", "less than history/duration", "as much or more");
  }
  if (root.has("error_assumptions") &&
      config.options.latency + config.options.jump_stamp_error >= config.options.history.history) {
    throw root.error("jumps/stamp_error",
                     "with error_assumptions/latency, less than history/duration",
                     "as much or more");
  }
  if (config.options.future_tolerance >= config.options.history.history) {
    throw root.error("future_tolerance", "less than history/duration (it is 0.5 where not given)",
                     "as much or more");
  }
  if (config.publish_on_event && config.publish_delay > 0) {
    throw root.error("publish_on_event", "false, or publish_delay: 0", "true with a delay");
  }
  root.finish();
  return config;
}

ObserverConfig read_observer_config(const std::vector<std::string>& files,
                                    const PlantPluginLoader& load_plugin) {
  std::vector<ConfigNode> trees;
  for (const std::string& file : files) trees.push_back(read_yaml_file(file));
  return read_observer_config(merge(trees), load_plugin);
}

std::shared_ptr<const PlantPlugin> no_plant_plugins(const std::string& type) {
  throw std::runtime_error("this program loads no plug-ins, so not " + type);
}

}  // namespace sampled_data_observers
