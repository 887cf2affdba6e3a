#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "design/schur_block.h"
#include "design/sdp_data.h"

namespace sampled_data_observers {

/// The matrix M_kj = Σ_blocks tr(F_k Z F_j S⁻¹) of an interior point method: symmetric, and zero
/// for two variables that no block has in common. Variables of the same blocks are eliminated
/// together, in an order of least degree, so that time grows with the number of cells where each
/// has variables of its own.
class SchurComplement {
 public:
  /// @param data  outlives it
  explicit SchurComplement(const SdpData& data);

  void set_zero();
  /// Adds what a block contributes.
  /// @param S_inverse,Z  symmetric
  void add_block(std::size_t block, const Eigen::MatrixXd& S_inverse, const Eigen::MatrixXd& Z);

  /// With as little added to the diagonal as it takes.
  /// @return false where it is not positive definite by far, or not finite
  bool factorize();

  /// M⁻¹ right, with iterative refinement.
  /// @pre factorize()
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;

 private:
  /// Variables of exactly the same blocks.
  struct Group {
    std::vector<Eigen::Index> variables;
    Eigen::Index size() const { return static_cast<Eigen::Index>(variables.size()); }
    /// Its first place among all, in the order of elimination.
    Eigen::Index begin = 0;
    /// The panel that it belongs to, and its first column there.
    std::size_t panel = 0;
    Eigen::Index column = 0;
  };
  /// Columns of the lower triangle: of some groups, and the rows of theirs and later ones.
  struct Panel {
    Eigen::Index begin = 0;
    Eigen::Index columns = 0;
    /// Groups with rows in it, in order, and the first row of each.
    std::vector<std::size_t> groups;
    std::vector<Eigen::Index> rows;
    Eigen::MatrixXd matrix;
    Eigen::MatrixXd factor;

    Eigen::Index row_of(std::size_t group) const;
  };

  void make_groups(const SdpData& data);
  std::vector<std::vector<std::size_t>> eliminate(const SdpData& data);
  void make_panels(const std::vector<std::vector<std::size_t>>& later);
  bool factorize_with(double shift);
  Eigen::VectorXd product(const Eigen::VectorXd& x) const;
  Eigen::VectorXd back_and_forth(Eigen::VectorXd x) const;

  /// In the order of elimination.
  std::vector<Group> groups_;
  std::vector<Panel> panels_;
  /// Of each block what it contributes, and to which groups, in order.
  std::vector<SchurBlock> blocks_;
  std::vector<std::vector<std::size_t>> groups_of_block_;
  /// Place of each variable in the order of elimination.
  std::vector<Eigen::Index> place_;
  /// 1/√M_kk.
  Eigen::VectorXd scale_;
};

}  // namespace sampled_data_observers
