#pragma once

#include <Eigen/Core>

namespace sampled_data_observers {

/// The largest of eᵀ M e, M >= 0, of all e with e eᵀ <= Q, at most: tr(M Q). Allocates nothing once
/// it is built, and sums in a fixed order.
class FormMaximum {
 public:
  FormMaximum() = default;
  /// @param M     n x n
  /// @param size  of the terms that its entries are sums of, of less than 32 products each
  FormMaximum(const Eigen::MatrixXd& M, const Eigen::MatrixXd& size) : M_(M), size_(size) {}

  /// @param Q  n x n, symmetric
  double over(const Eigen::Ref<const Eigen::MatrixXd>& Q) const;

 private:
  Eigen::MatrixXd M_;
  Eigen::MatrixXd size_;
};

}  // namespace sampled_data_observers
