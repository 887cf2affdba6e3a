#include "plant/jacobian.h"

#include <algorithm>
#include <utility>

#include "plant/differentiation.h"

namespace sampled_data_observers {

Jacobian::Jacobian(std::shared_ptr<const VectorMap> map, Eigen::VectorXd scales)
    : map_(std::move(map)), scales_(std::move(scales)) {
  if (map_->affine() == nullptr) derivative_ = map_->jacobian();
}

const double* Jacobian::constant() const {
  return map_->affine() == nullptr ? nullptr : map_->affine()->M().data();
}

Eigen::Index Jacobian::workspace_size() const {
  const bool takes_differences = map_->affine() == nullptr && derivative_ == nullptr;
  return takes_differences ? scales_.size() + 2 * rows() : 0;
}

void Jacobian::evaluate(const double* x, const double* u, double* J, double* workspace) const {
  if (const double* matrix = constant()) {
    std::copy_n(matrix, rows() * scales_.size(), J);
  } else if (derivative_ != nullptr) {
    derivative_->evaluate(x, u, J);
  } else {
    differentiate(*map_, x, u, scales_, J, workspace);
  }
}

}  // namespace sampled_data_observers
