#pragma once

#include <random>
#include <string>
#include <vector>

#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/observer/plant_observer.h"
#include "support/random_events.h"

namespace sampled_data_observers::test {

/// The configurations in test/types: every observer type, with its variants, on small plants with
/// all channels that the type can take.
inline std::vector<std::string> type_examples() {
  return {"constant_gain",
          "constant_gain_delayed",
          "constant_gain_nonlinear",
          "high_gain_linear",
          "high_gain_original",
          "high_gain_transformed",
          "hybrid_kalman_filter",
          "hybrid_kalman_filter_switched",
          "intersample_injection",
          "intersample_injection_lipschitz",
          "sample_and_hold",
          "switched",
          "switched_projection_delayed",
          "synchronized",
          "synchronized_nonlinear_delayed",
          "time_varying_gain",
          "time_varying_gain_inverse"};
}

inline ObserverConfig read_example(const std::string& name) {
  return read_observer_config(
      std::vector<std::string>{std::string(SDO_SOURCE_DIR) + "/test/types/" + name + ".yaml"},
      no_plant_plugins);
}

/// `size` events of all channels of a law in [start, start + span], some with equal stamps, no two
/// equal. Modes are 1 and 2.
inline std::vector<OwnedEvent> random_events_for(const ObserverLaw& law, std::mt19937_64& generator,
                                                 std::size_t size, Stamp start, Duration span) {
  struct Channel {
    EventKind kind;
    int channel;
    Eigen::Index size;
  };
  std::vector<Channel> channels;
  for (const EventKind kind : {EventKind::kInput, EventKind::kOutput, EventKind::kJump,
                               EventKind::kJumpOutput, EventKind::kSample}) {
    for (int channel = 0; channel < 4; ++channel) {
      const Eigen::Index values = law.event_size(kind, channel);
      if (values >= 0) channels.push_back({kind, channel, values});
    }
  }
  std::uniform_int_distribution<Stamp> stamp(start, start + span);
  std::uniform_int_distribution<std::size_t> choice(0, channels.size() - 1);
  std::uniform_int_distribution<int> tenth(0, 9);
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  std::vector<OwnedEvent> events;
  while (events.size() < size) {
    const Channel& channel = channels[choice(generator)];
    OwnedEvent event;
    event.stamp = stamp(generator);
    if (!events.empty() && tenth(generator) < 3) event.stamp = events.back().stamp;
    event.kind = channel.kind;
    event.channel = channel.channel;
    for (Eigen::Index i = 0; i < channel.size; ++i) event.values.push_back(value(generator));
    if (event.kind == EventKind::kJump && !law.observer().knows_mode(event.view())) {
      event.values[0] = tenth(generator) < 5 ? 1.0 : 2.0;
    }
    const bool known = std::any_of(events.begin(), events.end(), [&](const OwnedEvent& other) {
      return compare(other.view(), event.view()) == 0;
    });
    if (!known) events.push_back(event);
  }
  return events;
}

}  // namespace sampled_data_observers::test
