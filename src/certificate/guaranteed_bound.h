#pragma once

#include <memory>
#include <vector>

#include "certificate/error_bound.h"
#include "observer/law_decorator.h"
#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// A law with a guaranteed bound on its error: an ErrorBound that the same events drive, so that
/// the bound is a function of the events as the estimate is.
///
/// The bound is lost, that is infinite, until the estimate begins anew:
/// - where the ErrorBound says so;
/// - where the timeline holds the estimate, since its flow is not finite, or a jump is without
///   effect, since its result is not;
/// - after an input or a jump that was rejected: an event of kind kRejected says so;
/// - after jumps that are missing, or were lost as the numbers of others tell, and where the times
///   between jumps leave those configured;
/// - where the estimate is taken to be at rest;
/// - at a jump whose angular outputs may be wrapped by another number of turns than the error, and
///   at such a sample where the law goes on injecting it; elsewhere such a sample moves the
///   estimate by what is known, and the bound with it. Which number of turns fits is known where
///   |C_i| times the bound, plus the noise, is less than 2π minus the innovation.
/// Of a switched plant, beginning anew does not help while it is open in which mode it is: see
/// StateBound::mode_is_open().
/// Samples that are refused were not taken. Of a jump that the law refuses, nobody knows whether
/// the plant has jumped: the bound is one for both. Wherever an estimate begins, whether configured
/// or given, the assumption on the initial error is taken to hold anew; where it goes on from that
/// of another law, what was known of that one's error (keep_bound()).
///
/// Where the stamps of jumps may be off by δ (ErrorBound::jump_stamp_error()), a bound is known but
/// not given within δ after each jump that is told, and after the start, since the plant may be yet
/// to jump; who knows of later events must not give it within δ before one, either. Where two jumps
/// are told within 2 δ, so that nobody knows which was first, or one of a plant with inputs, modes
/// or angles measured at jumps, it is lost.
///
/// Where jumps wait for their release (ErrorBound::takes_delays()), a jump is one to what waits,
/// and x̂ takes it at the release. A jump that is refused meanwhile loses the bound.
///
/// A share of 64 n ε of |x̂| is added for the rounding of the estimate, n the number of its states:
/// to the bound on the norm, to that on each state, and to the ellipsoid.
class GuaranteedBound : public LawDecorator, public StateBound {
 public:
  /// @param law    of that plant
  /// @param plant  without formulas in its angular outputs
  /// @param noise  |η| <= this at every measurement
  GuaranteedBound(const std::shared_ptr<const ObserverLaw>& law,
                  std::unique_ptr<const ErrorBound> bound, std::shared_ptr<const Plant> plant,
                  double noise);

  bool accepts(const Event& event) const override;
  void initialize(double* state) const override;
  void flow(Duration duration, double* state, double* workspace) const override;
  Effect reset(const Event& event, double* state, double* workspace) const override;
  double error_bound(const double* state) const override;
  BoundLoss bound_loss(const double* state) const override;
  void state_bounds(const double* state, double* workspace,
                    Eigen::Ref<Eigen::VectorXd> bounds) const override;
  void error_ellipsoid(const double* state, double* workspace,
                       Eigen::Ref<Eigen::MatrixXd> Q) const override;
  PublishedBound known_bound(const double* state) const override;
  void keep_bound(const PublishedBound& bound, double* state) const override;
  void known_ellipsoid(const double* state, double* workspace,
                       Eigen::Ref<Eigen::MatrixXd> Q) const override;
  void narrow_bound(const Eigen::Ref<const Eigen::MatrixXd>& Q, double* state) const override;
  void give_up(double* state) const override;
  bool mode_is_open(const double* state) const override;
  void leave_mode_open(double* state) const override;
  bool lets_jumps_coincide() const override { return bound_->lets_jumps_coincide(); }

 private:
  /// What is known at one time: why the bound is lost, if it is, and the state of the ErrorBound.
  struct Part {
    ChoiceSlot<BoundLoss> loss;
    VectorSlot bound;
  };

  double bound_of(const Part& part, const double* state) const;
  double rounding(const double* state) const;
  double with_rounding(double bound, const double* state) const;
  bool is_near_jump(const double* state) const;
  void settle(const Part& part, double* state) const;
  static void lose(const Part& part, BoundLoss reason, double* state);
  static void copy(const Part& from, const Part& to, double* state);
  void lose(BoundLoss reason, double* state) const;
  void give_up(double* state, BoundLoss reason) const;
  bool is_told_again(const Event& jump, Effect effect, const double* state) const;
  void go_on_from_then(double* state) const;
  void flow_part(double* state) const;
  void begin_interval(double* state) const;
  void look_at_law(double* state, double* workspace) const;
  double moved_since_before(const double* state) const;
  bool may_be_wrapped(double error, std::size_t sensor, const double* innovation) const;
  bool may_be_wrapped(const Event& event, double* state, double* workspace) const;
  void sample(std::size_t sensor, double* state, double* workspace, bool is_wrapped) const;
  void await_outputs(double* state) const;
  void take_jump(double* state) const;
  void refuse_jump(double* state) const;
  const double* next_estimate(const double* state) const;
  void note_awaited_speed(double* state, double* workspace) const;
  void release(double* state) const;
  void note_stamp_of_jump(const Event& jump, double* state, double* workspace) const;
  JumpMotion motion(double moved, const double* state) const;
  void go_on_from_moved(double* state) const;

  std::unique_ptr<const ErrorBound> bound_;
  std::shared_ptr<const Plant> plant_;
  double noise_;
  /// |C_i| of each angular output of each sensor, the largest of all modes; 0 of one that is none.
  std::vector<Eigen::VectorXd> angles_;
  bool jumps_are_measured_;
  Duration jump_stamp_error_;  ///< ns
  bool shift_is_bounded_;      ///< whether the bound knows what that does

  /// The last sample, jump or start, or message of an output that the bound takes as held.
  TimerSlot since_ = state_layout().timer();
  FlagSlot awaiting_ = state_layout().flag();  ///< the outputs of the last jump are still to come
  FlagSlot mode_is_open_ = state_layout().flag();
  FlagSlot is_numbered_ = state_layout().flag();  ///< the last jump that was told, taken or not
  NumberSlot moved_ = state_layout().number();    ///< by how much x̂ did at that jump
  NumberSlot speed_before_ = state_layout().number();   ///< |f(x̂)| at the last jump
  NumberSlot speed_after_ = state_layout().number();    ///< |f(g(x̂))| there
  NumberSlot awaited_speed_ = state_layout().number();  ///< |f(x̂⁺)| of a reset that waits
  TimerSlot since_start_ = state_layout().timer();
  TimerSlot since_jump_ = state_layout().timer(1e18);           ///< that was told, taken or not
  VectorSlot before_ = state_layout().vector(estimate_size());  ///< x̂ before the last of them
  /// The bound at the last of them (before a jump whose outputs are still to come), and the bound
  /// now, which is always computed from that one, however often the flow is interrupted.
  Part then_ = {state_layout().choice<BoundLoss>(), state_layout().vector(bound_->state_size())};
  Part now_ = {state_layout().choice<BoundLoss>(), state_layout().vector(bound_->state_size())};

  VectorSlot bound_workspace_ = scratch(bound_->workspace_size());
  VectorSlot innovation_ = scratch(max_event_size());
  VectorSlot jumped_ = scratch(estimate_size());
  VectorSlot speed_ = scratch(estimate_size());
};

}  // namespace sampled_data_observers
