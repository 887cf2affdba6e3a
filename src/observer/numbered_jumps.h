#pragma once

#include <memory>

#include "observer/law_decorator.h"

namespace sampled_data_observers {

/// A law that takes a jump once, however often it is told of it: a jump with the number of the one
/// before takes no effect, whatever its stamp. Jumps that nobody counts all do.
class NumberedJumps : public LawDecorator {
 public:
  explicit NumberedJumps(std::shared_ptr<const ObserverLaw> law);

  void initialize(double* state) const override;
  void flow(Duration duration, double* state, double* workspace) const override;
  Effect reset(const Event& event, double* state, double* workspace) const override;

 private:
  NumberSlot last_ = state_layout().number();  ///< 0 where there was none
};

}  // namespace sampled_data_observers
