#pragma once

#include <cstdint>

namespace sampled_data_observers {

/// How the innovations of a sensor develop.
enum class InnovationTrend : std::uint8_t {
  kSteady = 0,
  kGrowing = 1,   ///< they doubled again and again, and are large beside the outputs
  kDiverging = 2  ///< and grew a thousandfold
};

/// Watches the innovations of one sensor for an estimate that runs away: root mean squares over
/// kWindow samples that double again and again, without halving in between, until they are larger
/// than the outputs themselves. Noise, outliers and an estimate that starts far off do not do that.
/// Allocates nothing.
class InnovationWatch {
 public:
  /// Number of samples over which a root mean square is taken.
  static constexpr int kWindow = 8;

  /// Takes in the norms of the next innovation and of the sample that it is of; returns trend().
  InnovationTrend add(double innovation, double output) noexcept;

  /// As of the last full window.
  InnovationTrend trend() const { return trend_; }

 private:
  void judge(double innovation, double output) noexcept;

  double innovation_squares_ = 0.0;
  double output_squares_ = 0.0;
  int count_ = 0;
  /// Root mean squares at the last doubling or halving, and where the doublings began; negative
  /// before the first window.
  double reference_ = -1.0;
  double start_ = -1.0;
  int doublings_ = 0;
  InnovationTrend trend_ = InnovationTrend::kSteady;
};

}  // namespace sampled_data_observers
