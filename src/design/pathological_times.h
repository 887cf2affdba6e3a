#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "certificate/certificate.h"

namespace sampled_data_observers {

/// What one sampled sensor measures, and when.
struct SampledSensor {
  Eigen::MatrixXd C;    ///< m x n
  SamplingTimes times;  ///< [s]
};

/// Constant times between the samples of each of several sensors at which all of them together show
/// less than the flow: two of its modes look the same to each. Each sensor may begin at any time,
/// and begins at the worst.
struct PathologicalTimes {
  /// [s], one for each sensor: the least that is so; nothing where the sensor shows neither mode,
  /// so that its times don't matter.
  std::vector<std::optional<double>> tau;
  /// What is unseen then is a combination of these columns, in the states of the plant.
  Eigen::MatrixXd directions;
  /// Whether it decays.
  bool decays = false;
};

/// All of them inside the times of the sensors, of pairs of modes with simple eigenvalues λ, μ of
/// equal real part. A sensor tells them apart at all times where its rows show v e^{λt} and w
/// e^{μt}, v and w the eigenvectors, by independent columns C v, C w. Else C w = ρ C v, and at
/// multiples of τ = 2π / |Im(λ − μ)| from a time s on nothing is seen of a v + b w with a = −b ρ
/// e^{(μ−λ)s}: of one such, for sensors of equal |ρ|. For conjugate λ and μ, |ρ| is 1 for all
/// sensors.
std::vector<PathologicalTimes> pathological_times_of_sensors(
    const Eigen::MatrixXd& A, const std::vector<SampledSensor>& sensors);

}  // namespace sampled_data_observers
