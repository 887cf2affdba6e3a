#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sampled_data_observers/observer/law_gains.h"
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
/// What it keeps beside x̂ it declares where its members are: flowing(), constants(), timer(), and
/// scratch() for what its maps need while they run.
///
/// The flow is integrated exactly (LinearFlow) where flow_is_affine() says that derivative() is
/// affine in state, input and outputs held: the matrices are then read off derivative() itself.
/// Otherwise it is integrated by Runge–Kutta steps.
///
/// Outputs measured at jumps (y_d) come with the jump event, or as events of equal stamp: a
/// snapshot of the state before the jump lets the jump be applied again with them. Where what is
/// measured at a jump, or was last measured before it, gives no finite correction, the jump is
/// applied without: the plant has jumped all the same.
class PlantObserver : public ObserverLaw {
 public:
  /// The plant that is observed.
  const Plant& plant() const { return *plant_; }

  /// What it computes with beside its plant. By default nothing, so that no certificate can be
  /// about it.
  virtual LawGains gains() const { return {}; }

  bool accepts(const Event& event) const override;
  void initialize(double* state) const override;
  void flow(Duration duration, double* state, double* workspace) const override;
  Effect reset(const Event& event, double* state, double* workspace) const override;

  /// Number of values that events of the kind, and sensor or channel of inputs, carry; -1 where
  /// there are no such. Jumps may come with the outputs measured at them, all or none.
  Eigen::Index event_size(EventKind kind, std::size_t sensor = 0) const;

  /// Whether the plant has the mode that a jump event names. @pre accepts(event)
  bool knows_mode(const Event& event) const;

  /// Whether the inputs of some channel are older than their timeout, in a state; those that never
  /// came, older than the estimate.
  bool is_input_stale(const double* state) const;

  /// What is held in a state: the input, and behind it the continuous outputs. For observers of one
  /// plant it has one form.
  const double* held_part(const double* state) const { return held_part_.of(state); }

  /// The norm of the innovation y_c − h(x̂, u) of the continuous outputs that are held, angles
  /// wrapped; nothing where not all of them are, or the plant has none.
  std::optional<double> innovation_of_held(const double* state, double* workspace) const;

  /// Takes over what is held, as held_part() of an observer of the same plant gives it.
  void keep_held(const double* part, double* state) const { held_part_.set(part, state); }

  /// The mode that holds in a state, as its position among the plant's.
  std::size_t mode_of(const double* state) const { return mode_.of(state); }

  /// Takes over a mode, as mode_of() of an observer of the same plant gives it, without a jump. An
  /// observer that keeps its estimate in coordinates of the mode brings them up to date.
  virtual void keep_mode(std::size_t mode, double* state) const;

  /// Moves the estimate of an initialized state the least (in the norm |·|) so that it fits a
  /// sample of a sensor whose output is affine in the state; leaves it where it is for other
  /// outputs.
  void fit_to(const Event& sample, double* state, double* workspace) const;

  /// Sets the estimate (estimate_size() entries, which may be the state's own) of an initialized
  /// state.
  virtual void start_from(const double* estimate, double* state) const;

  /// The covariance of the estimate in a state, a symmetric matrix of estimate_size() rows; null
  /// where the observer has none.
  virtual const double* covariance(const double* state) const;

  /// The innovation y − h(x̂, u) of what a sensor measured, angles wrapped: event.size entries. For
  /// an output measured at a jump the state is that before the jump.
  void innovation(const Event& measured, const double* state, double* innovation) const;

  /// The Mahalanobis distance √(νᵀ S⁻¹ ν) of the innovation ν, whose covariance is S, of what a
  /// sensor measured; NaN where the observer has no covariance.
  virtual double mahalanobis_distance(const Event& measured, const double* state,
                                      double* workspace) const;

  /// Whether a state of the estimate stands at a bound that the observer keeps it within.
  virtual bool is_saturated(const double* state) const;

  /// Number of entries of s, the part of a state that flows: its beginning.
  Eigen::Index flow_size() const { return s_.size(); }
  /// ds ← ṡ at a state, flow_size() entries.
  void flow_derivative(const double* state, double* ds, double* workspace) const {
    derivative(held(state), state, ds, workspace);
  }

 protected:
  /// What holds during a flow or at an event.
  struct Held {
    std::size_t mode = 0;  ///< position in plant().modes()
    /// p entries
    const double* u = nullptr;
    /// The continuous outputs, sensor after sensor; null before each of them came once, anew
    /// after each jump.
    const double* y_c = nullptr;
  };

  /// The outputs at a jump.
  class JumpOutputs {
   public:
    /// None.
    JumpOutputs() = default;
    /// Those that a state of the law holds.
    JumpOutputs(const PlantObserver& law, const double* state) : law_(&law), state_(state) {}

    /// y_d of a sensor that measures at jumps; null where it is not known.
    const double* of(std::size_t sensor) const {
      if (law_ == nullptr || !law_->y_d_known_[sensor].of(state_)) return nullptr;
      return law_->y_d_.of(state_) + law_->output_offset(sensor);
    }

   private:
    const PlantObserver* law_ = nullptr;
    const double* state_ = nullptr;
  };

  /// @param context  the plant, and where the estimate begins
  /// @param timings  those that the observer takes
  /// @param flowing  number of states that flow beside x̂
  /// @throws std::invalid_argument for sizes that do not fit the plant, and where a sensor has a
  /// timing that is not in `timings`.
  PlantObserver(ObserverContext context, const std::vector<SensorTiming>& timings,
                Eigen::Index flowing = 0);

  /// The next so many of the states that flow beside x̂. As all that an observer keeps in its state,
  /// they are zero at first, and are to be declared before build_flow().
  VectorSlot flowing(Eigen::Index entries);

  /// Numbers in the state that the flow leaves alone.
  VectorSlot constants(Eigen::Index entries);

  /// The time since the observer restarted it last [ns].
  TimerSlot timer();

  /// To be called for sensors whose samples come with the covariance of their noise: it follows the
  /// values, as in Event::covariance.
  void take_covariance_with(std::size_t sensor);

  /// To be called at the end of every constructor that makes an observer: builds its flow. The
  /// state has its form then.
  void build_flow();

  /// Whether derivative() is affine in s, u and y_c.
  virtual bool flow_is_affine() const { return plant_->is_affine(); }

  /// ds ← ṡ
  virtual void derivative(const Held& held, const double* s, double* ds, double* workspace) const;

  /// Brings s, after a step of an integrated flow, back to where it may be. By default it may be
  /// anywhere.
  virtual void confine(double* s) const;

  /// Reset map of a sample y of a sensor that is sampled. By default nothing, for observers that
  /// take no such sensor.
  virtual void sample(std::size_t sensor, const double* y, const Held& held, double* state,
                      double* workspace) const;

  /// Reset map of a jump into mode `next` from held.mode; the time since the jump before it is
  /// still since_jump().
  virtual void jump(const Held& held, std::size_t next, const JumpOutputs& outputs, double* state,
                    double* workspace) const;

  /// Moves the observer's constants over a flow; s was not moved yet.
  virtual void flow_constants(Duration duration, const Held& held, double* state,
                              double* workspace) const;

  /// Moves them with a step of an integrated flow, of s from `before` to `after`, which it may
  /// correct; that in `state` is still where the flow began. By default they stand.
  virtual void step_constants(Duration duration, const Held& held, const double* before,
                              double* after, double* state, double* workspace) const;

  /// Brings what depends on the rest of the state up to date, after every flow and reset.
  virtual void complete(const Held& held, double* state, double* workspace) const;

  /// x̂ ← g(x̂) of the mode that held before; x̂ stays where that has no jump map.
  void apply_plant_jump(const Held& held, double* state, double* workspace) const;

  /// dx ← dx + Σ L_i (y_c,i − h_i(x)) over the continuous sensors; nothing where y_c is not known.
  void add_innovations(const std::vector<Eigen::MatrixXd>& L, const Held& held, const double* x,
                       double* dx, double* workspace) const;

  /// dx ← dx + Σ L_i (y_d,i − h_i(x)) over the sensors whose output at the jump is known.
  void add_innovations(const std::vector<Eigen::MatrixXd>& L, const Held& held,
                       const JumpOutputs& outputs, const double* x, double* dx,
                       double* workspace) const;

  /// Number of states of the plant, and of x̂.
  Eigen::Index n() const { return plant_->states(); }
  /// Time since the last jump, or the start [ns].
  double since_jump(const double* state) const { return since_jump_.of(state); }
  /// What a state holds; its pointers point into the state.
  Held held(const double* state) const;

  /// The sensors of a timing, by their numbers.
  const std::vector<std::size_t>& sensors_of(SensorTiming timing) const {
    return sensors_of_[static_cast<std::size_t>(timing)];
  }
  /// Where the outputs of a sensor begin among those of its timing.
  Eigen::Index output_offset(std::size_t sensor) const { return offsets_[sensor]; }

 private:
  class Field;

  void take_input(const Event& event, double* state) const;
  void expire_inputs(double* state) const;
  Duration until_timeout(const double* state) const;
  void flow_part(Duration duration, double* state, double* workspace) const;
  Effect begin_jump(const Event& event, double* state, double* workspace) const;
  Effect apply_jump(std::size_t next, double* state, double* workspace) const;
  Effect pair_with_jump(const Event& output, double* state, double* workspace) const;
  bool is_usable_after_jump(const double* state) const;
  bool is_built() const { return numeric_flow_ != nullptr || !exact_flows_.empty(); }
  bool takes_jump_outputs() const { return y_d_.size() > 0; }
  std::size_t regime(const Held& held) const;
  LinearFlow exact_flow(const Held& held) const;

  std::shared_ptr<const Plant> plant_;
  Eigen::VectorXd initial_estimate_;
  Eigen::VectorXd initial_input_;
  std::array<std::vector<std::size_t>, 3> sensors_of_;
  std::vector<Eigen::Index> offsets_;
  /// Of each sensor: how many numbers of a covariance follow the values of its samples.
  std::vector<Eigen::Index> covariance_sizes_;
  /// For each mode and each sensor, what makes of an innovation the least change of x̂ that removes
  /// it; empty where the output is not affine.
  std::vector<std::vector<Eigen::MatrixXd>> least_corrections_;

  // The state: what flows, what is held, and what a jump takes with it otherwise: the mode, and
  // what the observer keeps beside.
  VectorSlot s_;
  Eigen::Index flowing_ = 0;  ///< handed out by flowing(), x̂ first
  VectorSlot inputs_;         ///< of the flow: (u, y_c)
  VectorSlot u_;
  VectorSlot y_c_;
  FlagsSlot y_c_known_;
  /// The age of the inputs of a channel that have a timeout.
  struct InputAge {
    std::size_t channel = 0;
    TimerSlot timer;  ///< up to the timeout
  };
  std::vector<InputAge> input_ages_;
  VectorSlot held_part_;  ///< inputs_, y_c_known_ and input_ages_
  ModeSlot mode_;
  TimerSlot since_jump_;

  // Where outputs are measured at jumps: those of the last jump, the mode after it, and a snapshot
  // of the state before it.
  VectorSlot y_d_;
  FlagsSlot y_d_known_;
  FlagSlot has_jumped_;
  ModeSlot mode_after_jump_;
  VectorSlot kept_;  ///< of the state: all that the snapshot has beside s
  VectorSlot s_before_jump_;
  VectorSlot kept_before_jump_;

  VectorSlot s_attempted_;  ///< before a jump whose correction may not be finite, with the next
  VectorSlot kept_attempted_;
  VectorSlot flowed_;
  VectorSlot jumped_;
  VectorSlot innovation_;

  /// One flow for each regime(), or one numeric flow for all.
  std::vector<LinearFlow> exact_flows_;
  std::unique_ptr<RungeKuttaFlow> numeric_flow_;
};

}  // namespace sampled_data_observers
