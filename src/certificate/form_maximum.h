#pragma once

#include <Eigen/Core>

namespace sampled_data_observers {

/// The largest of eᵀ M e, M >= 0, of all e with e eᵀ <= Q, at most. It is the largest eigenvalue of
/// M^½ Q M^½, of which the trace tr(M Q) and the norm √tr(M Q M Q) are not less: the smaller one,
/// with its rounding. Allocates nothing once it is built, and sums in a fixed order.
class FormMaximum {
 public:
  FormMaximum() = default;
  /// @param M     n x n
  /// @param size  of the terms that its entries are sums of, of less than 32 products each
  FormMaximum(const Eigen::MatrixXd& M, const Eigen::MatrixXd& size) : M_(M), size_(size) {}

  /// @param Q  n x n, symmetric
  double over(const Eigen::Ref<const Eigen::MatrixXd>& Q) const;

 private:
  double trace(const Eigen::Ref<const Eigen::MatrixXd>& Q) const;
  double norm(const Eigen::Ref<const Eigen::MatrixXd>& Q) const;

  Eigen::MatrixXd M_;
  Eigen::MatrixXd size_;
};

}  // namespace sampled_data_observers
