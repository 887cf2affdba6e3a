#include "config/contraction_check.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
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
/// Of another sensor between two samples of the one that is sampled least often.
constexpr Duration kMostBetween = 16;
/// Of times without end.
constexpr Duration kLongestLookedAt = 1000000 * kNanosecondsPerSecond;
/// A double eigenvalue of modulus 1 is computed as one that is larger by up to 1e-8.
constexpr double kGrowth = 1.0 + 1e-6;

/// A time, and the event after it: samples of some sensors, or a jump into a mode.
struct Interval {
  Duration time = 0;
  std::size_t next_mode = 0;
  std::vector<std::size_t> sensors = {};
};

/// What comes again and again.
struct Cycle {
  std::vector<Interval> intervals;
  /// Those that it is told by: between jumps, all samples, or samples of the leading sensor.
  std::vector<Duration> told = {};
};

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
    law_.keep_mode(cycle.intervals.back().next_mode, state_.data());
    for (int count = 0; count < kSettling; ++count) {
      for (const Interval& interval : cycle.intervals) step(interval, nullptr);
    }
    Matrix map = Matrix::Identity(size, size);
    for (const Interval& interval : cycle.intervals) {
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
      take_samples(reference, interval.sensors);
    }
  }

  void take_samples(const Vector& reference, const std::vector<std::size_t>& sensors) {
    for (const std::size_t i : sensors) {
      const Sensor& sensor = plant_.sensors()[i];
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

std::vector<Duration> grid(const SamplingBounds& bounds, int points) {
  const Duration longest = std::min(bounds.T2, std::max(bounds.T1, kLongestLookedAt));
  std::vector<Duration> times;
  for (int i = 0; i < points; ++i) {
    times.push_back(bounds.T1 + (longest - bounds.T1) * i / (points - 1));
  }
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

/// Of a switched plant: pairs of modes, by turns, with pairs of times.
std::vector<Cycle> cycles_of_modes(const Plant& plant, const SamplingBounds& bounds) {
  std::vector<Cycle> cycles;
  const std::vector<Duration> few = grid(bounds, kPairedTimes);
  const std::size_t modes = std::min(plant.modes().size(), kMostModes);
  for (std::size_t first = 0; first < modes; ++first) {
    for (std::size_t second = first + 1; second < modes; ++second) {
      for (const Duration a : few) {
        for (const Duration b : few) cycles.push_back({{{a, second}, {b, first}}, {a, b}});
      }
    }
  }
  return cycles;
}

/// Constant times, and pairs that alternate.
std::vector<std::vector<Duration>> times_of(const SamplingBounds& bounds) {
  std::vector<std::vector<Duration>> result;
  for (const Duration time : grid(bounds, kConstantTimes)) result.push_back({time});
  const std::vector<Duration> few = grid(bounds, kPairedTimes);
  for (std::size_t i = 0; i < few.size(); ++i) {
    for (std::size_t j = i + 1; j < few.size(); ++j) result.push_back({few[i], few[j]});
  }
  return result;
}

/// The sensors that are sampled, each with bounds of its own.
class SampledSensors {
 public:
  SampledSensors(const Plant& plant, const SensorSampling& sampling) {
    for (std::size_t i = 0; i < plant.sensors().size(); ++i) {
      if (plant.sensors()[i].timing != SensorTiming::kSampled) continue;
      indices_.push_back(i);
      bounds_.push_back(sampling.of_sensor(i));
    }
    const auto is_less = [](const SamplingBounds& a, const SamplingBounds& b) {
      return std::make_pair(a.T2, a.T1) < std::make_pair(b.T2, b.T1);
    };
    const auto slowest = std::max_element(bounds_.begin(), bounds_.end(), is_less);
    leading_ = static_cast<std::size_t>(slowest - bounds_.begin());
  }

  bool have_one_pace() const {
    return std::all_of(bounds_.begin(), bounds_.end(), [&](const SamplingBounds& bounds) {
      return bounds.T1 == bounds_.front().T1 && bounds.T2 == bounds_.front().T2;
    });
  }

  /// That which may be sampled least often.
  std::size_t leading() const { return indices_[leading_]; }

  /// Between samples of the leading one, as far as they are looked at.
  SamplingBounds leading_bounds() const {
    SamplingBounds bounds = bounds_[leading_];
    for (const SamplingBounds& other : bounds_) {
      if (other.T2 < kLongestLookedAt) bounds.T2 = std::min(bounds.T2, kMostBetween * other.T2);
    }
    return bounds;
  }

  /// Samples of the leading sensor so far apart, and of each other one as seldom as it may be, one
  /// of them together with each of the leading one. Nothing where some can't be so.
  std::vector<Interval> at(const std::vector<Duration>& times) const {
    std::map<Stamp, std::vector<std::size_t>> samples;
    Stamp begin = 0;
    for (const Duration time : times) {
      for (std::size_t i = 0; i < indices_.size(); ++i) {
        const SamplingBounds& bounds = bounds_[i];
        const Duration count = bounds.T2 < time ? (time + bounds.T2 - 1) / bounds.T2 : 1;
        if (time / count < bounds.T1) return {};
        for (Duration k = 1; k <= count; ++k) {
          samples[begin + time * k / count].push_back(indices_[i]);
        }
      }
      begin += time;
    }
    std::vector<Interval> intervals;
    Stamp last = 0;
    for (const auto& [stamp, sensors] : samples) {
      intervals.push_back({stamp - last, 0, sensors});
      last = stamp;
    }
    return intervals;
  }

 private:
  std::vector<std::size_t> indices_;
  std::vector<SamplingBounds> bounds_;
  std::size_t leading_ = 0;
};

std::vector<Cycle> cycles_of_samples(const SampledSensors& sensors) {
  std::vector<Cycle> cycles;
  const SamplingBounds bounds = sensors.leading_bounds();
  if (bounds.T1 > bounds.T2) return cycles;
  for (const std::vector<Duration>& times : times_of(bounds)) {
    std::vector<Interval> intervals = sensors.at(times);
    if (!intervals.empty()) cycles.push_back({std::move(intervals), times});
  }
  return cycles;
}

std::vector<Cycle> cycles_of_jumps(const Plant& plant, const SamplingBounds& bounds) {
  if (plant.switches()) return cycles_of_modes(plant, bounds);
  std::vector<Cycle> cycles;
  for (const std::vector<Duration>& times : times_of(bounds)) {
    cycles.push_back({{}, times});
    for (const Duration time : times) cycles.back().intervals.push_back({time, 0});
  }
  return cycles;
}

/// @param events   what is told of: jumps, samples, or samples of a sensor
/// @param between  what is said of the others
std::string describe(const Plant& plant, const std::string& events, const std::string& between,
                     const Cycle& cycle, double growth) {
  const auto after = [&](std::size_t i) {
    std::string text = number_text(to_seconds(cycle.told[i]), 4) + " s";
    if (plant.switches()) {
      const std::size_t mode = cycle.intervals[i].next_mode;
      text += " (then mode " + std::to_string(plant.modes()[mode].label) + ")";
    }
    return text;
  };
  std::string text = "with " + events;
  if (cycle.told.size() > 1) {
    text += " " + after(0) + " and " + after(1) + " apart by turns";
  } else {
    text += " every " + after(0);
  }
  return text + between + ", inside of [T1, T2], the error grows by the factor " +
         number_text(growth, 4) + " from " + (plant.jumps() ? "jump to jump" : "sample to sample") +
         ": the estimate diverges; compare the signs and sizes of the gains "
         "with the observer's equations, and make gains with 'design synthesize'";
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
                            const SensorSampling& sampling) {
  const auto* observer = dynamic_cast<const PlantObserver*>(&law);
  if (observer == nullptr || observer->flow_step() != 0 || !plant.is_affine() ||
      !has_one_kind_of_event(plant)) {
    return "";
  }
  std::string events = "jumps";
  std::string between;
  std::vector<Cycle> cycles;
  if (plant.jumps()) {
    cycles = cycles_of_jumps(plant, sampling.of_all());
  } else {
    const SampledSensors sensors(plant, sampling);
    cycles = cycles_of_samples(sensors);
    events = "samples";
    if (!sensors.have_one_pace()) {
      events += " of " + plant.sensors()[sensors.leading()].name;
      between = ", and those of the other sensors as seldom between them as may be";
    }
  }
  ErrorMap error(*observer, plant);
  double worst = kGrowth;
  std::string found;
  for (const Cycle& cycle : cycles) {
    const Matrix map = error.over(cycle);
    if (!map.allFinite()) continue;  // over so long a time that it says nothing of the gains
    const double radius = eigenvalues_of(map).cwiseAbs().maxCoeff();
    const double growth = std::pow(radius, 1.0 / static_cast<double>(cycle.told.size()));
    if (!(growth > worst)) continue;
    worst = growth;
    found = describe(plant, events, between, cycle, growth);
  }
  return found;
}

}  // namespace sampled_data_observers
