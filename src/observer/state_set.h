#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "sampled_data_observers/plant/vector_map.h"

namespace sampled_data_observers {

/// Where all of some formulas in x and u are at most as large as their margins.
struct StateSet {
  /// Never null.
  std::shared_ptr<const VectorMap> formulas;
  /// One for each formula, in its unit.
  Eigen::VectorXd margins;

  /// By how much the formulas exceed their margins at most; NaN where one has no value.
  /// @param values  room for one number of each formula
  double excess(const double* x, const double* u, double* values) const {
    formulas->evaluate(x, u, values);
    double most = -std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < margins.size(); ++i) {
      if (std::isnan(values[i])) return values[i];
      most = std::max(most, values[i] - margins(i));
    }
    return most;
  }

  /// Whether (x, u) lies in it; not where a formula has no value.
  bool contains(const double* x, const double* u, double* values) const {
    return excess(x, u, values) <= 0.0;
  }
};

}  // namespace sampled_data_observers
