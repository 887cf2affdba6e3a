#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "design/standard_form.h"

namespace sampled_data_observers {

/// One block F_0 + Σ x_k F_k of a semidefinite program, with sparse symmetric F_k.
struct SdpBlock {
  /// F[row, col] = F[col, row] = value.
  struct Entry {
    Eigen::Index row = 0;
    Eigen::Index col = 0;  ///< >= row
    double value = 0.0;
  };
  Eigen::MatrixXd constant;  ///< F_0
  /// Those that change it, in increasing order.
  std::vector<Eigen::Index> variables;
  /// Of F_k of variables[i]: from first[i] on, up to first[i + 1].
  std::vector<Entry> entries;
  std::vector<std::size_t> first;

  Eigen::Index size() const { return constant.rows(); }

  /// Adds Σ x_k F_k.
  void add_combination(const Eigen::VectorXd& x, Eigen::MatrixXd& sum) const;
  /// Adds tr(F_k U) to sum_k, for each of its variables.
  /// @param U  need not be symmetric
  void add_inner_products(const Eigen::MatrixXd& U, Eigen::VectorXd& sum) const;
  /// tr(F_k U) of variables[i].
  double inner_product(std::size_t i, const Eigen::MatrixXd& U) const;
};

/// A program min c'x so that all blocks are positive semidefinite, with variables in units in which
/// each changes the blocks by 1, in the Frobenius norm of all, and the largest |c_k| is 1.
struct SdpData {
  explicit SdpData(const StandardForm& form);

  std::vector<SdpBlock> blocks;
  Eigen::VectorXd objective;
  /// x_k of the form is units(k) times x_k here, and its objective objective_unit times this one.
  Eigen::VectorXd units;
  double objective_unit = 1.0;
};

}  // namespace sampled_data_observers
