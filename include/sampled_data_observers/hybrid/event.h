#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// What an event does to the observer. But for withdrawals, the numbers are the order in which
/// events of equal stamp take effect: a new input holds from its stamp on, so it comes first; a
/// plant jump has priority over what is measured, so an output or sample stamped at the instant of
/// a jump is one after it.
enum class EventKind : std::uint8_t {
  kInput = 0,       ///< a known input, held until the next
  kJump = 1,        ///< the plant jumped
  kJumpOutput = 2,  ///< an output y_d that was measured just before a jump of the same stamp
  kRelease = 3,     ///< a reset that was computed for an earlier jump takes effect
  kOutput = 4,      ///< a continuous output y_c, held until the next or a jump
  kSample = 5,      ///< a sample of a sensor
  kRejected = 6,    ///< something that the plant saw, and the estimate did not: no event itself
  kWithdrawal = 7   ///< a jump of the same stamp was none; it comes before jumps, behind inputs
};

/// One event, as a view: the values belong to whoever made it.
struct Event {
  /// When it takes effect; 0 where that is unknown, and the event is of no use.
  Stamp stamp = 0;
  /// Decides what else means something.
  EventKind kind = EventKind::kSample;
  /// Of what is measured: the index of its sensor; of inputs: that of their channel
  /// (Plant::input_channels()).
  int sensor = 0;
  /// u of the inputs of a channel, y of what is measured, y_d of jumps that come with it.
  const double* values = nullptr;
  /// Number of values.
  Eigen::Index size = 0;
  /// Of jumps: when the reset takes effect, for a law that delays jumps; 0 where that is when the
  /// event arrives. It is no part of the jump itself.
  Stamp release = 0;
  /// Of jumps of a plant that switches, and of their withdrawals: the label of the mode that
  /// follows. Messages may hold any number.
  std::optional<double> mode = std::nullopt;
  /// Of jumps and their withdrawals, rejected ones too: their number, as who detects them counts; 0
  /// where nobody does.
  std::uint32_t index = 0;
  /// Of releases, which have the mode and the number of their jump: the time since it.
  Duration delay = 0;
  /// Of what was rejected: its kind.
  EventKind rejected = EventKind::kInput;
  /// Of samples: how many numbers follow the values, the lower triangle of the covariance of their
  /// noise, row by row; 0 where it does not come with them.
  Eigen::Index covariance = 0;

  /// The values where they are: nothing is copied.
  Eigen::Map<const Eigen::VectorXd> vector() const { return {values, size}; }
  /// The values, and the covariance that follows them.
  Eigen::Map<const Eigen::VectorXd> numbers() const { return {values, size + covariance}; }
};

/// Total order of events: by stamp, then kind, sensor or kind rejected, index, number of values,
/// mode or delay, and values, with their covariance, in lexicographic order. Negative, zero or
/// positive as for strcmp; zero means a duplicate.
/// @pre all values and modes are finite
int compare(const Event& a, const Event& b);

/// A number by which events are told apart, of all that compare() looks at: equal for duplicates,
/// and for others as good as never.
std::uint64_t digest(const Event& event);

/// Whether a withdrawal is about a jump: that of its stamp and its number, or, where nobody counts,
/// each of its stamp into its mode.
bool withdraws(const Event& withdrawal, const Event& jump);

}  // namespace sampled_data_observers
