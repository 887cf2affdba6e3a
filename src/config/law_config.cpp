#include "config/law_config.h"

#include <algorithm>
#include <utility>

#include "certificate/guaranteed_bound.h"
#include "observer/delayed_jumps.h"
#include "observer/numbered_jumps.h"
#include "sampled_data_observers/config/law_registry.h"

namespace sampled_data_observers {
namespace {

Eigen::VectorXd read_initial_estimate(ConfigSection& root, const std::vector<std::string>& states) {
  Eigen::VectorXd estimate = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(states.size()));
  if (!root.has("initial_estimate")) return estimate;
  ConfigSection section = root.section("initial_estimate");
  for (std::size_t i = 0; i < states.size(); ++i) {
    estimate(static_cast<Eigen::Index>(i)) = section.number(states[i]);
  }
  section.finish();
  return estimate;
}

constexpr double kLargestStampError = 1e6;  // s

}  // namespace

double read_stamp_error(ConfigSection& jumps) {
  return jumps.number_in("stamp_error", 0.0, kLargestStampError, 0.0);
}

std::shared_ptr<const ObserverLaw> read_law(ConfigSection& root, const PlantConfig& plant) {
  const std::string type = root.choice("observer", observer_types());
  LawContext context;
  context.observer.plant = plant.plant;
  context.observer.initial_estimate = read_initial_estimate(root, plant.plant->state_names());
  context.observer.initial_input = Eigen::VectorXd::Zero(plant.plant->inputs());
  context.names = plant.names;
  if (plant.plant->jumps()) {
    ConfigSection jumps = root.section_or_empty("jumps");
    context.jump_stamp_error = read_stamp_error(jumps);
  }
  ConfigSection gains = root.section("gains");
  std::shared_ptr<const ObserverLaw> law = build_law(type, gains, context);
  gains.finish();
  return law;
}

std::shared_ptr<const ObserverLaw> assemble(std::shared_ptr<const ObserverLaw> law,
                                            const std::shared_ptr<const Plant>& plant,
                                            LawLayers layers) {
  if (layers.delays_jumps) law = std::make_shared<const DelayedJumps>(law);
  if (layers.rest) law = std::make_shared<const RestingEstimate>(law, std::move(*layers.rest));
  if (layers.missing) law = std::make_shared<const MissingJumpsWatch>(law, *layers.missing);
  if (layers.jump_limits) {
    law = std::make_shared<const LimitedJumps>(law, *layers.jump_limits);
    if (layers.jump_gate) law = std::make_shared<const PossibleJumps>(law, *layers.jump_gate);
    law = std::make_shared<const NumberedJumps>(law);
    if (layers.dwell_times) {
      law = std::make_shared<const DwellTimesWatch>(law, *layers.dwell_times);
    }
  }
  if (layers.bound) {
    law =
        std::make_shared<const GuaranteedBound>(law, std::move(layers.bound), plant, layers.noise);
  }
  const bool is_gated =
      std::any_of(layers.gates.begin(), layers.gates.end(),
                  [](const std::optional<Gate>& gate) { return gate.has_value(); });
  if (is_gated) law = std::make_shared<const GatedMeasurements>(law, std::move(layers.gates));
  return law;
}

}  // namespace sampled_data_observers
