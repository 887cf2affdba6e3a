#pragma once

#include <memory>

#include "observer/law_decorator.h"

namespace sampled_data_observers {

/// A law that learns of jumps late and does not rewind (bernard2022 (41)): at the stamp of a jump
/// the reset G(z, y_d) is computed and kept as μ, while z flows on; when the release comes, at the
/// time at which the jump was known, z⁺ = μ. The time of the release is an event of its own, so
/// that the estimate stays a function of events.
///
/// What is held (inputs, continuous outputs) stays as it is at the release. What samples changed
/// between a jump and its release is lost, as it is in (41). Jumps must lie further apart than
/// their delays: a jump that comes while another is pending applies that one first. An estimate
/// that begins anew while a jump is pending is one of the plant as it is then, which has jumped: it
/// is in the mode that follows, and nothing is left to be released.
class DelayedJumps : public LawDecorator {
 public:
  explicit DelayedJumps(const std::shared_ptr<const ObserverLaw>& law);

  bool accepts(const Event& event) const override;
  void initialize(double* state) const override;
  void flow(Duration duration, double* state, double* workspace) const override;
  Effect reset(const Event& event, double* state, double* workspace) const override;
  const double* awaited(const double* state) const override {
    return pending_.of(state) ? mu_.of(state) : nullptr;
  }

 private:
  bool is_of_pending(const Event& release, const double* state) const;
  void release(double* state) const;

  FlagSlot pending_ = state_layout().flag();
  TimerSlot since_jump_ = state_layout().timer();
  NumberSlot index_ = state_layout().number();
  NumberSlot mode_ = state_layout().number();  ///< label of the one that follows; 0 without modes
  VectorSlot mu_ = state_layout().vector(law().state_size());
};

}  // namespace sampled_data_observers
