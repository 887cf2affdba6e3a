#include "config/injection_config.h"

#include <string>

#include "config/claim_contradiction.h"

namespace sampled_data_observers {
namespace {

constexpr double kLargestConstant = 1e50;

/// What the flow makes of an output that it takes in place of a state; n entries.
Eigen::VectorXd read_injection_constants(ConfigSection& section, const Plant& plant,
                                         const OutputInjection& injection) {
  const auto state = static_cast<std::size_t>(injection.state);
  const std::string& name = plant.state_names()[state];
  const Sensor& sensor = plant.sensors()[injection.sensor];
  const AffineMap* output = plant.modes().front().outputs[injection.sensor]->affine();
  Eigen::RowVectorXd picks = Eigen::RowVectorXd::Zero(plant.states());
  picks(injection.state) = 1.0;
  if (output == nullptr || output->M() != picks || !output->c().isZero(0.0) ||
      !output->N().isZero(0.0)) {
    throw section.error("injection_lipschitz",
                        "a sensor '" + sensor.name + "' whose output is the state " + name +
                            ", since gains/output_injection takes it in its place",
                        "one with another output");
  }
  Eigen::VectorXd constants = Eigen::VectorXd::Zero(plant.states());
  ConfigSection each = section.section("injection_lipschitz");
  for (Eigen::Index i = 0; i < plant.states(); ++i) {
    const std::string& key = plant.state_names()[static_cast<std::size_t>(i)];
    constants(i) = each.number_in(key, 0.0, kLargestConstant, 0.0);
  }
  each.finish();
  return constants;
}

}  // namespace

std::optional<Eigen::VectorXd> read_injection(ConfigSection& section, const LawGains& law,
                                              const Plant& plant, const Eigen::VectorXd& centre) {
  const bool has_key = section.has("injection_lipschitz");
  if (law.output_injections.empty()) {
    if (!has_key) return std::nullopt;
    throw section.error("injection_lipschitz", "gains/output_injection beside it", "none");
  }
  if (!has_key) {
    throw section.error("injection_lipschitz",
                        "for each state how much of its derivative the injected output makes at "
                        "most per unit, such as the line 'injection_lipschitz: {" +
                            plant.state_names().front() +
                            ": 2.5}' (others: 0), since that output "
                            "is known up to noise and hold only",
                        "none");
  }
  // Of one sensor, since there is one of each timing.
  if (law.output_injections.size() > 1) {
    throw section.error("injection_lipschitz", "one state in gains/output_injection", "several");
  }
  const OutputInjection& injection = law.output_injections.front();
  const Eigen::VectorXd constants = read_injection_constants(section, plant, injection);
  if (const auto found = refute_injection_constants(plant, injection, constants, centre)) {
    throw section.error(found->key, found->expected, found->found);
  }
  return constants;
}

}  // namespace sampled_data_observers
