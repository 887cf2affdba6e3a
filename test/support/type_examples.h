#pragma once

#include <random>
#include <string>
#include <vector>

#include "observer/gated_measurements.h"
#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/observer/plant_observer.h"
#include "support/random_events.h"

namespace sampled_data_observers::test {

/// The configurations in test/types: every observer type, with its variants, on small plants with
/// all channels that the type can take.
inline std::vector<std::string> type_examples() {
  return {"constant_gain",
          "constant_gain_delayed",
          "constant_gain_inputs",
          "constant_gain_nonlinear",
          "high_gain_linear",
          "high_gain_original",
          "high_gain_switched",
          "high_gain_transformed",
          "hybrid_kalman_filter",
          "hybrid_kalman_filter_formulas",
          "hybrid_kalman_filter_switched",
          "hybrid_kalman_filter_unit_norm",
          "hybrid_kalman_filter_unscented",
          "hybrid_kalman_filter_unscented_unit_norm",
          "intersample_injection",
          "intersample_injection_lipschitz",
          "sample_and_hold",
          "switched",
          "switched_projection_delayed",
          "synchronized",
          "synchronized_nonlinear_delayed",
          "time_varying_gain",
          "time_varying_gain_inverse",
          "time_varying_gain_scheduled"};
}

inline ObserverConfig read_example(const std::string& name) {
  return read_observer_config(
      std::vector<std::string>{std::string(SDO_SOURCE_DIR) + "/test/types/" + name + ".yaml"},
      no_plant_plugins);
}

/// Narrow gates on all measurements of an observer, which recover by turns in both ways.
inline std::vector<std::optional<Gate>> narrow_gates(const ObserverConfig& config) {
  Eigen::VectorXd state(config.law->state_size());
  config.law->initialize(state.data());
  const bool has_covariance = config.law->observer().covariance(state.data()) != nullptr;
  std::vector<std::optional<Gate>> gates;
  bool reset = false;
  for (const Sensor& sensor : config.plant->sensors()) {
    gates.emplace_back();
    Gate gate;
    gate.recover_after = kNanosecondsPerSecond / 5;
    gate.recovery = reset ? Gate::Recovery::kReset : Gate::Recovery::kAccept;
    if (has_covariance) {
      gate.mahalanobis = 0.5;
    } else {
      gate.innovation = Eigen::VectorXd::Constant(sensor.outputs(), 0.3);
    }
    gates.back() = gate;
    reset = !reset;
  }
  return gates;
}

/// `size` events of all channels of a law in [start, start + span], some with equal stamps, no two
/// equal. Modes are 1 and 2.
inline std::vector<OwnedEvent> random_events_for(const ObserverLaw& law, std::mt19937_64& generator,
                                                 std::size_t size, Stamp start, Duration span) {
  std::vector<OwnedEvent> channels;
  const PlantObserver& observer = law.observer();
  const auto add = [&](EventKind kind, std::size_t sensor, Eigen::Index size) {
    channels.push_back(
        {0, kind, static_cast<int>(sensor), std::vector<double>(static_cast<std::size_t>(size))});
  };
  for (const EventKind kind : {EventKind::kInput, EventKind::kOutput, EventKind::kJump,
                               EventKind::kJumpOutput, EventKind::kSample}) {
    std::size_t sources = kind == EventKind::kJump ? 1 : observer.sensors();
    if (kind == EventKind::kInput) sources = observer.plant().input_channels().size();
    for (std::size_t sensor = 0; sensor < sources; ++sensor) {
      const Eigen::Index size = observer.event_size(kind, sensor);
      if (size < 0) continue;
      if (kind == EventKind::kJump && size > 0) add(kind, sensor, 0);
      add(kind, sensor, size);
    }
  }
  std::uniform_int_distribution<Stamp> stamp(start, start + span);
  std::uniform_int_distribution<std::size_t> choice(0, channels.size() - 1);
  std::uniform_int_distribution<int> tenth(0, 9);
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  std::vector<OwnedEvent> events;
  while (events.size() < size) {
    OwnedEvent event = channels[choice(generator)];
    event.stamp = stamp(generator);
    if (!events.empty() && tenth(generator) < 3) event.stamp = events.back().stamp;
    for (double& number : event.values) number = value(generator);
    if (event.kind == EventKind::kJump && observer.plant().switches()) {
      event.mode = tenth(generator) < 5 ? 1.0 : 2.0;
    }
    if (event.kind == EventKind::kJump && tenth(generator) < 5) {
      event.index = static_cast<std::uint32_t>(tenth(generator));
    }
    const bool known = std::any_of(events.begin(), events.end(), [&](const OwnedEvent& other) {
      return compare(other.view(), event.view()) == 0;
    });
    if (!known) events.push_back(event);
  }
  return events;
}

}  // namespace sampled_data_observers::test
