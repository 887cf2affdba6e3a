#include "config/design_config.h"

#include <limits>
#include <optional>
#include <stdexcept>

#include "config/claim_contradiction.h"
#include "config/dwell_times.h"
#include "config/event_times.h"
#include "config/named_values.h"
#include "config/plant_fingerprint.h"
#include "config/sampling_config.h"
#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/config/yaml_file.h"

namespace sampled_data_observers {
namespace {

/// What an observer's configuration says of the times between jumps, where it is one thing.
void take_watched_times(ConfigSection& root, CertificateSubject& subject) {
  ConfigSection jumps = root.section_or_empty("jumps");
  const std::optional<DwellTimes> times = read_dwell_times(jumps);
  if (!times) return;
  const bool has_interval = jumps.has("dwell_time");
  if (has_interval && !times->average && !times->reverse_average) {
    subject.T1 = to_seconds(times->shortest);
    subject.T2 = longest_to_seconds(times->longest.value_or(kNoLongestTime));
    return;
  }
  if (has_interval || (times->average && times->reverse_average)) return;
  const bool is_average = times->average.has_value();
  const DwellTimes::Average& average = is_average ? *times->average : *times->reverse_average;
  subject.T2 = std::numeric_limits<double>::infinity();
  subject.dwell_time =
      DwellTime{is_average ? DwellTime::Kind::kAverage : DwellTime::Kind::kReverseAverage,
                to_seconds(average.tau), average.N0};
}

/// Those of the section `design`, or else what an observer's configuration expects.
void read_design_times(ConfigSection& root, ConfigSection& design, const Plant& plant,
                       CertificateSubject& subject) {
  const std::optional<DwellTime> dwell_time = read_dwell_time(design);
  if (dwell_time) {
    if (design.has("sampling")) {
      throw design.error("sampling", "none beside a dwell time, which takes its place", "one");
    }
    subject.dwell_time = dwell_time;
    subject.T2 = std::numeric_limits<double>::infinity();
    return;
  }
  const bool has_own = design.has("sampling");
  const SamplingConfig sampling =
      has_own ? read_sampling_section(design, plant) : read_sampling(root, plant);
  if (sampling.is_empty()) return take_watched_times(root, subject);
  require_sampling(has_own ? design : root, plant, sampling);
  take_sampling(sampling, subject);
}

/// One for each state, of which not all are 0.
Eigen::VectorXd read_error_weights(ConfigSection& design, const std::vector<std::string>& states) {
  ConfigSection section = design.section("weights");
  Eigen::VectorXd weights(static_cast<Eigen::Index>(states.size()));
  for (std::size_t i = 0; i < states.size(); ++i) {
    weights(static_cast<Eigen::Index>(i)) = section.number_in(states[i], 0.0, 1e50, std::nullopt);
  }
  section.finish();
  if (weights.maxCoeff() == 0.0) {
    throw design.error("weights", "one that is not 0", "0 for each state");
  }
  return weights;
}

}  // namespace

DesignConfig read_design_config(const std::vector<std::string>& files,
                                const PlantPluginLoader& load_plugin) {
  std::vector<ConfigNode> trees;
  for (const std::string& file : files) trees.push_back(read_yaml_file(file));
  const ConfigNode tree = merge(trees);
  ConfigSection root(tree, "");
  DesignConfig config;
  const PlantConfig plant_config = read_plant(root, load_plugin);
  config.plant = plant_config.plant;
  config.names = plant_config.names;
  config.plant_hash = plant_fingerprint(tree);
  ConfigSection section = root.section_or_empty("design");
  const Eigen::Index n = config.plant->states();
  const StatedErrorMaps stated = read_stated_error_maps(section, n);
  try {
    config.subject.plant = matrices_of(*config.plant, stated);
  } catch (const std::invalid_argument& fault) {
    throw root.error("plant", "a plant that a design can be made for", fault.what());
  }
  ConfigSection plant = root.section("plant");
  require_no_contradiction(*config.plant, stated, plant, section);
  if (section.has("N")) config.subject.plant.N = section.matrix("N", n, -1);
  if (section.has("C_p")) config.subject.plant.C_p = section.matrix("C_p", -1, n);
  if (section.has("weights")) {
    config.subject.error_weights = read_error_weights(section, config.plant->state_names());
  }
  read_design_times(root, section, *config.plant, config.subject);
  ConfigSection parameters = section.section_or_empty("parameters");
  for (const std::string& name : parameters.keys()) {
    config.parameters[name] = parameters.number(name);
  }
  section.finish();
  ConfigSection assumptions = root.section_or_empty("error_assumptions");
  const auto assumption = [&](const char* key) -> std::optional<double> {
    if (!assumptions.has(key)) return std::nullopt;
    return assumptions.number_in(key, 0.0, 1e50, std::nullopt);
  };
  config.noise = assumption("noise");
  config.disturbance = assumption("disturbance");
  // Those of an observer.
  for (const char* key : {"initial_error", "latency", "output_rate"}) assumption(key);
  if (assumptions.has("injection_lipschitz")) assumptions.section("injection_lipschitz");
  assumptions.finish();
  return config;
}

}  // namespace sampled_data_observers
