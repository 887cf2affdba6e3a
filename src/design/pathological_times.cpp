#include "design/pathological_times.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "design/observability.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

using Complex = std::complex<double>;

/// What is smaller than this, relative to what it is computed from, is zero but for rounding.
constexpr double kZeroShown = 1e-9;

struct SimpleMode {
  Complex eigenvalue;
  Eigen::VectorXcd vector;     ///< of norm 1
  std::size_t of_mode = 0;     ///< the same for both of a conjugate pair
  Eigen::MatrixXd directions;  ///< that it moves: orthonormal columns
};

/// Both of each conjugate pair.
std::vector<SimpleMode> simple_modes(const Eigen::MatrixXd& A) {
  std::vector<SimpleMode> result;
  const std::vector<Mode> modes = modes_of(A);
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const Mode& mode = modes[i];
    const Eigen::MatrixXd& D = mode.directions;
    const double b = mode.eigenvalue.imag();
    if (D.cols() != (b == 0.0 ? 1 : 2)) continue;
    if (b == 0.0) {
      result.push_back({mode.eigenvalue, D.col(0).cast<Complex>(), i, D});
      continue;
    }
    const Eigen::MatrixXd M = D.transpose() * A * D;
    Eigen::VectorXcd v =
        D.col(0).cast<Complex>() * M(0, 1) + D.col(1).cast<Complex>() * (mode.eigenvalue - M(0, 0));
    v /= v.norm();
    result.push_back({mode.eigenvalue, v, i, D});
    result.push_back({std::conj(mode.eigenvalue), v.conjugate(), i, D});
  }
  return result;
}

/// What a sensor shows of two modes.
struct Sight {
  bool tells_apart = false;
  bool shows_first = false;
  bool shows_second = false;
  double ratio = 0.0;  ///< |ρ|
};

Sight sight_of(const Eigen::MatrixXd& C, const SimpleMode& first, const SimpleMode& second) {
  const double zero = kZeroShown * norm2(C);
  const Eigen::VectorXcd v = C * first.vector;
  const Eigen::VectorXcd w = C * second.vector;
  Sight sight;
  sight.shows_first = v.norm() > zero;
  sight.shows_second = w.norm() > zero;
  if (!sight.shows_first || !sight.shows_second) return sight;
  const Complex along = v.dot(w) / v.squaredNorm();
  sight.tells_apart = (w - along * v).norm() > kZeroShown * w.norm();
  sight.ratio = w.norm() / v.norm();
  return sight;
}

/// The least multiple of `beat` inside of the times; nothing where there is none.
std::optional<double> least_multiple(double beat, const SamplingTimes& times) {
  const double least = std::max(1.0, std::ceil(times.T1 / beat * (1.0 - kZeroShown)));
  const double tau = least * beat;
  if (tau > times.T2 * (1.0 + kZeroShown)) return std::nullopt;
  return tau;
}

/// Nothing where the sensors together tell the two modes apart at all of their times.
std::optional<PathologicalTimes> times_of_pair(const SimpleMode& first, const SimpleMode& second,
                                               const std::vector<SampledSensor>& sensors) {
  const double beat =
      2.0 * std::acos(-1.0) / std::abs(first.eigenvalue.imag() - second.eigenvalue.imag());
  PathologicalTimes found;
  found.decays = first.eigenvalue.real() < 0.0;
  std::optional<double> ratio;
  for (const SampledSensor& sensor : sensors) {
    const Sight sight = sight_of(sensor.C, first, second);
    if (!sight.shows_first && !sight.shows_second) {
      found.tau.emplace_back();
      continue;
    }
    // What such a sensor does not see is no combination of both.
    if (!sight.shows_first || !sight.shows_second || sight.tells_apart) return std::nullopt;
    if (std::abs(ratio.value_or(sight.ratio) - sight.ratio) > kZeroShown * sight.ratio) {
      return std::nullopt;
    }
    ratio = sight.ratio;
    found.tau.push_back(least_multiple(beat, sensor.times));
    if (!found.tau.back()) return std::nullopt;
  }
  if (!ratio) return std::nullopt;
  found.directions = first.directions;
  if (first.of_mode == second.of_mode) return found;
  found.directions.conservativeResize(Eigen::NoChange,
                                      first.directions.cols() + second.directions.cols());
  found.directions.rightCols(second.directions.cols()) = second.directions;
  return found;
}

}  // namespace

std::vector<PathologicalTimes> pathological_times_of_sensors(
    const Eigen::MatrixXd& A, const std::vector<SampledSensor>& sensors) {
  const double same = kZeroShown * norm2(A);
  const std::vector<SimpleMode> modes = simple_modes(A);
  std::vector<PathologicalTimes> all;
  for (std::size_t i = 0; i < modes.size(); ++i) {
    for (std::size_t j = i + 1; j < modes.size(); ++j) {
      const Complex difference = modes[i].eigenvalue - modes[j].eigenvalue;
      if (std::abs(difference.real()) > same || std::abs(difference.imag()) <= same) continue;
      // Their conjugates are another pair that looks the same at the same times.
      if (modes[i].eigenvalue.imag() + modes[j].eigenvalue.imag() < -same) continue;
      if (auto found = times_of_pair(modes[i], modes[j], sensors)) all.push_back(std::move(*found));
    }
  }
  return all;
}

}  // namespace sampled_data_observers
