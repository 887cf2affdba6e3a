#pragma once

#include <Eigen/Core>
#include <vector>

#include "linear_algebra/tensor_grid.h"
#include "sampled_data_observers/hybrid/state_layout.h"
#include "sampled_data_observers/observer/law_gains.h"
#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// What a ScheduledGain is interpolated from: values at the nodes of the tensor grid over the times
/// since the sensors' last samples, numbered as TensorGrid has it, with the sensors in the plant's
/// order.
struct ScheduledGains {
  /// For each sensor the nodes of its time [s]: 0 first, increasing.
  std::vector<std::vector<double>> timers;
  /// For each node, n x n, symmetric positive definite.
  std::vector<Eigen::MatrixXd> P;
  /// For each sensor i and each node, n x m_i; empty where Z has one.
  std::vector<std::vector<Eigen::MatrixXd>> K;
  /// For each sensor i, of a linear output y = C_i x + b, and each node k with τ_i = 0 where it
  /// stands for the gain: m_i x m_i, P_k K_i,k = C_iᵀ Z_i,k. Empty at others, or all.
  std::vector<std::vector<Eigen::MatrixXd>> Z = {};
};

/// Gains K_i(τ) of sampled sensors that depend on the times τ since the last sample of each sensor,
/// each taken as its last node where it is longer. With the multi-affine weights w_k(τ) of the
/// vertices k of the cell that τ lies in, and k° the node k with τ_i = 0:
///
///   K_i(τ) = (Σ w_k P_k°)⁻¹ Σ w_k P_k° K_i,k
///
/// It is the mean of the gains at the vertices in the metric of P just after the sample, and at a
/// node the gain given there. With V = eᵀ P(τ) e of the error e, P(τ) = Σ w_k P_k, it makes linear
/// conditions for V to fall at a sample multi-affine in τ: they hold everywhere where they hold at
/// the nodes. With one sensor it is piecewise linear in τ. Where samples of a sensor may follow one
/// another at once, V just after the second is V just before it in all directions that are not
/// measured: gains P_k⁻¹ C_iᵀ Z_i,k make that so for any numbers.
///
/// Immutable; evaluate() allocates nothing and throws nothing.
class ScheduledGain {
 public:
  /// @throws std::invalid_argument saying which of the gains does not fit the plant, is not finite,
  /// or is no such P: scaled to a unit diagonal its least eigenvalue must be above 1e-11, with
  /// which K_i(τ) can be computed for every τ.
  ScheduledGain(ScheduledGains gains, const Plant& plant);

  const TensorGrid& grid() const { return grid_; }

  /// Number of entries that evaluate() needs in `workspace`.
  Eigen::Index workspace_size() const { return workspace_.size(); }

  /// K ← K_i(τ), n x m_i.
  /// @param tau  one per sensor [s], >= 0
  void evaluate(std::size_t sensor, const double* tau, double* K, double* workspace) const;

  /// Adds timers/SENSOR (its nodes, 1 x N), P/k, and K/SENSOR/k or Z/SENSOR/k to a law's gains.
  void list(const Plant& plant, LawGains* gains) const;

 private:
  Eigen::MatrixXd product_of_Z(const Plant& plant, std::size_t sensor, std::size_t node,
                               Eigen::MatrixXd& K) const;

  TensorGrid grid_;
  Eigen::Index n_;
  std::vector<Eigen::MatrixXd> P_;                ///< P_k, symmetric to the bit
  std::vector<std::vector<Eigen::MatrixXd>> K_;   ///< K_i,k
  std::vector<std::vector<Eigen::MatrixXd>> PK_;  ///< P_k° K_i,k
  std::vector<std::vector<Eigen::MatrixXd>> Z_;   ///< as ScheduledGains has it

  StateLayout workspace_;
  VectorSlot metric_;      ///< Σ w_k P_k°
  VectorSlot correction_;  ///< of the plain mean of the gains
  VectorSlot product_;
};

}  // namespace sampled_data_observers
