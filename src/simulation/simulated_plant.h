#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "simulation/scenario.h"

namespace sampled_data_observers {

/// The plant of a scenario with its true state, under a held input.
///
/// It flows exactly where its flow map is affine and undisturbed, else by Runge–Kutta steps. Jumps
/// at crossings of the guard happen where linear interpolation within one nanosecond puts them, and
/// are stamped with the first whole nanosecond from there on; the state at that stamp is the one
/// after the jump, flowed on for the fraction of the nanosecond that is left. So no error of
/// rounding times adds up from jump to jump. At rest, states that are held have derivative zero.
class SimulatedPlant {
 public:
  explicit SimulatedPlant(const Scenario& scenario);
  ~SimulatedPlant();

  /// Time since the start [ns].
  Duration time() const { return time_; }
  /// The state, n entries; at a crossing: the one just before the jump.
  const Eigen::VectorXd& state() const { return crossing_ ? before_ : x_; }
  /// The held input, p entries.
  const Eigen::VectorXd& input() const { return u_; }
  /// Position of the mode in plant().modes().
  std::size_t mode() const { return mode_; }
  /// Whether state and guard have values.
  bool is_finite() const;

  void set_input(const Eigen::VectorXd& u) { u_ = u; }

  /// Flows to `target`, or to the first jump that the guard triggers before; returns whether it
  /// did. It must then be followed by jump().
  bool flow_to(Duration target);

  /// Jumps into the mode at this position.
  void jump(std::size_t next_mode);

  /// In the place of a jump: goes on at rest, without jumps.
  /// @pre the scenario's jumps have such a state
  void rest();

  /// out ← the outputs of a sensor.
  void measure(std::size_t sensor, double* out) const;

 private:
  class Flow;
  class ExactFlow;
  class NumericFlow;

  /// @param held  for each state, or empty: none
  void make_flow(const std::vector<bool>& held);
  void flow(Duration duration, Eigen::VectorXd& x) const;
  bool watches_guard() const;
  double guard(const Eigen::VectorXd& x) const;
  void locate(Duration step);
  /// After a jump at a crossing: goes on from there to the stamp.
  void flow_to_stamp();
  void rearm();

  const Scenario& scenario_;
  std::unique_ptr<Flow> flow_;
  Eigen::VectorXd x_;
  Eigen::VectorXd u_;
  std::size_t mode_;
  Duration time_ = 0;
  bool is_at_rest_ = false;

  /// Whether the guard was negative since the last jump, so that it can trigger another.
  bool armed_ = false;
  double last_guard_ = 0.0;
  /// The guard is looked at after steps that double from 1 ns on after each jump, up to the
  /// integration step: between two jumps that lie close together, too, it must be seen negative.
  Duration probe_ = 1;
  /// At a crossing: the state just before the jump, and the time from it to the stamp [ns].
  bool crossing_ = false;
  Eigen::VectorXd before_;
  double remainder_ = 0.0;
};

}  // namespace sampled_data_observers
