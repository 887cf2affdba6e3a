#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace sampled_data_observers::test {

/// Vectors at increasing times [s since the start], a constant period apart unless taken apart.
/// Norms are Euclidean. Over no times at all they are NaN, so that no comparison holds.
class Trajectory {
 public:
  explicit Trajectory(double period) : period_(period) {}

  void add(double time, Eigen::VectorXd value) {
    times_.push_back(time);
    values_.push_back(std::move(value));
  }

  std::size_t size() const { return times_.size(); }
  double time(std::size_t k) const { return times_.at(k); }
  const Eigen::VectorXd& value(std::size_t k) const { return values_.at(k); }

  /// One entry of the vectors.
  Trajectory component(Eigen::Index i) const {
    Trajectory result(period_);
    for (std::size_t k = 0; k < size(); ++k) result.add(times_[k], values_[k].segment(i, 1));
    return result;
  }
  /// At the times where `holds`.
  Trajectory where(const std::function<bool(double time)>& holds) const {
    Trajectory result(period_);
    for (std::size_t k = 0; k < size(); ++k) {
      if (holds(times_[k])) result.add(times_[k], values_[k]);
    }
    return result;
  }
  /// From t on, and up to, but without, `end`.
  Trajectory from(double t, double end = std::numeric_limits<double>::infinity()) const {
    return where([=](double time) { return t - 1e-6 <= time && time < end - 1e-6; });
  }

  double max() const {
    const std::vector<double> all = norms();
    return all.empty() ? kNone : *std::max_element(all.begin(), all.end());
  }
  double median() const {
    std::vector<double> all = norms();
    if (all.empty()) return kNone;
    std::sort(all.begin(), all.end());
    return all[all.size() / 2];
  }
  double rms() const { return std::sqrt(sum_of_squares() / static_cast<double>(size())); }
  /// Square root of the integral of the squared norm.
  double l2() const { return size() == 0 ? kNone : std::sqrt(sum_of_squares() * period_); }

  /// Norm at the first time not before t.
  double at(double t) const {
    const auto found = std::lower_bound(times_.begin(), times_.end(), t - 1e-6);
    return found == times_.end() ? kNone
                                 : values_[static_cast<std::size_t>(found - times_.begin())].norm();
  }
  /// The last time at which the norm is above `limit`; before all times where it never is.
  double last_above(double limit) const {
    for (std::size_t k = size(); k > 0; --k) {
      if (values_[k - 1].norm() > limit) return times_[k - 1];
    }
    return size() == 0 ? kNone : -std::numeric_limits<double>::infinity();
  }

 private:
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  std::vector<double> norms() const {
    std::vector<double> all;
    for (const Eigen::VectorXd& value : values_) all.push_back(value.norm());
    return all;
  }
  double sum_of_squares() const {
    double sum = 0.0;
    for (const Eigen::VectorXd& value : values_) sum += value.squaredNorm();
    return sum;
  }

  double period_;
  std::vector<double> times_;
  std::vector<Eigen::VectorXd> values_;
};

}  // namespace sampled_data_observers::test
