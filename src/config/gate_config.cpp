#include "config/gate_config.h"

#include "sampled_data_observers/observer/plant_observer.h"
#include "sampled_data_observers/runtime/estimator.h"

namespace sampled_data_observers {
namespace {

constexpr double kSmallestLimit = 1e-100;
constexpr double kShortestRecovery = 1e-9;  // s: one tick of the clock
constexpr double kLongestRecovery = 1e6;    // s

/// One limit for all outputs, or one for each.
Eigen::VectorXd read_limits(ConfigSection& gate, Eigen::Index outputs) {
  if (!gate.is_list("innovation")) {
    const double limit = gate.number_in("innovation", kSmallestLimit, kLargestValue, std::nullopt);
    return Eigen::VectorXd::Constant(outputs, limit);
  }
  Eigen::VectorXd limits = gate.vector("innovation", outputs);
  if (limits.minCoeff() < kSmallestLimit) {
    throw gate.error("innovation", "positive numbers, in the units of the outputs",
                     "one that is not positive");
  }
  return limits;
}

void read_recovery(ConfigSection& section, Gate& gate) {
  ConfigSection recovery = section.section("recovery");
  gate.recover_after =
      from_seconds(recovery.number_in("after", kShortestRecovery, kLongestRecovery, std::nullopt));
  gate.recovery = recovery.choice("action", {"accept", "reset"}) == "reset"
                      ? Gate::Recovery::kReset
                      : Gate::Recovery::kAccept;
  recovery.finish();
}

Gate read_gate(ConfigSection section, const Sensor& sensor, bool has_covariance) {
  Gate gate;
  const bool is_absolute = section.has("innovation");
  if (is_absolute == section.has("mahalanobis")) {
    throw section.error(is_absolute ? "mahalanobis" : "innovation",
                        "one of innovation and mahalanobis",
                        is_absolute ? "both" : section.absence_of("innovation"));
  }
  if (is_absolute) {
    gate.innovation = read_limits(section, sensor.outputs());
  } else if (has_covariance) {
    gate.mahalanobis =
        section.number_in("mahalanobis", kSmallestLimit, kLargestValue, std::nullopt);
  } else {
    throw section.error("mahalanobis",
                        "innovation, a limit in the units of the outputs: only a "
                        "HybridKalmanFilter knows the covariance that mahalanobis takes",
                        "mahalanobis");
  }
  read_recovery(section, gate);
  section.finish();
  return gate;
}

}  // namespace

std::vector<std::optional<Gate>> read_gates(ConfigSection& root, const Plant& plant,
                                            const ObserverLaw& law) {
  Eigen::VectorXd state(law.state_size());
  law.initialize(state.data());
  const bool has_covariance = law.observer().covariance(state.data()) != nullptr;
  std::vector<std::optional<Gate>> gates;
  ConfigSection sensors = root.section("sensors");
  for (const Sensor& sensor : plant.sensors()) {
    gates.emplace_back();
    ConfigSection section = sensors.section(sensor.name);
    if (!section.has("gate")) continue;
    gates.back() = read_gate(section.section("gate"), sensor, has_covariance);
  }
  return gates;
}

}  // namespace sampled_data_observers
