#pragma once

#include <cstdint>

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// Finds jumps of a plant in a sampled signal: the instants at which it crosses a threshold, by
/// linear interpolation between the samples before and after.
///
/// After a crossing the signal must come back by the hysteresis, to `threshold - hysteresis` where
/// rising, before another one counts; so it must before the first, too.
class JumpDetector {
 public:
  /// What a jump looks like in the signal.
  struct Options {
    double threshold = 0.0;   ///< in units of the signal
    double hysteresis = 0.0;  ///< not negative, in units of the signal
    bool rising = true;       ///< or else falling
    /// A crossing sooner than that after the last jump is none [ns].
    Duration refractory = 0;
  };

  /// What a sample of the signal says.
  enum class Finding : std::uint8_t {
    kNothing,
    kJump,        ///< at crossing()
    kOutOfOrder,  ///< nothing: its stamp is not after that of the sample before
    kNotFinite    ///< nothing: its value is NaN or infinite
  };

  /// @pre options.hysteresis and options.refractory are not negative
  explicit JumpDetector(const Options& options) : options_(options) {}

  /// Takes in the next sample. One that is out of order or not finite is as if it had not come.
  Finding add(Stamp stamp, double value);

  /// The stamp of the last jump found.
  Stamp crossing() const { return crossing_; }

  /// Forgets all samples.
  void restart();

 private:
  Options options_;
  /// Of the sample before; its height is how far it lies beyond the threshold.
  Stamp stamp_ = 0;
  double height_ = 0.0;
  /// Whether the signal has come back, so that the next crossing counts.
  bool is_armed_ = false;
  Stamp crossing_ = 0;
};

}  // namespace sampled_data_observers
