#pragma once

#include <Eigen/Core>
#include <memory>
#include <utility>
#include <vector>

#include "sampled_data_observers/plant/vector_map.h"

namespace sampled_data_observers {

/// What is stated of the differences of a flow f: for all x, x̂ and u
///   f(x, u) − f(x̂, u) = A (x − x̂) + G φ,  |φ| <= lipschitz_constant |S (x − x̂)|
/// with some A in the convex hull of the vertices, which may depend on x, x̂ and u. So it is, by the
/// mean value theorem, where f = f_1 + G ψ(S x), the Jacobian of f_1 is in the hull everywhere, and
/// ψ has that Lipschitz constant.
struct PolytopicDescription {
  std::vector<Eigen::MatrixXd> vertices;  ///< n x n each, at least one
  Eigen::MatrixXd G;                      ///< n x s; no columns where A says all
  Eigen::MatrixXd S;                      ///< q x n
  double lipschitz_constant = 0.0;        ///< >= 0
};

/// A flow of which that is stated. What designs for plants by formulas rest on.
class PolytopicMap : public VectorMap {
 public:
  PolytopicMap(std::shared_ptr<const VectorMap> map, PolytopicDescription description)
      : map_(std::move(map)), description_(std::move(description)) {}

  const PolytopicDescription& description() const { return description_; }

  Eigen::Index size() const override { return map_->size(); }
  void evaluate(const double* x, const double* u, double* out) const override {
    map_->evaluate(x, u, out);
  }
  const AffineMap* affine() const override { return map_->affine(); }

 private:
  std::shared_ptr<const VectorMap> map_;
  PolytopicDescription description_;
};

}  // namespace sampled_data_observers
