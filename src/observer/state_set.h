#pragma once

#include <Eigen/Core>
#include <memory>

#include "sampled_data_observers/plant/vector_map.h"

namespace sampled_data_observers {

/// Where all of some formulas in x and u are at most as large as their margins.
struct StateSet {
  /// Never null.
  std::shared_ptr<const VectorMap> formulas;
  /// One for each formula, in its unit.
  Eigen::VectorXd margins;

  /// Whether (x, u) lies in it; not where a formula has no value.
  /// @param values  room for one number of each formula
  bool contains(const double* x, const double* u, double* values) const {
    formulas->evaluate(x, u, values);
    for (Eigen::Index i = 0; i < margins.size(); ++i) {
      if (!(values[i] <= margins(i))) return false;
    }
    return true;
  }
};

}  // namespace sampled_data_observers
