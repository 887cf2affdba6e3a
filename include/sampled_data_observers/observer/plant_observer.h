#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "sampled_data_observers/observer/observer_law.h"
#include "sampled_data_observers/plant/linear_flow.h"
#include "sampled_data_observers/plant/plant.h"
#include "sampled_data_observers/plant/runge_kutta_flow.h"

namespace sampled_data_observers {

/// What every law is built from beside its gains.
struct ObserverContext {
  /// Must not be null.
  std::shared_ptr<const Plant> plant;
  Eigen::VectorXd initial_estimate;  ///< n
  Eigen::VectorXd initial_input;     ///< p: the input before the first input event
};

/// What observers of a plant share. An observer type derives from it and says what it adds:
///
/// - derivative(): how its flowing state moves. By default x̂ follows the plant and the rest stands.
/// - sample(): what a sample does.
/// - jump(): what a jump of the plant does. By default x̂ jumps as the plant.
///
/// The flow is integrated exactly (LinearFlow) where flow_is_affine() says that derivative() is
/// affine in state, input and outputs held: the matrices are then read off derivative() itself.
/// Otherwise it is integrated by Runge–Kutta steps.
///
/// Outputs measured at jumps (y_d) come with the jump event, or as events of equal stamp: a
/// snapshot of the state before the jump lets the jump be applied again with them.
///
/// State: s | constants | time since jump, timers | mode | u | y_c | 1 | y_c known | snapshot of
/// all before u | mode after the jump | y_d | y_d known, where s = (x̂, extra) flows.
class PlantObserver : public ObserverLaw {
 public:
  /// The plant that is observed.
  const Plant& plant() const { return *plant_; }

  const std::vector<std::string>& estimate_names() const override { return plant_->state_names(); }
  Eigen::Index state_size() const override { return layout_.size; }
  Eigen::Index workspace_size() const override;
  Eigen::Index event_size(EventKind kind, int channel) const override;
  Eigen::Index max_event_size() const override;
  std::size_t sensors() const override { return plant_->sensors().size(); }
  void initialize(double* state) const override;
  void flow(Duration duration, double* state, double* workspace) const override;
  Duration flow_step() const override;
  Duration flow_horizon() const override;
  Effect reset(const Event& event, double* state, double* workspace) const override;
  bool knows_mode(const Event& event) const override;
  const double* held_part(const double* state) const override;
  void keep_held(const double* part, double* state) const override;
  double mode_of(const double* state) const override;
  void keep_mode(double mode, double* state) const override;
  void fit_to(const Event& sample, double* state, double* workspace) const override;
  void start_from(const double* estimate, double* state) const override;
  void innovation(const Event& sample, const double* state, double* innovation) const override;

  /// Number of entries of s, the part of a state that flows: its beginning.
  Eigen::Index flow_size() const { return layout_.constants; }
  /// ds ← ṡ at a state, flow_size() entries.
  void flow_derivative(const double* state, double* ds, double* workspace) const {
    derivative(held(state), state, ds, workspace);
  }

 protected:
  /// What a law keeps beside x̂.
  struct Extras {
    Eigen::Index flowing = 0;    ///< more states that flow
    Eigen::Index constants = 0;  ///< numbers that the flow leaves alone
    Eigen::Index timers = 0;     ///< each the time since the law set it to zero [ns]
    Eigen::Index workspace = 0;  ///< scratch for the law's maps
  };

  /// What holds during a flow or at an event.
  struct Held {
    std::size_t mode = 0;  ///< position in plant().modes()
    /// p entries
    const double* u = nullptr;
    /// The continuous outputs, sensor after sensor; null before each of them came once, anew
    /// after each jump.
    const double* y_c = nullptr;
  };

  /// The outputs at a jump: those of sensor i begin at y_d + jump_output_offset(i), where known[i].
  struct JumpOutputs {
    /// Of all sensors that measure at jumps.
    const double* y_d = nullptr;
    const double* known = nullptr;  ///< one entry per sensor: 1 or 0
  };

  /// @throws std::invalid_argument for sizes that do not fit the plant, and where a sensor has a
  /// timing that is not in `timings`.
  PlantObserver(ObserverContext context, const Extras& extras,
                const std::vector<SensorTiming>& timings);

  /// To be called at the end of every constructor that makes an observer: builds its flow.
  void build_flow();

  /// Whether derivative() is affine in s, u and y_c.
  virtual bool flow_is_affine() const { return plant_->is_affine(); }

  /// ds ← ṡ
  virtual void derivative(const Held& held, const double* s, double* ds, double* workspace) const;

  /// Reset map of a sample y of a sensor that is sampled. By default nothing, for laws that take no
  /// such sensor.
  virtual void sample(std::size_t sensor, const double* y, const Held& held, double* state,
                      double* workspace) const;

  /// Reset map of a jump into mode `next` from held.mode; the time since the jump before it is
  /// still since_jump().
  virtual void jump(const Held& held, std::size_t next, const JumpOutputs& outputs, double* state,
                    double* workspace) const;

  /// Moves the law's constants over a flow; s was not moved yet.
  virtual void flow_constants(Duration duration, const Held& held, double* state,
                              double* workspace) const;

  /// Brings what depends on the rest of the state up to date, after every flow and reset.
  virtual void complete(const Held& held, double* state, double* workspace) const;

  /// x̂ ← g(x̂) of the mode that held before; x̂ stays where that has no jump map.
  void apply_plant_jump(const Held& held, double* state, double* workspace) const;

  /// Number of states of the plant, and of x̂.
  Eigen::Index n() const { return plant_->states(); }
  /// As flow_size(): n() and Extras::flowing.
  Eigen::Index flowing_size() const { return layout_.constants; }
  /// The law's constants, Extras::constants entries.
  double* constants(double* state) const { return state + layout_.constants; }
  /// The law's constants, Extras::constants entries.
  const double* constants(const double* state) const { return state + layout_.constants; }
  /// The law's timers [ns].
  double* timers(double* state) const { return state + layout_.timers + 1; }
  /// Time since the last jump, or the start [ns].
  double since_jump(const double* state) const { return state[layout_.timers]; }
  /// What a state holds; its pointers point into the state.
  Held held(const double* state) const;

  /// Where the outputs of a sensor begin in Held::y_c.
  Eigen::Index continuous_offset(std::size_t sensor) const { return offsets_[sensor]; }
  /// Where the outputs of a sensor begin in JumpOutputs::y_d.
  Eigen::Index jump_output_offset(std::size_t sensor) const { return offsets_[sensor]; }

 private:
  struct Layout {
    Eigen::Index constants = 0;
    Eigen::Index timers = 0;
    Eigen::Index mode = 0;
    Eigen::Index input = 0;
    Eigen::Index outputs = 0;
    Eigen::Index one = 0;
    Eigen::Index outputs_known = 0;
    Eigen::Index snapshot = 0;
    Eigen::Index snapshot_next = 0;
    Eigen::Index jump_outputs = 0;
    Eigen::Index jump_outputs_known = 0;
    Eigen::Index size = 0;
  };

  class Field;

  bool has_jump_outputs() const { return layout_.jump_outputs < layout_.jump_outputs_known; }
  Eigen::Index mode_values() const { return plant_->switches() ? 1 : 0; }
  void begin_jump(const Event& event, double* state, double* workspace) const;
  void apply_jump(std::size_t next, double* state, double* workspace) const;
  void pair_with_jump(const Event& output, double* state, double* workspace) const;
  std::size_t regime(const Held& held) const;
  LinearFlow exact_flow(const Held& held) const;
  Eigen::MatrixXd least_correction(std::size_t mode, std::size_t sensor) const;

  std::shared_ptr<const Plant> plant_;
  Eigen::VectorXd initial_estimate_;
  Eigen::VectorXd initial_input_;
  Eigen::Index timer_count_;
  Eigen::Index law_workspace_;
  Layout layout_;
  /// Of each sensor's outputs among those of its timing.
  std::vector<Eigen::Index> offsets_;
  /// For each mode and each sensor, what makes of an innovation the least change of x̂ that removes
  /// it; empty where the output is not affine.
  std::vector<std::vector<Eigen::MatrixXd>> least_corrections_;
  /// One flow for each regime(), or one numeric flow for all.
  std::vector<LinearFlow> exact_flows_;
  std::unique_ptr<RungeKuttaFlow> numeric_flow_;
};

}  // namespace sampled_data_observers
