#include "design/parameter_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sampled_data_observers {
namespace {

constexpr int kRounds = 6;
constexpr double kSmallChange = 1e-3;
constexpr double kSmallChangeOfSmallCost = 3e-2;

/// Points in each direction, so that a grid stays small in several.
std::size_t points_per_range(std::size_t ranges, SearchGoal goal) {
  if (goal == SearchGoal::kSmallCost) return ranges <= 1 ? 9 : 5;
  if (ranges <= 1) return 13;
  return ranges == 2 ? 7 : 5;
}

double scaled(const SearchRange& range, double value) {
  return range.is_logarithmic ? std::log(value) : value;
}

double unscaled(const SearchRange& range, double value) {
  return range.is_logarithmic ? std::exp(value) : value;
}

struct Box {
  double low = 0.0;
  double high = 0.0;
};

std::vector<Parameters> grid(const std::vector<NamedRange>& ranges, const std::vector<Box>& boxes,
                             std::size_t points) {
  std::vector<Parameters> all = {{}};
  for (std::size_t r = 0; r < ranges.size(); ++r) {
    std::vector<Parameters> longer;
    for (const Parameters& start : all) {
      for (std::size_t i = 0; i < points; ++i) {
        const double fraction = static_cast<double>(i) / static_cast<double>(points - 1);
        Parameters next = start;
        next[ranges[r].name] =
            unscaled(ranges[r].range, boxes[r].low + fraction * (boxes[r].high - boxes[r].low));
        longer.push_back(std::move(next));
      }
    }
    all = std::move(longer);
  }
  return all;
}

}  // namespace

std::vector<Parameters> neighbours(const std::vector<Parameters>& starts, const NamedRange& named,
                                   double value, double distance) {
  const SearchRange& range = named.range;
  std::vector<Parameters> all;
  for (const double offset : {0.0, -distance, distance}) {
    const double moved = range.is_logarithmic ? value * std::exp(offset)
                                              : value + offset * (range.high - range.low) / 4.0;
    for (const Parameters& start : starts) {
      all.push_back(start);
      all.back()[named.name] = std::clamp(moved, range.low, range.high);
    }
  }
  return all;
}

std::size_t search_parameters(const std::vector<NamedRange>& ranges, SearchGoal goal,
                              const BatchCost& cost) {
  if (ranges.empty()) return cost({{}}).size();
  std::size_t points = points_per_range(ranges.size(), goal);
  std::vector<Box> whole;
  for (const NamedRange& named : ranges) {
    whole.push_back({scaled(named.range, named.range.low), scaled(named.range, named.range.high)});
  }
  std::vector<Box> boxes = whole;
  double best_cost = std::numeric_limits<double>::infinity();
  std::size_t tried = 0;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<Parameters> choices = grid(ranges, boxes, points);
    const std::vector<double> costs = cost(choices);
    tried += choices.size();
    std::size_t best = choices.size();
    const double before = best_cost;
    for (std::size_t i = 0; i < choices.size(); ++i) {
      if (!(costs[i] < best_cost)) continue;
      best_cost = costs[i];
      best = i;
    }
    if (!std::isfinite(best_cost)) {
      if (round > 0) break;
      points = 2 * points - 1;
      continue;
    }
    if (goal == SearchGoal::kAnySolution) break;
    const double small_change =
        goal == SearchGoal::kSmallCost ? kSmallChangeOfSmallCost : kSmallChange;
    if (round > 0 && !(before - best_cost > small_change * std::abs(best_cost)) &&
        std::isfinite(before)) {
      break;
    }
    points = points_per_range(ranges.size(), goal);
    for (std::size_t r = 0; r < ranges.size(); ++r) {
      const double reach = (boxes[r].high - boxes[r].low) / static_cast<double>(points - 1);
      const double centre = best < choices.size()
                                ? scaled(ranges[r].range, choices[best].at(ranges[r].name))
                                : (boxes[r].low + boxes[r].high) / 2.0;
      boxes[r] = {std::max(whole[r].low, centre - reach), std::min(whole[r].high, centre + reach)};
    }
  }
  return tried;
}

}  // namespace sampled_data_observers
