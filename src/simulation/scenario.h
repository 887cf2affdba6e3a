#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sampled_data_observers/config/navsat_config.h"
#include "sampled_data_observers/config/topic_config.h"
#include "sampled_data_observers/hybrid/time.h"
#include "sampled_data_observers/plant/plant.h"
#include "sampled_data_observers/plant/vector_map.h"
#include "simulation/delivery.h"
#include "simulation/jump_detection.h"
#include "simulation/schedule.h"

namespace sampled_data_observers {

/// What is added to the outputs of a sensor.
struct Noise {
  enum class Kind {
    kNone,
    kUniform,   ///< uniform in [-size, size)
    kGaussian,  ///< normal with standard deviation `size`
    kFormulas   ///< formulas of the time since the start
  };

  Kind kind = Kind::kNone;
  /// One per output, of kUniform and kGaussian.
  Eigen::VectorXd size;
  std::shared_ptr<const VectorMap> formulas;
};

/// Of each output; empty where it is not known.
inline Eigen::VectorXd variance_of(const Noise& noise) {
  if (noise.kind == Noise::Kind::kUniform) return noise.size.cwiseAbs2() / 3.0;
  return noise.kind == Noise::Kind::kGaussian ? Eigen::VectorXd(noise.size.cwiseAbs2())
                                              : Eigen::VectorXd();
}

/// A sensor of the plant in a scenario.
struct SensorScenario {
  /// Where observers read its measurements; empty where the jump events carry them.
  std::optional<TopicSource> source;
  /// Empty for a sensor that measures at jumps.
  std::optional<Schedule> schedule;
  Noise noise;
  Delivery delivery;
};

/// What another instrument of the robot tells of the plant, which is no sensor of an observer's
/// model: say a signal that jumps show in.
struct SignalScenario {
  std::string name;
  std::string topic;
  /// Of (t, x): one entry for each value.
  std::shared_ptr<const VectorMap> formulas;
  Schedule schedule;
  Noise noise;
  Delivery delivery;
};

/// The known input: evaluated at a fixed rate and held in between, for plant and observer alike.
struct InputScenario {
  /// One per channel of the plant's inputs.
  std::vector<TopicSource> sources;
  Duration period = 0;
  /// Of (t, x): p entries.
  std::shared_ptr<const VectorMap> formulas;
};

/// Where jumps that come ever faster (Zeno) end.
struct RestScenario {
  /// Of x: the state at rest, n entries.
  std::shared_ptr<const VectorMap> state;
  /// For each state: whether it stays there; the others flow on.
  std::vector<bool> held;
};

/// When the plant jumps: at a crossing of the guard or on a schedule.
struct JumpScenario {
  /// Of x: one entry. A jump where it goes from negative to positive or zero.
  std::shared_ptr<const VectorMap> guard;
  std::optional<Schedule> schedule;
  /// Labels of the modes that follow, one jump after the other, cyclic; empty for a plant of one
  /// mode.
  std::vector<int> modes;
  Duration min_separation = 0;
  /// What takes the place of a jump sooner than min_separation after the one before; empty: the
  /// simulation ends.
  std::optional<RestScenario> rest;
  DetectionFaults faults;
  Delivery delivery;
};

/// N w(t), added to the flow map.
struct Disturbance {
  Eigen::MatrixXd N;                          ///< n x q
  std::shared_ptr<const VectorMap> formulas;  ///< w, of t: q entries
};

/// A plant and all that happens to it in a simulation.
struct Scenario {
  std::shared_ptr<const Plant> plant;
  Stamp start = 0;
  Duration duration = 0;
  std::uint64_t seed = 0;
  Eigen::VectorXd initial_state;  ///< n
  /// Position in plant->modes().
  std::size_t initial_mode = 0;
  std::string truth_topic;
  Duration truth_period = 0;
  std::optional<InputScenario> input;
  std::optional<Disturbance> disturbance;
  /// One per sensor of the plant.
  std::vector<SensorScenario> sensors;
  std::vector<SignalScenario> signals;
  TopicSource jumps_source;
  /// Where the local plane of satellite navigation is.
  std::optional<NavSatDatum> navsat;
  /// Empty: the plant does not jump.
  std::optional<JumpScenario> jumps;
  /// What a person should know before it runs.
  std::vector<std::string> warnings;
};

}  // namespace sampled_data_observers
