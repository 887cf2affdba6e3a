#pragma once

#include <Eigen/Core>
#include <vector>

#include "certificate/flow_growth.h"
#include "sampled_data_observers/plant/linear_flow.h"

namespace sampled_data_observers {

/// The errors e = e^{Aτ} Σ_i r_i X_i z_i with |z_i| <= 1, which a bound makes of what it knew τ
/// before: how large each entry is, and an ellipsoid around them. Both are computed where they are
/// asked for, in the coordinates of FlowGrowth, with room for rounding; not finite where that
/// overflows. Allocates nothing once it is built, and sums in a fixed order.
class FlownErrors {
 public:
  /// One of the X_i, by its position, and its r_i >= 0.
  struct Ball {
    std::size_t shape = 0;
    double radius = 0.0;
  };
  /// At most so many at a time.
  static constexpr std::size_t kMostBalls = 2;
  struct Balls {
    Ball first;
    Ball second = {};  ///< of radius 0 where there is none
  };

  /// X_i, n x k_i, and by how much each of its entries is off at most.
  struct Shape {
    Eigen::MatrixXd X;
    Eigen::MatrixXd rounding;
  };

  /// @param growth  of A
  FlownErrors(const Eigen::MatrixXd& A, const FlowGrowth& growth, const std::vector<Shape>& shapes);

  /// Number of entries needed in `workspace`.
  Eigen::Index workspace_size() const;

  /// Bounds on |e_j|. @param tau  τ >= 0 [s] @param bounds  n, is written
  void bounds(double tau, const Balls& balls, double* workspace,
              Eigen::Ref<Eigen::VectorXd> bounds) const;

  /// Q with e eᵀ <= Q. @param Q  n x n, symmetric, is written
  void ellipsoid(double tau, const Balls& balls, double* workspace,
                 Eigen::Ref<Eigen::MatrixXd> Q) const;

 private:
  struct Start {
    Eigen::MatrixXd WX;
    double size = 0.0;      ///< its norm, at most
    double rounding = 0.0;  ///< that of what was lost of it
  };
  struct Parts;

  Parts flown(double tau, const Balls& balls, double* workspace) const;
  double lost(const Parts& parts, Eigen::Index row) const;

  Eigen::Index n_;
  Eigen::Index most_columns_ = 0;
  double rate_;
  double stiffness_;           ///< of what the flow loses, per second
  LinearFlow flow_;            ///< of W A W⁻¹
  Eigen::MatrixXd inverse_W_;  ///< n x n
  Eigen::VectorXd rows_;       ///< norms of its rows
  Eigen::VectorXd inexact_;    ///< and of what was lost of them
  std::vector<Start> starts_;
};

/// R⁻¹ and by how much each of its entries is off at most.
FlownErrors::Shape inverse_with_rounding(const Eigen::MatrixXd& R);

/// M X likewise, by how much each entry of M is off at most being `rounding`.
FlownErrors::Shape product_with_rounding(const Eigen::MatrixXd& M, const Eigen::MatrixXd& rounding,
                                         const FlownErrors::Shape& X);

}  // namespace sampled_data_observers
