#include "sampled_data_observers/plant/vector_map.h"

#include <stdexcept>
#include <utility>

#include "sampled_data_observers/linear_algebra/ordered_product.h"

namespace sampled_data_observers {

std::shared_ptr<const VectorMap> VectorMap::jacobian() const { return nullptr; }

AffineMap::AffineMap(Eigen::MatrixXd M, Eigen::MatrixXd N, Eigen::VectorXd c)
    : M_(std::move(M)), N_(std::move(N)), c_(std::move(c)) {
  if (N_.rows() != M_.rows() || c_.size() != M_.rows()) {
    throw std::invalid_argument("AffineMap: M, N and c must have as many rows");
  }
  if (!M_.allFinite() || !N_.allFinite() || !c_.allFinite()) {
    throw std::invalid_argument("AffineMap: all entries must be finite");
  }
}

AffineMap::AffineMap(const Eigen::MatrixXd& M)
    : AffineMap(M, Eigen::MatrixXd::Zero(M.rows(), 0), Eigen::VectorXd::Zero(M.rows())) {}

void AffineMap::evaluate(const double* x, const double* u, double* out) const {
  for (Eigen::Index i = 0; i < M_.rows(); ++i) out[i] = c_(i);
  add_product(M_, x, out);
  add_product(N_, u, out);
}

}  // namespace sampled_data_observers
