#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "observer/constant_gain_observer.h"
#include "plant/linear_plant.h"
#include "sampled_data_observers/hybrid/event.h"

namespace sampled_data_observers::test {

/// Events that own their values.
struct OwnedEvent {
  Stamp stamp = 0;
  EventKind kind = EventKind::kSample;
  int sensor = 0;
  std::vector<double> values;
  std::optional<double> mode = std::nullopt;
  std::uint32_t index = 0;

  Event view() const {
    return {stamp, kind, sensor, values.data(), static_cast<Eigen::Index>(values.size()),
            0,     mode, index};
  }
};

/// A plant with everything that events can touch: inputs, two sensors (one with an angle), jumps.
inline std::shared_ptr<const Plant> example_plant() {
  LinearPlantDescription plant;
  plant.state_names = {"p", "v", "yaw"};
  plant.input_names = {"u", "w"};
  plant.A.resize(3, 3);
  plant.A << 0.0, 1.0, 0.0, -3.0, -0.2, 0.1, 0.0, 0.3, 0.0;
  plant.B.resize(3, 2);
  plant.B << 0.0, 0.0, 1.0, 0.0, 0.0, 1.0;
  Eigen::MatrixXd C_position(1, 3);
  C_position << 1.0, 0.0, 0.0;
  Eigen::MatrixXd C_pose(2, 3);
  C_pose << 1.0, 0.5, 0.0, 0.0, 0.0, 1.0;
  plant.sensors = {{"position", C_position, {false}}, {"pose", C_pose, {false, true}}};
  Eigen::MatrixXd A_d = Eigen::MatrixXd::Identity(3, 3);
  A_d(1, 1) = -0.8;
  plant.jump_map = AffineJumpMap{A_d, Eigen::Vector3d(0.0, 0.1, 0.0)};
  return make_linear_plant(plant);
}

/// Of a law of it.
inline std::vector<Eigen::MatrixXd> example_gains() {
  std::vector<Eigen::MatrixXd> L(2);
  L[0].resize(3, 1);
  L[0] << 0.6, 0.4, 0.05;
  L[1].resize(3, 2);
  L[1] << 0.3, 0.0, 0.2, 0.1, 0.0, 0.7;
  return L;
}

/// A law of it.
inline std::shared_ptr<const ConstantGainObserver> example_law() {
  return std::make_shared<const ConstantGainObserver>(
      ObserverContext{example_plant(), Eigen::Vector3d(0.3, -0.2, 3.0), Eigen::Vector2d(0.1, 0.0)},
      example_gains());
}

/// `size` events for example_law() in [start, start + span], some with equal stamps, no two equal.
inline std::vector<OwnedEvent> random_events(std::mt19937_64& generator, std::size_t size,
                                             Stamp start, Duration span) {
  std::uniform_int_distribution<Stamp> stamp(start, start + span);
  std::uniform_int_distribution<int> kind(0, 9);
  std::uniform_real_distribution<double> value(-4.0, 4.0);
  std::vector<OwnedEvent> events;
  while (events.size() < size) {
    OwnedEvent event;
    event.stamp = stamp(generator);
    if (!events.empty() && kind(generator) < 3) event.stamp = events.back().stamp;
    const int choice = kind(generator);
    std::size_t values = 1;
    if (choice < 2) {
      event.kind = EventKind::kInput;
      values = 2;
    } else if (choice < 3) {
      event.kind = EventKind::kJump;
      values = 0;
    } else if (choice < 6) {
      event.sensor = 1;
      values = 2;
    }
    for (std::size_t i = 0; i < values; ++i) event.values.push_back(value(generator));
    const bool known = std::any_of(events.begin(), events.end(), [&](const OwnedEvent& other) {
      return compare(other.view(), event.view()) == 0;
    });
    if (!known) events.push_back(event);
  }
  return events;
}

}  // namespace sampled_data_observers::test
