#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// A number, a vector or a matrix that a law computes with.
struct LawGain {
  /// Its symbol, which is its key below `gains`, and, where there may be several, whose it is:
  /// "ell", "L/gps" of a sensor, "L_d/2/gps" of a sensor in the mode with the label 2.
  std::string name;
  /// A number is 1 x 1. Without entries where it is a formula, and not a matrix of numbers.
  Eigen::MatrixXd value;
};

/// A state that the flow map takes from a continuous output instead of from the estimate.
struct OutputInjection {
  /// Position among the states of the plant.
  Eigen::Index state = 0;
  /// A sensor that measures continuously and has one output.
  std::size_t sensor = 0;
};

/// All that makes an observer of the copy of a plant, as its law computes with it: what
/// certificates, error bounds and analysis are about.
struct LawGains {
  /// Each symbol of each sensor and mode once.
  std::vector<LawGain> all;
  /// At most one per state.
  std::vector<OutputInjection> output_injections;
  /// |θ| of what is injected before the first sample, units of the outputs.
  double initial_injection = 0.0;

  /// Adds a matrix; one without entries stands for a formula.
  LawGains& add(const std::string& name, const Eigen::MatrixXd& value);
  /// Adds a number.
  LawGains& add(const std::string& name, double value);
  /// Those of all sensors of a timing, out of one per sensor, as `symbol`/sensor.
  LawGains& add(const std::string& symbol, const std::vector<Eigen::MatrixXd>& per_sensor,
                const Plant& plant, SensorTiming timing);

  /// The only one of a symbol, which may name a mode: that called `symbol`, or `symbol`/sensor.
  /// Null where there is none or more than one.
  const LawGain* find(const std::string& symbol) const;
};

/// Whether the gain `name` is that called `symbol`, or one of those that it stands for.
bool is_named(const std::string& name, const std::string& symbol);

}  // namespace sampled_data_observers
