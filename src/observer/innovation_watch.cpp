#include "sampled_data_observers/observer/innovation_watch.h"

#include <cmath>

namespace sampled_data_observers {
namespace {

constexpr int kDoublingsOfGrowth = 3;
constexpr int kDoublingsOfDivergence = 5;
/// Innovations this many times as large as the outputs.
constexpr double kLarge = 3.0;
constexpr double kVeryLarge = 10.0;
constexpr double kGrownBy = 1e3;

}  // namespace

InnovationTrend InnovationWatch::add(double innovation, double output) noexcept {
  innovation_squares_ += innovation * innovation;
  output_squares_ += output * output;
  if (++count_ == kWindow) {
    judge(std::sqrt(innovation_squares_ / kWindow), std::sqrt(output_squares_ / kWindow));
    innovation_squares_ = output_squares_ = 0.0;
    count_ = 0;
  }
  return trend_;
}

void InnovationWatch::judge(double innovation, double output) noexcept {
  if (reference_ < 0.0 || innovation <= reference_ / 2.0) {
    reference_ = start_ = innovation;
    doublings_ = 0;
  } else if (innovation >= 2.0 * reference_) {
    reference_ = innovation;
    ++doublings_;
  }
  trend_ = InnovationTrend::kSteady;
  if (doublings_ >= kDoublingsOfGrowth && innovation > kLarge * output) {
    trend_ = InnovationTrend::kGrowing;
  }
  // The squares of what is not far from overflow are not finite.
  const bool is_huge = !std::isfinite(innovation) || innovation > kVeryLarge * output;
  if (doublings_ >= kDoublingsOfDivergence && is_huge && innovation >= kGrownBy * start_) {
    trend_ = InnovationTrend::kDiverging;
  }
}

}  // namespace sampled_data_observers
