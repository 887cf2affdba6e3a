#pragma once

#include <memory>
#include <utility>

#include "sampled_data_observers/plant/vector_map.h"

namespace sampled_data_observers {

/// A map of which a Lipschitz constant is stated: |map(x, u) − map(x', u)| <= constant |x − x'| for
/// all x, x' and u. What designs for a jump map by formulas rest on.
class BoundedSlopeMap : public VectorMap {
 public:
  /// @param constant  >= 0
  BoundedSlopeMap(std::shared_ptr<const VectorMap> map, double constant)
      : map_(std::move(map)), constant_(constant) {}

  double constant() const { return constant_; }

  Eigen::Index size() const override { return map_->size(); }
  void evaluate(const double* x, const double* u, double* out) const override {
    map_->evaluate(x, u, out);
  }
  const AffineMap* affine() const override { return map_->affine(); }
  std::shared_ptr<const VectorMap> jacobian() const override { return map_->jacobian(); }

 private:
  std::shared_ptr<const VectorMap> map_;
  double constant_;
};

}  // namespace sampled_data_observers
