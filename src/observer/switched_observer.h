#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {

/// The gains of a SwitchedObserver, one entry per mode of the plant in its order; each kind may be
/// left out (empty), but not all.
struct SwitchedGains {
  /// Flow-based: per mode one n x m_i gain per sensor; of sensors that are not continuous, empty.
  std::vector<std::vector<Eigen::MatrixXd>> L_c;
  /// Jump-based: per mode one map of τ [s] per sensor to the n x m_i entries of L_d(τ), row by row;
  /// of sensors that do not measure at jumps, null.
  std::vector<std::vector<std::shared_ptr<const VectorMap>>> L_d;
  /// Projection: the metric P_q (n x n) of the modes that have one.
  std::vector<std::optional<Eigen::MatrixXd>> P;
};

/// Observers of a switched plant with affine modes and known mode q (bernard2022, section 7.3):
///
///   ẋ̂ = A_q x̂ + B_q u + b_q + L_c,q (y_c − H_q x̂)     in mode q
///   x̂⁺ = A_d,q x̂ + b_d,q + L_d,q(τ) (y_d − H_q x̂)      at a switch that leaves mode q
///
/// with τ the time since the switch before, or the start. Where mode q has a metric and its jump
/// map is the identity, x̂ is first projected along the metric onto the states with the measured
/// output y (that at the switch where the plant has sensors for it, else the continuous one):
///
///   x̂ ← x̂ + P_q⁻¹ H_qᵀ (H_q P_q⁻¹ H_qᵀ)⁻¹ (y − H_q x̂)
///
/// so that (x − x̂)ᵀ P_q (x − x̂) does not grow. Outputs that are not known correct nothing. Those of
/// continuous sensors are held between their stamps. The innovation of angular outputs is wrapped.
class SwitchedObserver final : public PlantObserver {
 public:
  /// @throws std::invalid_argument for a plant without modes or with one that is not affine, gains
  /// that do not fit, a metric that is not symmetric positive definite or belongs to a mode with a
  /// jump map, dependent outputs of a mode to project on, and sensors that no gain uses.
  SwitchedObserver(const ObserverContext& context, SwitchedGains gains);

  /// Of each mode q: L_c/q/sensor, L_d/q/sensor and projection/q.
  LawGains gains() const override;

 protected:
  bool flow_is_affine() const override;
  void derivative(const Held& held, const double* s, double* ds, double* workspace) const override;
  void jump(const Held& held, std::size_t next, const JumpOutputs& outputs, double* state,
            double* workspace) const override;

 private:
  /// P⁻¹ Hᵀ (H P⁻¹ Hᵀ)⁻¹ for the outputs of one timing; empty where there are none or no metric.
  struct Projection {
    Eigen::MatrixXd at_jumps;
    Eigen::MatrixXd continuous;
  };

  void check() const;
  Projection make_projection(std::size_t mode) const;
  /// x̂ projected onto the outputs known
  void project(const Held& held, const JumpOutputs& outputs, double* state, double* scratch) const;
  /// correction ← L_d(τ) (y_d − H x̂)
  void compute_correction(const Held& held, const JumpOutputs& outputs, const double* state,
                          double* correction, double* scratch) const;
  bool all_known(const JumpOutputs& outputs) const;

  SwitchedGains gains_;
  std::vector<Projection> projections_;
};

}  // namespace sampled_data_observers
