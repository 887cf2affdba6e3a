#include "observer/numbered_jumps.h"

#include <cstdint>
#include <utility>

namespace sampled_data_observers {
namespace {

/// How many numbers below the largest are known one by one: as many bits as a double holds exactly.
constexpr std::uint64_t kKnownNumbers = 52;
constexpr std::uint64_t kAllMissing = (std::uint64_t{1} << kKnownNumbers) - 1;

/// One with a number.
bool is_rejected_jump(const Event& event) {
  return event.kind == EventKind::kRejected && event.rejected == EventKind::kJump &&
         event.index != 0;
}

}  // namespace

NumberedJumps::NumberedJumps(std::shared_ptr<const ObserverLaw> law)
    : LawDecorator(std::move(law)) {
  set_skipped_jumps(skipped_);
}

bool NumberedJumps::accepts(const Event& event) const {
  return is_rejected_jump(event) || law().accepts(event);
}

void NumberedJumps::initialize(double* state) const {
  law().initialize(state);
  last_.set(0.0, state);
  told_.set(0.0, state);
  missing_.set(0.0, state);
  skipped_.set(0.0, state);
}

void NumberedJumps::flow(Duration duration, double* state, double* workspace) const {
  law().flow(duration, state, workspace);
}

Effect NumberedJumps::reset(const Event& event, double* state, double* workspace) const {
  if (is_rejected_jump(event)) {
    note_number(event.index, Lower::kSaysNothing, state);
    return Effect::kApplied;
  }
  const bool is_jump = event.kind == EventKind::kJump;
  const bool is_numbered = event.index != 0 && (is_jump || event.kind == EventKind::kWithdrawal);
  if (!is_numbered) return law().reset(event, state, workspace);
  if (is_jump && last_.of(state) == static_cast<double>(event.index)) return Effect::kRepeated;
  // A jump that was withdrawn, or is refused, was not lost.
  note_number(event.index, Lower::kBeginsNewCount, state);
  const Effect effect = law().reset(event, state, workspace);
  if (is_jump && took_effect(effect)) last_.set(static_cast<double>(event.index), state);
  return effect;
}

void NumberedJumps::note_number(std::uint64_t number, Lower lower, double* state) const {
  const auto told = static_cast<std::uint64_t>(told_.of(state));
  if (number == told) return;
  auto missing = static_cast<std::uint64_t>(missing_.of(state));
  if (told == 0) {
    told_.set(static_cast<double>(number), state);
    return;
  }
  if (number > told) {
    const std::uint64_t ahead = number - told;
    const std::uint64_t moved = ahead > kKnownNumbers ? kAllMissing : missing << ahead;
    const std::uint64_t gap =
        ahead > kKnownNumbers ? kAllMissing : (std::uint64_t{1} << (ahead - 1)) - 1;
    missing = (moved | gap) & kAllMissing;
    told_.set(static_cast<double>(number), state);
    lose(ahead - 1, state);
  } else {
    const std::uint64_t below = told - number;
    const std::uint64_t bit = below > kKnownNumbers ? 0 : std::uint64_t{1} << (below - 1);
    if ((missing & bit) != 0) {
      missing ^= bit;
      skipped_.set(skipped_.of(state) - 1.0, state);
    } else if (lower == Lower::kBeginsNewCount) {
      missing = 0;
      told_.set(static_cast<double>(number), state);
      lose(number - 1, state);
    }
  }
  missing_.set(static_cast<double>(missing), state);
}

void NumberedJumps::lose(std::uint64_t jumps, double* state) const {
  skipped_.set(skipped_.of(state) + static_cast<double>(jumps), state);
}

}  // namespace sampled_data_observers
