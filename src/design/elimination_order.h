#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace sampled_data_observers {

/// In which order the groups of variables of a sparse symmetric matrix are eliminated.
struct EliminationOrder {
  std::vector<std::size_t> order;
  /// For each place in this order, the later places that the columns of its Cholesky factor reach,
  /// increasing.
  std::vector<std::vector<std::size_t>> later;
};

/// Always the group next whose factor has the fewest rows at that time.
/// @param sizes    number of variables of each group
/// @param cliques  groups all of which the matrix couples with each other, each increasing
EliminationOrder elimination_order(const std::vector<Eigen::Index>& sizes,
                                   const std::vector<std::vector<std::size_t>>& cliques);

}  // namespace sampled_data_observers
