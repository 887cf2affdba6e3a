#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

#include "certificate/theorems.h"
#include "certificate/timer_dependent_bound.h"
#include "certificate/timer_dependent_theorem.h"
#include "certificate/timer_grid.h"

namespace sampled_data_observers {
namespace {

constexpr const char* kGuarantee =
    "the error converges at the rate lambda_t, and its performance output has the L2 gain gamma "
    "from the disturbance, for all times between samples of each sensor from its T1 to its T2";

/// Of one type of observer.
struct TimerDependentVariant {
  std::string name;
  std::string observer_type;
  std::function<ErrorSystem(const CertificateSubject&)> error;
  bool has_L = true;
  bool has_H = false;
  bool is_scheduled = false;
};

/// Observers of plants that do not jump.
class SampledTimerTheorem : public TimerDependentTheorem {
 public:
  explicit SampledTimerTheorem(TimerDependentVariant variant) : variant_(std::move(variant)) {}

  std::string name() const override { return variant_.name; }
  std::string guarantee() const override { return kGuarantee; }
  std::vector<std::string> observer_types() const override { return {variant_.observer_type}; }
  bool takes_several_sensors() const override { return true; }

  void require_applicable(const CertificateSubject& subject) const override {
    const PlantMatrices& plant = subject.plant;
    if (plant.modes.size() > 1 || plant.jumps()) {
      throw std::invalid_argument("it is about plants that do not jump");
    }
    if (plant.sampled.empty()) throw std::invalid_argument("it needs a sampled sensor");
    if (!plant.is_linear() && plant.vertices.empty() && !plant.lipschitz_constant) {
      throw std::invalid_argument("it needs plant/lipschitz_constant or plant/vertices");
    }
    if (plant.sampled.size() > TensorGrid::kMaxDimensions) {
      throw std::invalid_argument("it is about " + std::to_string(TensorGrid::kMaxDimensions) +
                                  " sensors at most, each with a timer of its own; the theorems "
                                  "timer_dependent_sum_... are about more");
    }
    const std::vector<SamplingTimes> times = times_of_timers(subject);
    if (times.size() != plant.sampled.size()) {
      throw std::invalid_argument(
          "it needs T1 and T2 of each sensor: sensors/NAME/sampling, or sampling: {NAME: {T1: …, "
          "T2: …}, …}");
    }
    for (const SamplingTimes& of_sensor : times) {
      if (of_sensor.T2 > 0.0 && std::isfinite(of_sensor.T2) && of_sensor.T1 <= of_sensor.T2) {
        continue;
      }
      throw std::invalid_argument("it is about times between samples with 0 <= T1 <= T2 < ∞");
    }
    if (times.size() == 1 || variant_.is_scheduled) return;
    for (const SamplingTimes& of_sensor : times) {
      if (of_sensor.T1 > 0.0) continue;
      throw std::invalid_argument(
          "for several sensors with constant gains it needs T1 > 0 of each, however short "
          "(timer_dependent_scheduled_gain does not)");
    }
  }

  std::vector<NamedShape> gains(const CertificateSubject& subject) const override {
    const PlantMatrices& plant = subject.plant;
    const Eigen::Index n = plant.states();
    const TensorGrid grid = grid_of(subject);
    std::vector<NamedShape> all;
    for (std::size_t i = 0; i < plant.sampled.size(); ++i) {
      const Eigen::Index m = plant.sampled[i].rows;
      if (variant_.has_L) all.push_back(matrix_shape(gain_of_sensor("L", subject, i), n, m));
      if (variant_.has_H) all.push_back(matrix_shape(gain_of_sensor("H", subject, i), m, m));
    }
    if (!variant_.is_scheduled) return all;
    for (std::size_t i = 0; i < plant.sampled.size(); ++i) {
      const std::string& sensor = plant.sampled[i].sensor;
      all.push_back(
          list_shape("timers/" + sensor, static_cast<Eigen::Index>(grid.nodes(i).size())));
    }
    for (std::size_t k = 0; k < grid.size(); ++k) {
      all.push_back(symmetric_shape("P/" + std::to_string(k), n));
    }
    for (std::size_t i = 0; i < plant.sampled.size(); ++i) {
      const SampledOutputs& outputs = plant.sampled[i];
      for (std::size_t k = 0; k < grid.size(); ++k) {
        const std::string of_node = outputs.sensor + "/" + std::to_string(k);
        all.push_back(has_Z(subject, grid, i, k)
                          ? matrix_shape("Z/" + of_node, outputs.rows, outputs.rows)
                          : matrix_shape("K/" + of_node, n, outputs.rows));
      }
    }
    return all;
  }

  std::vector<NamedShape> multipliers(const CertificateSubject& subject) const override {
    std::vector<NamedShape> all = TimerDependentTheorem::multipliers(subject);
    if (!variant_.is_scheduled) return all;
    std::vector<NamedShape> scalars;  // P is a gain
    for (const NamedShape& shape : all) {
      if (shape.form == NamedShape::Form::kScalar) scalars.push_back(shape);
    }
    return scalars;
  }

  std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const override {
    return std::make_unique<const TimerDependentBound>(function(subject), longest_times(subject),
                                                       values, assumptions);
  }

 protected:
  ErrorSystem error(const CertificateSubject& subject) const override {
    return variant_.error(subject);
  }

 private:
  TimerDependentVariant variant_;
};

}  // namespace

const Theorem& timer_dependent_constant_gain() {
  static const SampledTimerTheorem theorem(
      {"timer_dependent_constant_gain", "ConstantGainObserver", constant_gain_error});
  return theorem;
}

const Theorem& timer_dependent_intersample_injection() {
  static const SampledTimerTheorem theorem({"timer_dependent_intersample_injection",
                                            "IntersampleInjectionObserver", injection_error, true,
                                            true});
  return theorem;
}

const Theorem& timer_dependent_sample_and_hold() {
  static const SampledTimerTheorem theorem(
      {"timer_dependent_sample_and_hold", "SampleAndHoldObserver", held_injection_error});
  return theorem;
}

const Theorem& timer_dependent_scheduled_gain() {
  static const SampledTimerTheorem theorem({"timer_dependent_scheduled_gain",
                                            "TimeVaryingGainObserver", scheduled_gain_error, false,
                                            false, true});
  return theorem;
}

}  // namespace sampled_data_observers
