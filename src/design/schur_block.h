#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "design/sdp_data.h"

namespace sampled_data_observers {

/// What one block contributes to the matrix of an interior point method: tr(F_k Z F_j S⁻¹) for its
/// variables. Each F_k is written as a sum of few u vᵀ + v uᵀ, with unit vectors u and vectors v of
/// which many F_k have the same: the rows of A where the block has He(P A). Then an entry needs but
/// some of the numbers uᵀ Z v and uᵀ S⁻¹ v. Where that is no saving, F_j is multiplied out.
class SchurBlock {
 public:
  /// @param places  of its variables among rows and columns of the matrix
  SchurBlock(const SdpBlock& block, std::vector<Eigen::Index> places);

  /// Symmetric.
  /// @param S_inverse,Z  symmetric
  Eigen::MatrixXd matrix(const Eigen::MatrixXd& S_inverse, const Eigen::MatrixXd& Z) const;

 private:
  /// coefficient (u vᵀ + v uᵀ), by the numbers of the vectors.
  struct Term {
    Eigen::Index u = 0;
    Eigen::Index v = 0;
    double coefficient = 0.0;
  };
  using SparseVector = std::vector<std::pair<Eigen::Index, double>>;

  void add_terms(std::size_t i, std::map<SparseVector, Eigen::Index>& numbers);
  Eigen::MatrixXd products(const Eigen::MatrixXd& matrix) const;
  void multiply_out(std::size_t i, const Eigen::MatrixXd& S_inverse, const Eigen::MatrixXd& Z,
                    Eigen::MatrixXd& Z_F, Eigen::MatrixXd& U) const;

  const SdpBlock& block_;
  std::vector<Eigen::Index> places_;
  /// Vectors beside the unit ones, which have the first numbers.
  std::vector<SparseVector> vectors_;
  /// Of variables[i]: from first_[i] on, up to first_[i + 1].
  std::vector<Term> terms_;
  std::vector<std::size_t> first_;
  /// Of the variables, those with the most terms first, and whether each is multiplied out.
  std::vector<std::size_t> order_;
  std::vector<bool> is_multiplied_out_;
  bool needs_products_ = false;
};

}  // namespace sampled_data_observers
