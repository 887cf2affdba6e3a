#include "config/jump_config.h"

#include <utility>
#include <vector>

#include "config/dwell_times.h"
#include "config/expression_config.h"
#include "sampled_data_observers/runtime/estimator.h"

namespace sampled_data_observers {
namespace {

constexpr double kLongestTime = 1e6;    // s
constexpr double kShortestTime = 1e-9;  // s: one tick of the clock

/// One margin for all formulas of a set, or one for each.
/// @param formulas  of each mode, as many in each
StateSet read_margins(ConfigSection& section,
                      std::vector<std::shared_ptr<const VectorMap>> formulas) {
  const Eigen::Index size = formulas.front()->size();
  StateSet result{std::move(formulas), {}};
  if (!section.is_list("margin")) {
    const double margin = section.number_in("margin", 0.0, kLargestValue, std::nullopt);
    result.margins = Eigen::VectorXd::Constant(size, margin);
    return result;
  }
  result.margins = section.vector("margin", size);
  if (result.margins.minCoeff() < 0.0) {
    throw section.error("margin", "numbers that are not negative, in the units of the formulas",
                        "a negative one");
  }
  return result;
}

/// Of a set of the plant's modes.
StateSet read_margins(ConfigSection& section, const Plant& plant,
                      std::shared_ptr<const VectorMap> PlantMode::*set,
                      const std::string& set_key) {
  std::vector<std::shared_ptr<const VectorMap>> formulas;
  for (const PlantMode& mode : plant.modes()) formulas.push_back(mode.*set);
  if (!formulas.front()) {
    throw section.error("margin", "plant/" + set_key + " beside it, the formulas that it is about",
                        "none");
  }
  return read_margins(section, std::move(formulas));
}

RestState read_rest(ConfigSection& jumps, const PlantConfig& plant_config) {
  const Plant& plant = *plant_config.plant;
  if (plant.outputs(SensorTiming::kContinuous) > 0) {
    throw jumps.error("rest",
                      "no sensor with measured: continuous, which moves the estimate all "
                      "the time",
                      "one");
  }
  ConfigSection section = jumps.section("rest");
  const ExpressionReader reader(plant_config.names);
  RestState rest;
  const std::vector<std::shared_ptr<const VectorMap>> formulas_of_set(
      plant.modes().size(), reader.read_list(section, "set", 0));
  rest.set = read_margins(section, formulas_of_set);
  ConfigSection states = section.section("state");
  std::vector<NamedExpression> formulas;
  for (const std::string& name : plant.state_names()) {
    formulas.push_back({name, states.has(name) ? states.text(name) : name});
  }
  states.finish();
  try {
    rest.state = std::make_shared<const ExpressionMap>(plant_config.names,
                                                       std::vector<NamedExpression>{}, formulas);
  } catch (const ExpressionError& fault) {
    throw states.error(fault.name(), "a formula of the states that can be evaluated", fault.what());
  }
  section.finish();
  return rest;
}

JumpGate read_jump_gate(ConfigSection section, const Plant& plant) {
  JumpGate gate;
  gate.jump_set = read_margins(section, plant, &PlantMode::jump_set, "jump_set");
  ConfigSection recovery = section.section("recovery");
  gate.recover_after =
      from_seconds(recovery.number_in("after", kShortestTime, kLongestTime, std::nullopt));
  recovery.finish();
  section.finish();
  return gate;
}

MissingJumps read_missing_jumps(ConfigSection section, const Plant& plant, bool are_delayed) {
  MissingJumps missing;
  missing.flow_set = read_margins(section, plant, &PlantMode::flow_set, "flow_set");
  if (section.choice("action", {"report", "predict"}) == "predict") {
    missing.action = MissingJumps::Action::kPredict;
    if (plant.switches()) {
      throw section.error(
          "action", "report, for a plant that switches: nobody knows into which mode", "predict");
    }
    if (are_delayed) {
      throw section.error("action", "report with jumps/late: delayed", "predict");
    }
  }
  missing.step = plant.integration().step;
  section.finish();
  return missing;
}

}  // namespace

TopicSource read_jumps(ConfigSection& root, const PlantConfig& plant_config, LawLayers& layers,
                       Duration& stamp_error) {
  const Plant& plant = *plant_config.plant;
  ConfigSection section = root.section_or_empty("jumps");
  TopicSource source = read_jump_source(root, section, plant);
  layers.delays_jumps =
      section.has("late") && section.choice("late", {"rewind", "delayed"}) == "delayed";
  JumpLimits limits;
  limits.min_separation =
      from_seconds(section.number_in("min_separation", 0.0, kLongestTime, 1e-6));
  limits.max_per_second = section.number_in("max_per_second", 1.0, 1e6, 1000.0);
  layers.jump_limits = limits;
  stamp_error = from_seconds(read_stamp_error(section));
  if (section.has("gate")) layers.jump_gate = read_jump_gate(section.section("gate"), plant);
  if (section.has("missing")) {
    layers.missing = read_missing_jumps(section.section("missing"), plant, layers.delays_jumps);
  }
  if (section.has("rest")) layers.rest = read_rest(section, plant_config);
  layers.dwell_times = read_dwell_times(section);
  section.finish();
  return source;
}

}  // namespace sampled_data_observers
