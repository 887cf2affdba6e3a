#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "observer/metric_gain.h"
#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// The gains of a SwitchedObserver, one entry per mode of the plant in its order; each kind may be
/// left out (empty), but not all.
struct SwitchedGains {
  /// Flow-based: per mode one n x m_i gain per sensor; of sensors that are not continuous, empty.
  std::vector<std::vector<Eigen::MatrixXd>> L_c;
  /// Jump-based: per mode one map of τ [s] per sensor to the n x m_i entries of L_d(τ), row by row;
  /// of sensors that do not measure at jumps, null.
  std::vector<std::vector<std::shared_ptr<const VectorMap>>> L_d;
  /// Jump-based, in place of L_d: per mode the metric P_q (n x n) from which L_d(τ) follows
  /// (MetricGain).
  std::vector<Eigen::MatrixXd> metrics;
  /// Projection: the metric P_q (n x n) of the modes that have one.
  std::vector<std::optional<Eigen::MatrixXd>> P;
};

/// @throws std::invalid_argument for a plant without modes or with one that is not affine, gains
/// that do not fit, and sensors that no gain uses.
void check_switched_gains(const SwitchedGains& gains, const Plant& plant);

/// The gains of all modes, for the stacked outputs at jumps; none where there are no metrics.
/// @throws std::invalid_argument for a metric that is not symmetric positive definite, and outputs
/// of a mode at jumps that are dependent.
std::vector<MetricGain> make_metric_gains(SwitchedGains& gains, const Plant& plant);

/// P⁻¹ Hᵀ (H P⁻¹ Hᵀ)⁻¹, the gain that projects x̂ on the outputs H of a mode; empty without outputs.
/// @param where  " of mode …", for messages
/// @throws std::invalid_argument for outputs that depend on each other
Eigen::MatrixXd projection_gain(const Eigen::MatrixXd& P, const Eigen::MatrixXd& H,
                                const std::string& where);

/// Those for the outputs of each timing; empty where there are none or no metric.
struct Projection {
  Eigen::MatrixXd at_jumps;
  Eigen::MatrixXd continuous;
};

/// One per mode, where some mode has a metric; else none.
/// @throws std::invalid_argument for a metric that is not symmetric positive definite or belongs to
/// a mode with a jump map, and dependent outputs of a mode to project on.
std::vector<Projection> make_projections(const SwitchedGains& gains, const Plant& plant);

}  // namespace sampled_data_observers
