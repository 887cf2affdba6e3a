#pragma once

#include <Eigen/Core>
#include <memory>

#include "sampled_data_observers/plant/vector_map.h"

namespace sampled_data_observers {

/// ∂map/∂x of any map: its matrix where it is affine, its derivative where it knows that (formulas
/// do), else central differences as differentiate() takes them.
class Jacobian {
 public:
  /// @param scales  n entries: see differentiate()
  /// @throws std::invalid_argument, std::length_error as VectorMap::jacobian().
  Jacobian(std::shared_ptr<const VectorMap> map, Eigen::VectorXd scales);

  /// Where the map is affine its matrix, rows() x n, column-major; else null.
  const double* constant() const;
  Eigen::Index rows() const { return map_->size(); }
  /// That evaluate() needs.
  Eigen::Index workspace_size() const;

  /// J ← the Jacobian at (x, u), rows() x n, column-major. Allocates nothing.
  void evaluate(const double* x, const double* u, double* J, double* workspace) const;

 private:
  std::shared_ptr<const VectorMap> map_;
  std::shared_ptr<const VectorMap> derivative_;  ///< null where it is not known
  Eigen::VectorXd scales_;
};

}  // namespace sampled_data_observers
