#include "config/contraction_check.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "config/number_text.h"
#include "linear_algebra/matrix_functions.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int kConstantTimes = 17;
/// Of these, all pairs alternate.
constexpr int kPairedTimes = 5;
/// Of a switched plant, among which all pairs alternate.
constexpr std::size_t kMostModes = 4;
/// Cycles until a gain that has a memory, as a Kalman filter's, has settled.
constexpr int kSettling = 100;
/// Of times without end.
constexpr Duration kLongestLookedAt = 1000000 * kNanosecondsPerSecond;
/// A double eigenvalue of modulus 1 is computed as one that is larger by up to 1e-8.
constexpr double kGrowth = 1.0 + 1e-6;

/// A time, and the event after it: all samples, or a jump into a mode.
struct Interval {
  Duration time = 0;
  std::size_t next_mode = 0;
};
using Cycle = std::vector<Interval>;

/// The map of an observer's error over cycles of samples, or of jumps of a plant without.
class ErrorMap {
 public:
  ErrorMap(const PlantObserver& law, const Plant& plant)
      : law_(law),
        plant_(plant),
        state_(law.state_size()),
        workspace_(law.workspace_size()),
        y_(std::max(plant.max_outputs(), plant.outputs(SensorTiming::kAtJumps))),
        u_(Vector::Zero(plant.inputs())) {}

  /// After many such cycles: the map of the flowing part over one.
  Matrix over(const Cycle& cycle) {
    const Eigen::Index size = law_.flow_size();
    law_.initialize(state_.data());
    law_.keep_mode(cycle.back().next_mode, state_.data());
    for (int count = 0; count < kSettling; ++count) {
      for (const Interval& interval : cycle) step(interval, nullptr);
    }
    Matrix map = Matrix::Identity(size, size);
    for (const Interval& interval : cycle) {
      Matrix next(size, size);
      step(interval, &next);
      map = next * map;
    }
    return map;
  }

 private:
  /// One interval and its event, from a flowing part of zero and, where a map is asked for, from
  /// each unit vector. What is measured is that of an estimate without error.
  void step(const Interval& interval, Matrix* map) {
    const Eigen::Index size = law_.flow_size();
    state_.head(size).setZero();
    const Vector before = state_;
    law_.flow(interval.time, state_.data(), workspace_.data());
    const Vector reference = state_;
    take_event(reference, interval);
    if (map == nullptr) return;
    const Vector after = state_;
    for (Eigen::Index j = 0; j < size; ++j) {
      state_ = before;
      state_(j) = kPerturbation;
      law_.flow(interval.time, state_.data(), workspace_.data());
      take_event(reference, interval);
      map->col(j) = (state_ - after).head(size) / kPerturbation;
    }
    state_ = after;
  }

  void take_event(const Vector& reference, const Interval& interval) {
    if (plant_.jumps()) {
      take_jump(reference, interval.next_mode);
    } else {
      take_samples(reference);
    }
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

  void take_jump(const Vector& reference, std::size_t next_mode) {
    const std::size_t mode = law_.mode_of(reference.data());
    Event jump;
    jump.stamp = 1;
    jump.kind = EventKind::kJump;
    jump.values = y_.data();
    if (plant_.switches()) jump.mode = plant_.modes()[next_mode].label;
    for (std::size_t i = 0; i < plant_.sensors().size(); ++i) {
      const Sensor& sensor = plant_.sensors()[i];
      if (sensor.timing != SensorTiming::kAtJumps) continue;
      plant_.modes()[mode].outputs[i]->evaluate(reference.data(), u_.data(), y_.data() + jump.size);
      jump.size += sensor.outputs();
    }
    law_.reset(jump, state_.data(), workspace_.data());
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
  const Duration longest = std::min(sampling.T2, std::max(sampling.T1, kLongestLookedAt));
  std::vector<Duration> times;
  for (int i = 0; i < points; ++i) {
    times.push_back(sampling.T1 + (longest - sampling.T1) * i / (points - 1));
  }
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

std::string describe(const Plant& plant, const Cycle& cycle, double growth) {
  const std::string events = plant.jumps() ? "jumps" : "samples";
  const auto after = [&](const Interval& interval) {
    std::string text = number_text(to_seconds(interval.time), 4) + " s";
    if (plant.switches()) {
      text += " (then mode " + std::to_string(plant.modes()[interval.next_mode].label) + ")";
    }
    return text;
  };
  std::string text = "with " + events;
  if (cycle.size() > 1) {
    text += " " + after(cycle[0]) + " and " + after(cycle[1]) + " apart by turns";
  } else {
    text += " every " + after(cycle[0]);
  }
  return text + ", inside of [T1, T2], the error grows by the factor " + number_text(growth, 4) +
         " from " + (plant.jumps() ? "jump to jump" : "sample to sample") +
         ": the estimate diverges; compare the signs and sizes of the gains "
         "with the observer's equations, and make gains with 'design synthesize'";
}

/// Constant times and pairs that alternate; for a plant that switches, pairs of modes.
std::vector<Cycle> cycles_of(const Plant& plant, const SamplingBounds& sampling) {
  std::vector<Cycle> cycles;
  const std::vector<Duration> few = grid(sampling, kPairedTimes);
  const std::size_t modes = std::min(plant.modes().size(), kMostModes);
  for (std::size_t first = 0; first < modes; ++first) {
    for (std::size_t second = first + 1; second < modes; ++second) {
      for (const Duration a : few) {
        for (const Duration b : few) cycles.push_back({{a, second}, {b, first}});
      }
    }
  }
  if (plant.switches()) return cycles;
  for (const Duration time : grid(sampling, kConstantTimes)) cycles.push_back({{time, 0}});
  for (std::size_t i = 0; i < few.size(); ++i) {
    for (std::size_t j = i + 1; j < few.size(); ++j) cycles.push_back({{few[i], 0}, {few[j], 0}});
  }
  return cycles;
}

/// Whether [T1, T2] are the times between all events that correct the estimate.
bool has_one_kind_of_event(const Plant& plant) {
  const bool is_sampled = plant.outputs(SensorTiming::kSampled) > 0;
  if (!plant.jumps()) return is_sampled;
  return !is_sampled && plant.outputs(SensorTiming::kAtJumps) > 0 &&
         plant.outputs(SensorTiming::kContinuous) == 0;
}

}  // namespace

std::string find_divergence(const ObserverLaw& law, const Plant& plant,
                            const SamplingBounds& sampling) {
  const auto* observer = dynamic_cast<const PlantObserver*>(&law);
  if (observer == nullptr || observer->flow_step() != 0 || !plant.is_affine() ||
      !has_one_kind_of_event(plant)) {
    return "";
  }
  ErrorMap error(*observer, plant);
  double worst = kGrowth;
  std::string found;
  for (const Cycle& cycle : cycles_of(plant, sampling)) {
    const Matrix map = error.over(cycle);
    if (!map.allFinite()) continue;  // over so long a time that it says nothing of the gains
    const double radius = eigenvalues_of(map).cwiseAbs().maxCoeff();
    const double growth = std::pow(radius, 1.0 / static_cast<double>(cycle.size()));
    if (!(growth > worst)) continue;
    worst = growth;
    found = describe(plant, cycle, growth);
  }
  return found;
}

}  // namespace sampled_data_observers
