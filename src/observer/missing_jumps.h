#pragma once

#include <cstdint>
#include <memory>

#include "observer/law_decorator.h"
#include "observer/state_set.h"
#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// When a jump is missing, and what to do then.
struct MissingJumps {
  enum class Action : std::uint8_t {
    kReport,  ///< count it
    kPredict  ///< count it, and make it up at the time at which the estimate left the flow set
  };

  /// The flow set C of bernard2022 (1), with margins: an estimate beyond them must have jumped.
  StateSet flow_set;
  Action action = Action::kReport;
  /// Between looks at the estimate, from each event on [ns], > 0.
  Duration step = 0;
};

/// A law that notices where its estimate leaves the set in which the plant flows, by more than a
/// margin, without any event of a jump.
///
/// With Action::kPredict the estimate has a double from the time on at which it leaves the set
/// itself: one that jumped then. Both take all events. When the event of a jump comes, the double
/// goes; when the estimate is beyond the margin, the double takes its place. Where estimates may
/// come to rest (RestingEstimate), the double jumps on, once a step, until it does; nothing is
/// missing while the estimate is at rest. What is seen depends
/// on the events alone, however flows are divided. No gate or limit of jumps may be within: they
/// are about jumps that are told.
///
/// An estimate that is wrong leaves the set at wrong times. So nothing is missing, nor made up,
/// from a jump that has effect on while the estimate is not within the margin of the set's edge,
/// inside or outside, until one has while it is.
class MissingJumpsWatch : public LawDecorator, private JumpWatch {
 public:
  /// @throws std::invalid_argument for a step or margins out of range, and for kPredict where jumps
  /// are delayed or the plant switches: nobody knows into which mode.
  MissingJumpsWatch(const std::shared_ptr<const ObserverLaw>& law, MissingJumps options);

  void initialize(double* state) const override;
  void flow(Duration duration, double* state, double* workspace) const override;
  Effect reset(const Event& event, double* state, double* workspace) const override;

 private:
  double missing_jumps(const double* state) const override { return missing_.of(state); }

  void flow_step_of(Duration duration, double* state, double* workspace) const;
  void flow_double(Duration duration, double* state, double* workspace) const;
  bool leaves_further(const double* state, double* workspace) const;
  bool jump_where_it_left(Duration duration, double* jumped, double* workspace) const;
  Duration time_of_leaving(Duration duration, double* trial, double* workspace) const;
  void forget_where_held(double* state) const;
  bool is_inside(const double* state, double* workspace) const;
  bool is_within_margin(const double* state, double* workspace) const;
  bool is_near_edge(const double* state, double* workspace) const;

  MissingJumps options_;
  StateSet flow_set_;   ///< without margins
  StateSet inner_set_;  ///< with negative ones

  VectorSlot double_ = state_layout().vector(law().state_size());
  FlagSlot has_double_ = state_layout().flag();
  /// Since the double was made, as time goes and as the double flowed: where they differ, flows
  /// were held meanwhile.
  TimerSlot since_double_ = state_layout().timer();
  NumberSlot flowed_ = state_layout().number();
  NumberSlot double_jumps_ = state_layout().number();  ///< that it made
  FlagSlot is_noticed_ = state_layout().flag();
  FlagSlot is_doubted_ = state_layout().flag();
  NumberSlot missing_ = state_layout().number();

  VectorSlot before_ = scratch(law().state_size());
  VectorSlot values_ = scratch(flow_set_.margins.size());
};

}  // namespace sampled_data_observers
