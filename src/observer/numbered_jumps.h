#pragma once

#include <cstdint>
#include <memory>

#include "observer/law_decorator.h"

namespace sampled_data_observers {

/// A law that takes a jump once, however often it is told of it: a jump with the number of the one
/// before takes no effect, whatever its stamp. Jumps that nobody counts all do.
///
/// Numbers that were left out are jumps that were lost (skipped_jumps()), until one of them comes
/// behind: it was only stamped too late. Where the estimate begins, any number may come. Another
/// lower number begins a new count, as of a detector that was started anew: all below it were lost.
///
/// A jump that was rejected before it was an event (kRejected), or has no finite result, was told,
/// and its number is not missing. It takes no effect, so that it may be told again; and since its
/// stamp may not be its own, a lower number that is not missing begins no new count there.
class NumberedJumps : public LawDecorator {
 public:
  explicit NumberedJumps(std::shared_ptr<const ObserverLaw> law);

  bool accepts(const Event& event) const override;
  void initialize(double* state) const override;
  void flow(Duration duration, double* state, double* workspace) const override;
  Effect reset(const Event& event, double* state, double* workspace) const override;
  VectorSlot records_of_jumps() const override { return own_records(); }

 private:
  enum class Lower : std::uint8_t { kBeginsNewCount, kSaysNothing };
  void note_number(std::uint64_t number, Lower lower, double* state) const;
  void lose(std::uint64_t jumps, double* state) const;

  NumberSlot last_ = state_layout().number();  ///< that took effect; 0 where there was none
  NumberSlot told_ = state_layout().number();  ///< the largest of this count, whatever its effect
  /// Which are missing below `told_`: a bit for each, of 1 for the one just below.
  NumberSlot missing_ = state_layout().number();
  NumberSlot skipped_ = state_layout().number();  ///< in all
};

}  // namespace sampled_data_observers
