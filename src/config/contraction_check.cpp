#include "sampled_data_observers/config/contraction_check.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "number_text.h"
#include "sampled_data_observers/certificate/matrix_functions.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int kConstantTimes = 17;
/// Of these, all pairs alternate.
constexpr int kPairedTimes = 5;
/// Cycles until a gain that has a memory, as a Kalman filter's, has settled.
constexpr int kSettling = 100;
/// A double eigenvalue of modulus 1 is computed as one that is larger by up to 1e-8.
constexpr double kGrowth = 1.0 + 1e-6;

/// The map of an observer's error over cycles of samples.
class ErrorMap {
 public:
  ErrorMap(const PlantObserver& law, const Plant& plant)
      : law_(law),
        plant_(plant),
        state_(law.state_size()),
        workspace_(law.workspace_size()),
        y_(plant.max_outputs()),
        u_(Vector::Zero(plant.inputs())) {}

  /// After many cycles of these times between samples: the map of the flowing part over one.
  Matrix over(const std::vector<Duration>& times) {
    const Eigen::Index size = law_.flow_size();
    law_.initialize(state_.data());
    for (int cycle = 0; cycle < kSettling; ++cycle) {
      for (const Duration time : times) step(time, nullptr);
    }
    Matrix map = Matrix::Identity(size, size);
    for (const Duration time : times) {
      Matrix next(size, size);
      step(time, &next);
      map = next * map;
    }
    return map;
  }

 private:
  /// One time between samples and the samples after it, from a flowing part of zero and, where a
  /// map is asked for, from each unit vector. The samples are those of an estimate without error.
  void step(Duration time, Matrix* map) {
    const Eigen::Index size = law_.flow_size();
    state_.head(size).setZero();
    const Vector before = state_;
    law_.flow(time, state_.data(), workspace_.data());
    const Vector reference = state_;
    take_samples(reference);
    if (map == nullptr) return;
    const Vector after = state_;
    for (Eigen::Index j = 0; j < size; ++j) {
      state_ = before;
      state_(j) = kPerturbation;
      law_.flow(time, state_.data(), workspace_.data());
      take_samples(reference);
      map->col(j) = (state_ - after).head(size) / kPerturbation;
    }
    state_ = after;
  }

  void take_samples(const Vector& reference) {
    for (std::size_t i = 0; i < plant_.sensors().size(); ++i) {
      const Sensor& sensor = plant_.sensors()[i];
      if (sensor.timing != SensorTiming::kSampled) continue;
      plant_.modes().front().outputs[i]->evaluate(reference.data(), u_.data(), y_.data());
      const Event sample{1,         EventKind::kSample, static_cast<int>(i),
                         y_.data(), sensor.outputs(),   0};
      law_.reset(sample, state_.data(), workspace_.data());
    }
  }

  /// So small that no angle is wrapped.
  static constexpr double kPerturbation = 1e-3;

  const PlantObserver& law_;
  const Plant& plant_;
  Vector state_;
  Vector workspace_;
  Vector y_;
  Vector u_;
};

std::vector<Duration> grid(const SamplingBounds& sampling, int points) {
  std::vector<Duration> times;
  for (int i = 0; i < points; ++i) {
    times.push_back(sampling.T1 + (sampling.T2 - sampling.T1) * i / (points - 1));
  }
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

std::string describe(const std::vector<Duration>& times, double growth) {
  std::string text = "with samples every " + number_text(to_seconds(times.front()), 4) + " s";
  if (times.size() > 1) {
    text = "with samples " + number_text(to_seconds(times[0]), 4) + " s and " +
           number_text(to_seconds(times[1]), 4) + " s apart by turns";
  }
  return text + ", inside of [T1, T2], the error grows by the factor " + number_text(growth, 4) +
         " from sample to sample: the estimate diverges; compare the signs and sizes of the gains "
         "with the observer's equations, and make gains with 'design synthesize'";
}

}  // namespace

std::string find_divergence(const ObserverLaw& law, const Plant& plant,
                            const SamplingBounds& sampling) {
  const auto* observer = dynamic_cast<const PlantObserver*>(&law);
  if (observer == nullptr || observer->flow_step() != 0 || !plant.is_affine() || plant.jumps() ||
      plant.outputs(SensorTiming::kSampled) == 0) {
    return "";
  }
  std::vector<std::vector<Duration>> cycles;
  for (const Duration time : grid(sampling, kConstantTimes)) cycles.push_back({time});
  const std::vector<Duration> ends = grid(sampling, kPairedTimes);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (std::size_t j = i + 1; j < ends.size(); ++j) cycles.push_back({ends[i], ends[j]});
  }
  ErrorMap error(*observer, plant);
  double worst = kGrowth;
  std::string found;
  for (const std::vector<Duration>& times : cycles) {
    const Matrix map = error.over(times);
    if (!map.allFinite()) continue;  // over so long a time that it says nothing of the gains
    const double radius = eigenvalues_of(map).cwiseAbs().maxCoeff();
    const double growth = std::pow(radius, 1.0 / static_cast<double>(times.size()));
    if (!(growth > worst)) continue;
    worst = growth;
    found = describe(times, growth);
  }
  return found;
}

}  // namespace sampled_data_observers
