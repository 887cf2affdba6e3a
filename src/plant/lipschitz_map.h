#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "sampled_data_observers/plant/vector_map.h"

namespace sampled_data_observers {

/// The flow of a Lipschitz plant: A x + B u + G ψ(S x), ψ with q arguments and s components
/// (ferrante2019 (1), etienne2019 (1)).
struct LipschitzDescription {
  Eigen::MatrixXd A;                     ///< n x n
  Eigen::MatrixXd B;                     ///< n x p
  Eigen::MatrixXd G;                     ///< n x s
  Eigen::MatrixXd S;                     ///< q x n
  std::shared_ptr<const VectorMap> psi;  ///< q to s
  /// |ψ(a) − ψ(b)| <= lipschitz_constant |a − b|; what designs rest on.
  std::optional<double> lipschitz_constant;
  /// Vertices Ψ_i, n x n each: G (ψ(S x) − ψ(S x̂)) lies in the convex hull of all Ψ_i (x − x̂).
  std::vector<Eigen::MatrixXd> vertices;
};

class LipschitzMap : public VectorMap {
 public:
  /// @throws std::invalid_argument naming the part that does not fit.
  explicit LipschitzMap(LipschitzDescription description);

  const LipschitzDescription& description() const { return description_; }

  Eigen::Index size() const override { return description_.A.rows(); }
  void evaluate(const double* x, const double* u, double* out) const override;
  /// A + G ∂ψ/∂(S x) S
  std::shared_ptr<const VectorMap> jacobian() const override;

 private:
  LipschitzDescription description_;
  /// S x and ψ(S x)
  mutable Eigen::VectorXd argument_;
  mutable Eigen::VectorXd psi_;
};

}  // namespace sampled_data_observers
