#pragma once

#include <Eigen/Core>
#include <optional>

namespace sampled_data_observers {

/// Bounds within which states are known to stay, sat(x) in bernard2022 (21) and example 4.3.
class Saturation {
 public:
  /// No bounds for n states.
  explicit Saturation(Eigen::Index n);

  /// @throws std::invalid_argument unless low < high, both finite, and 0 <= state < n.
  void bound(Eigen::Index state, double low, double high);

  Eigen::Index size() const { return low_.size(); }

  /// (low, high) of a state; nothing where it has no bounds.
  std::optional<Eigen::RowVector2d> bounds(Eigen::Index state) const;

  /// Brings each entry of x (n entries) into its bounds; a bounded one that is NaN to its lower
  /// one.
  void apply(double* x) const;

  /// Whether an entry of x (n entries) is at one of its bounds or beyond.
  bool is_active(const double* x) const;

  /// Sizes of the states' usual changes: half the width of the bounds, 1 where there are none.
  const Eigen::VectorXd& scales() const { return scales_; }

 private:
  Eigen::VectorXd low_;
  Eigen::VectorXd high_;
  Eigen::VectorXd scales_;
};

}  // namespace sampled_data_observers
