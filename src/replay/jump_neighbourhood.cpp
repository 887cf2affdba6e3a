#include "replay/jump_neighbourhood.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sampled_data_observers {
namespace {

/// Where each state of the plant stands among the quantities; empty where one is missing.
std::vector<std::size_t> places_of_states(const Plant& plant,
                                          const std::vector<Quantity>& quantities) {
  std::vector<std::size_t> places;
  for (Eigen::Index state = 0; state < plant.states(); ++state) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(plant.states(), state);
    const auto found = std::find_if(quantities.begin(), quantities.end(), [&](const Quantity& one) {
      return one.row == unit && one.constant == 0.0;
    });
    if (found == quantities.end()) return {};
    places.push_back(static_cast<std::size_t>(found - quantities.begin()));
  }
  return places;
}

}  // namespace

JumpNeighbourhood::JumpNeighbourhood(std::vector<Quantity> quantities,
                                     std::shared_ptr<const Plant> plant, Duration around)
    : quantities_(std::move(quantities)), plant_(std::move(plant)), around_(around) {
  if (plant_->modes().size() == 1 && plant_->modes().front().jump) {
    places_ = places_of_states(*plant_, quantities_);
  }
}

void JumpNeighbourhood::add_jump(Stamp stamp, Stamp release) {
  jumps_.push_back({stamp - around_, release + around_});
}

void JumpNeighbourhood::remove_jump(Stamp stamp) {
  const auto found = std::find_if(jumps_.begin(), jumps_.end(), [&](const Interval& interval) {
    return interval.begin == stamp - around_;
  });
  if (found != jumps_.end()) jumps_.erase(found);
}

double JumpNeighbourhood::distance(const std::vector<double>& truth,
                                   const Eigen::VectorXd& x) const {
  double squares = 0.0;
  for (std::size_t i = 0; i < quantities_.size(); ++i) {
    squares += std::pow(error_of(quantities_[i], x.data(), truth[i]), 2);
  }
  return std::sqrt(squares);
}

void JumpNeighbourhood::add_truth(Stamp stamp, const std::vector<double>& truth, const double* x,
                                  const double* u) {
  for (std::size_t i = 0; i < quantities_.size(); ++i) {
    squares_.push_back(std::pow(error_of(quantities_[i], x, truth[i]), 2));
  }
  const Eigen::VectorXd estimate = Eigen::Map<const Eigen::VectorXd>(x, plant_->states());
  Compared compared{stamp, distance(truth, estimate), std::nullopt};
  if (!places_.empty()) {
    const VectorMap& jump = *plant_->modes().front().jump;
    Eigen::VectorXd state(plant_->states());
    for (std::size_t i = 0; i < places_.size(); ++i) {
      state(static_cast<Eigen::Index>(i)) = truth[places_[i]];
    }
    Eigen::VectorXd jumped(plant_->states());
    jump.evaluate(x, u, jumped.data());
    double least = std::min(compared.norm, distance(truth, jumped));
    jump.evaluate(state.data(), u, jumped.data());
    std::vector<double> truth_ahead = truth;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      truth_ahead[places_[i]] = jumped(static_cast<Eigen::Index>(i));
    }
    least = std::min(least, distance(truth_ahead, estimate));
    compared.without_peak = least;
  }
  compared_.push_back(compared);
}

/// Those around jumps, in order, and apart from each other.
std::vector<JumpNeighbourhood::Interval> JumpNeighbourhood::intervals() const {
  std::vector<Interval> sorted = jumps_;
  std::sort(sorted.begin(), sorted.end(),
            [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
  std::vector<Interval> result;
  for (const Interval& next : sorted) {
    if (result.empty() || next.begin > result.back().end) {
      result.push_back(next);
    } else {
      result.back().end = std::max(result.back().end, next.end);
    }
  }
  return result;
}

ErrorsApart JumpNeighbourhood::errors() const {
  ErrorsApart result;
  result.around = to_seconds(around_);
  result.jumps = jumps_.size();
  const std::vector<Interval> around = intervals();
  const auto is_around_jump = [&](Stamp stamp) {
    const auto next = std::upper_bound(
        around.begin(), around.end(), stamp,
        [](Stamp value, const Interval& interval) { return value < interval.begin; });
    return next != around.begin() && stamp <= std::prev(next)->end;
  };
  const auto raise = [](std::optional<double>& largest, double value) {
    largest = std::max(largest.value_or(0.0), value);
  };
  std::vector<double> sums(quantities_.size(), 0.0);
  for (std::size_t i = 0; i < compared_.size(); ++i) {
    const Compared& one = compared_[i];
    if (is_around_jump(one.stamp)) {
      raise(result.peak, one.norm);
      if (one.without_peak) raise(result.peak_free, *one.without_peak);
      continue;
    }
    ++result.stamps;
    raise(result.largest, one.norm);
    for (std::size_t j = 0; j < sums.size(); ++j) sums[j] += squares_[i * sums.size() + j];
  }
  for (const double sum : sums) {
    result.rmse.push_back(result.stamps == 0 ? std::nullopt
                                             : std::optional<double>(std::sqrt(
                                                   sum / static_cast<double>(result.stamps))));
  }
  result.rmse_norm = Comparison::norm(result.rmse);
  return result;
}

}  // namespace sampled_data_observers
