#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include "sampled_data_observers/plant/vector_map.h"

namespace sampled_data_observers {

/// Where all of some formulas in x and u are at most as large as their margins. Each mode of a
/// plant has its own formulas.
struct StateSet {
  /// Of each mode; never null, and of one size.
  std::vector<std::shared_ptr<const VectorMap>> formulas;
  /// One for each formula, in its unit.
  Eigen::VectorXd margins;

  /// Whether there are formulas for each of so many modes, and one margin for each formula.
  bool fits(std::size_t modes) const {
    return formulas.size() == modes &&
           std::all_of(formulas.begin(), formulas.end(),
                       [this](const auto& map) { return map->size() == margins.size(); });
  }

  /// By how much the formulas exceed their margins at most; NaN where one has no value.
  /// @param values  room for one number of each formula
  double excess(std::size_t mode, const double* x, const double* u, double* values) const {
    formulas[mode]->evaluate(x, u, values);
    double most = -std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < margins.size(); ++i) {
      if (std::isnan(values[i])) return values[i];
      most = std::max(most, values[i] - margins(i));
    }
    return most;
  }

  /// Whether (x, u) lies in it; not where a formula has no value.
  bool contains(std::size_t mode, const double* x, const double* u, double* values) const {
    return excess(mode, x, u, values) <= 0.0;
  }
};

}  // namespace sampled_data_observers
