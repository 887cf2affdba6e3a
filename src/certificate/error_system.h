#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "certificate/certificate.h"
#include "certificate/matrix_expression.h"
#include "linear_algebra/tensor_grid.h"

namespace sampled_data_observers {

/// What an event of one timer does to the error e of an observer: it is a sample of a sensor, or a
/// jump of the plant.
///   e⁺ = (J − K C) e − K η
struct ErrorReset {
  std::string name;          ///< of the sensor, or "jumps"
  std::size_t position = 0;  ///< of a sensor among those of the plant
  Eigen::MatrixXd J;         ///< N x N: the identity, or the plant's jump map
  Eigen::MatrixXd C;         ///< m x N
  /// N x m, at a node of the grid of timers before the event (ScheduledGain); the same at all of
  /// them where the gain is constant.
  std::function<MatrixExpression(std::size_t node)> K;
  bool is_constant = true;
  /// m x m, of gains that are not constant at nodes at which the timer is 0, where another event
  /// may follow at once: P K = Cᵀ Z. None where T1 > 0.
  std::function<MatrixExpression(std::size_t node)> Z = nullptr;
};

/// The error of an observer as a hybrid system that is linear between events up to a nonlinearity:
///   ė = F e + G φ + N w, |φ| <= ℓ |S e|, y_p = C_p e
/// The first entries of e are x − x̂, what follows is what the observer injects.
struct ErrorSystem {
  Eigen::Index states = 0;          ///< n, of the plant
  Eigen::Index size = 0;            ///< N >= n, of e
  std::vector<MatrixExpression> F;  ///< N x N each: F is in their convex hull
  Eigen::MatrixXd G;                ///< N x s; no columns where F says all
  Eigen::MatrixXd S;                ///< q x N
  double lipschitz_constant = 0.0;  ///< ℓ
  Eigen::MatrixXd N;                ///< N x n_w; no columns without disturbance
  Eigen::MatrixXd C_p;              ///< n_p x N
  std::vector<ErrorReset> resets;   ///< of each timer
  std::string mode;                 ///< of a plant that switches, its label

  bool is_linear() const { return G.cols() == 0; }
};

/// Whether a node is one of a sensor with T1 = 0 at which its timer is 0, so that a gain that is
/// interpolated between nodes is given there by its Z.
bool has_Z(const CertificateSubject& subject, const TensorGrid& grid, std::size_t sensor,
           std::size_t node);

/// What the linear part of the plant's own flow is in the convex hull of, n x n each: A, the flow's
/// vertices, or A + Ψ_v with each vertex of the nonlinearity, formulas since the sum of doubles is
/// rounded.
std::vector<MatrixExpression> plant_flows(const PlantMatrices& plant);

/// "L", or "L/gps" where there are several sensors.
std::string gain_of_sensor(const std::string& symbol, const CertificateSubject& subject,
                           std::size_t sensor);

// Of the observers whose gains a Lyapunov function that depends on timers can prove. Where the
// plant has vertices of its nonlinearity, F has them, and G no columns.

/// x̂⁺ = x̂ + L_i (y_i − C_i x̂): e = x − x̂, gains L (n x m_i).
ErrorSystem constant_gain_error(const CertificateSubject& subject);

/// The same with gains that are interpolated between nodes of the timers: gains K/SENSOR/NODE, or
/// Z/SENSOR/NODE at the nodes of has_Z().
ErrorSystem scheduled_gain_error(const CertificateSubject& subject);

/// x̂' = f + Σ L_i θ_i, θ̇_i = H_i θ_i, θ_i⁺ = y_i − C_i x̂: e = (x − x̂, θ), gains L and H.
ErrorSystem injection_error(const CertificateSubject& subject);

/// x̂' = f − Σ L_i θ_i with the held θ_i⁺ = y_i − C_i x̂: e = (x − x̂, θ), gains L.
ErrorSystem held_injection_error(const CertificateSubject& subject);

/// x̂' = f + L_c (y_c − C_c x̂), x̂⁺ = A_d x̂ + L_d (y_d − C_d x̂) at jumps: e = x − x̂, gains L_c and
/// L_d, each where its output is.
ErrorSystem synchronized_error(const CertificateSubject& subject);

/// The same in one mode of a plant that switches, with gains of that mode, L_c/MODE and L_d/MODE.
/// @param mode  its position
ErrorSystem switched_error(const CertificateSubject& subject, std::size_t mode);

}  // namespace sampled_data_observers
