#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sampled_data_observers/hybrid/time.h"
#include "sampled_data_observers/plant/sensor.h"
#include "sampled_data_observers/plant/vector_map.h"

/// Plants that flow, are measured now and then and may jump, and observers of them.
namespace sampled_data_observers {

/// How a flow that has no closed form is integrated: by fixed steps from each event on.
struct Integration {
  Duration step = kNanosecondsPerSecond / 1000;    ///< ns, > 0
  Duration horizon = 100 * kNanosecondsPerSecond;  ///< ns: longer flows without event are refused
};

/// The maps of a plant in one of its modes.
struct PlantMode {
  /// Number by which jump events name the mode.
  int label = 0;
  /// ẋ = f(x, u), n entries
  std::shared_ptr<const VectorMap> flow;
  /// x⁺ = g(x, u), n entries; null where the plant does not jump from this mode
  std::shared_ptr<const VectorMap> jump;
  /// y_i = h_i(x, u), one map per sensor
  std::vector<std::shared_ptr<const VectorMap>> outputs;
  /// Formulas in (x, u), any number of them but as many in each mode, that are all at most 0 where
  /// the plant can jump: D of bernard2022 (1); null in all modes where that is everywhere.
  std::shared_ptr<const VectorMap> jump_set = nullptr;
  /// The same where it flows: C.
  std::shared_ptr<const VectorMap> flow_set = nullptr;
};

/// Inputs whose values come together: those of one topic.
struct InputChannel {
  /// Unlike those of other sources of events.
  std::string name;
  /// Positions in u, in ascending order.
  std::vector<Eigen::Index> inputs;
  /// How long the inputs hold [ns]; 0: until the next ones, however late they come.
  Duration timeout = 0;
  /// What they are from then on, one value each; empty: they hold all the same.
  std::vector<double> after_timeout = {};

  /// Number of values.
  Eigen::Index size() const { return static_cast<Eigen::Index>(inputs.size()); }
};

/// What a plant that flows, is measured and may jump is made of. A switched plant has several
/// modes; it starts in the first, and its jump events say which one follows.
struct PlantDescription {
  std::vector<std::string> state_names;  ///< n
  std::vector<std::string> input_names;  ///< p
  /// As many as each mode has outputs.
  std::vector<Sensor> sensors;
  /// At least one, with different labels.
  std::vector<PlantMode> modes;
  /// For flows that are not affine.
  Integration integration;
  /// Each input in one of them, ordered by their first inputs. Empty: all come together, in a
  /// channel named "input".
  std::vector<InputChannel> input_channels = {};
  /// Groups of states whose Euclidean norm is 1, as that of the four of a quaternion, by their
  /// positions: at least two in each, none in two. With such groups no flow may be affine.
  std::vector<std::vector<Eigen::Index>> unit_norms = {};
};

/// A checked description. Immutable.
class Plant {
 public:
  /// @throws std::invalid_argument naming the part that does not fit.
  explicit Plant(PlantDescription description);

  // Its outputs point into its own description.
  Plant(const Plant&) = delete;
  Plant& operator=(const Plant&) = delete;

  /// n names, in the order of x.
  const std::vector<std::string>& state_names() const { return description_.state_names; }
  /// p names, in the order of u.
  const std::vector<std::string>& input_names() const { return description_.input_names; }
  /// Where inputs come from; none where the plant has no inputs.
  const std::vector<InputChannel>& input_channels() const { return description_.input_channels; }
  /// Their positions are the channels of what is measured.
  const std::vector<Sensor>& sensors() const { return description_.sensors; }
  /// The plant starts in the first.
  const std::vector<PlantMode>& modes() const { return description_.modes; }
  /// How flows that are not affine are integrated.
  const Integration& integration() const { return description_.integration; }

  /// Groups of states whose norm is 1.
  const std::vector<std::vector<Eigen::Index>>& unit_norms() const {
    return description_.unit_norms;
  }
  /// Divides each such group by its norm; the first of a group of zeros becomes 1, and one whose
  /// norm is not finite is left as it is. x has n entries.
  void normalize(double* x) const;

  /// n
  Eigen::Index states() const { return static_cast<Eigen::Index>(state_names().size()); }
  /// p
  Eigen::Index inputs() const { return static_cast<Eigen::Index>(input_names().size()); }

  /// Whether there are jump events: the plant switches, or has a jump map.
  bool jumps() const;
  /// Whether there are several modes, so that jump events carry one.
  bool switches() const { return modes().size() > 1; }

  /// Position in modes() of a label; nothing where no mode has it.
  std::optional<std::size_t> find_mode(double label) const;

  /// Whether flow, jump and output maps of all modes are affine.
  bool is_affine() const;

  /// A sensor's output map in one mode, as compute_innovation() needs it.
  struct Output {
    /// y = h(x, u)
    const VectorMap* map = nullptr;
    /// Number of outputs, m.
    Eigen::Index size = 0;
    /// n
    Eigen::Index states = 0;
    /// size x states, column-major, where the map is C x; else null.
    const double* C = nullptr;
    /// Null where no output is an angle.
    const std::vector<bool>* angular = nullptr;
  };
  /// @pre mode and sensor are positions in modes() and sensors()
  const Output& output(std::size_t mode, std::size_t sensor) const {
    return outputs_[mode * sensors().size() + sensor];
  }

  /// The largest m of a sensor, of whatever timing.
  Eigen::Index max_outputs() const;
  /// Number of outputs of all sensors of one timing together.
  Eigen::Index outputs(SensorTiming timing) const;

  /// Whether a sensor of the timing measures an angle.
  bool has_angles(SensorTiming timing) const;

  /// H (m x n): the affine outputs of all sensors of a timing in a mode, one below the other.
  Eigen::MatrixXd stacked_outputs(std::size_t mode, SensorTiming timing) const;

 private:
  PlantDescription description_;
  std::vector<Output> outputs_;
};

/// innovation ← y − h(x, u) of a sensor in a mode, angular outputs wrapped to (−π, π].
/// `y` and `innovation`: m entries each, not overlapping.
inline void compute_innovation(const Plant& plant, std::size_t mode, std::size_t sensor,
                               const double* y, const double* x, const double* u,
                               double* innovation) {
  const Plant::Output& output = plant.output(mode, sensor);
  if (output.C == nullptr) {
    output.map->evaluate(x, u, innovation);
    for (Eigen::Index i = 0; i < output.size; ++i) innovation[i] = y[i] - innovation[i];
  } else {
    // The common case, inline. Left to right, for the reason given at add_product().
    for (Eigen::Index i = 0; i < output.size; ++i) {
      const double* entry = output.C + i;
      double difference = y[i];
      for (Eigen::Index j = 0; j < output.states; ++j, entry += output.size) {
        difference -= *entry * x[j];
      }
      innovation[i] = difference;
    }
  }
  if (output.angular != nullptr) wrap_angles(*output.angular, innovation);
}

}  // namespace sampled_data_observers
