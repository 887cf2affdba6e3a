#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

#include "sampled_data_observers/hybrid/time.h"
#include "sampled_data_observers/plant/vector_map.h"
#include "sampled_data_observers/runtime/running_scale.h"
#include "sampled_data_observers/runtime/step_window.h"

namespace sampled_data_observers {

/// Finds jumps of a plant in a sampled signal.
///
/// Crossings (all kinds but steps) are put where linear interpolation between the samples before
/// and after puts them. After one, the signal must come back by the hysteresis, to `threshold -
/// hysteresis` where rising, before another one counts; so it must before the first, too.
///
/// A step lies in the middle between two samples: those between which the change is the largest
/// while it is large enough. It is told of as soon as the change is not large enough any more, or
/// no larger one has come for `window` samples, which is 2 `window` samples after it at the latest.
/// Two steps nearer than that are one.
///
/// Allocates nothing after construction.
class JumpDetector {
 public:
  /// What of the signal is looked at.
  enum class Kind : std::uint8_t {
    kThreshold,  ///< it crosses a level
    kDeviation,  ///< it leaves its running median
    kStep,       ///< it changes between two samples
    kGuard       ///< a formula of it goes from negative to positive or zero
  };

  /// Which way it crosses, deviates or changes.
  enum class Direction : std::uint8_t {
    kRising,
    kFalling,
    kEither  ///< of deviations and steps
  };

  /// What a jump looks like in the signal.
  struct Options {
    Kind kind = Kind::kThreshold;  ///< decides what else means something
    /// In units of the signal: the level, or the least deviation or step that counts.
    double threshold = 0.0;
    double hysteresis = 0.0;  ///< not negative, in units of what crosses; not of steps
    Direction direction = Direction::kRising;  ///< not of guards
    /// A jump sooner than that after the last one is none [ns].
    Duration refractory = 0;
    /// Of steps: over how many samples before and after each its mean is taken, at least 1.
    std::size_t window = 1;
    /// Of deviations and steps: how many times the running scale counts, too. 0: it does not.
    double noise_factor = 0.0;
    /// How many samples make the running scale. Before there are as many, nothing is found.
    std::size_t noise_samples = 1;
    /// Of guards: a map to one entry, of the signal and of the time since the last jump, or since
    /// the first sample where there was none [s].
    std::shared_ptr<const VectorMap> guard;
    /// A jump counts only if the energy was as large in a sample between the last jump, or the
    /// first sample, and it.
    double least_energy = -std::numeric_limits<double>::infinity();
  };

  /// What a sample of the signal says.
  enum class Finding : std::uint8_t {
    kNothing,
    kJump,        ///< at crossing()
    kOutOfOrder,  ///< nothing: its stamp is not after that of the sample before
    /// Nothing: its value, energy or guard is NaN, infinite or beyond kLargestValue.
    kNotFinite
  };

  /// @pre options are as they say; deviations have a noise_factor
  explicit JumpDetector(const Options& options);

  /// Takes in the next sample. One that is out of order or not finite is as if it had not come.
  /// @param stamp   after that of the sample before
  /// @param value   of the signal
  /// @param energy  compared with least_energy
  Finding add(Stamp stamp, double value, double energy = 0.0);

  /// The stamp of the last jump found.
  Stamp crossing() const { return crossing_; }

  /// How many samples before the present one came the one that shows the plant at the jump just
  /// found: of crossings it is the present one, of steps the last one before.
  std::size_t samples_ago() const { return samples_ago_; }
  /// The largest number that it can be.
  std::size_t most_samples_ago() const { return steps_ ? 2 * steps_->half() : 0; }

  /// Forgets all samples.
  void restart();

 private:
  static constexpr double kNoEnergy = -std::numeric_limits<double>::infinity();

  /// A step that may grow.
  struct Candidate {
    double excess = 0.0;
    Stamp stamp = 0;
    /// The largest before and after it.
    double energy_before = 0.0;
    double energy_after = kNoEnergy;
    /// Samples since its excess was the largest.
    std::size_t age = 0;
    bool is_told = false;
  };

  double guard_of(Stamp stamp, double value) const;
  std::optional<double> excess_of(double value);
  Finding look_for_crossing(Stamp stamp, std::optional<double> height, double energy);
  Finding look_for_step(const StepWindow::Sample& sample);
  bool counts(Stamp jump, double energy) const;
  Finding found(Stamp jump, double energy_since);

  Options options_;
  /// Of the sample before; its height is how far it lies beyond the threshold.
  Stamp stamp_ = 0;
  double height_ = 0.0;
  /// Whether the signal has come back, so that the next crossing counts.
  bool is_armed_ = false;
  Stamp crossing_ = 0;
  std::size_t samples_ago_ = 0;
  /// Of the last jump or the first sample; 0: none yet.
  Stamp since_ = 0;
  /// The largest since the last jump.
  double energy_ = kNoEnergy;
  std::optional<RunningScale> scale_;
  std::optional<StepWindow> steps_;
  std::optional<Candidate> candidate_;
};

}  // namespace sampled_data_observers
