#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "certificate/theorems.h"
#include "certificate/timer_dependent.h"
#include "certificate/timer_dependent_sum_bound.h"
#include "certificate/timer_dependent_theorem.h"
#include "certificate/timer_grid.h"

namespace sampled_data_observers {
namespace {

constexpr const char* kGuaranteeOfSum =
    "the error converges at the rate lambda_t, and its performance output has the L2 gain gamma "
    "from the disturbance, for all times between samples of each sensor from its T1 to its T2";

/// Of one type of observer.
struct SumVariant {
  std::string name;
  std::string observer_type;
  ErrorSystem (*error)(const CertificateSubject&) = nullptr;
  bool has_H = false;
};

/// Several sensors, of which each adds a function of its own timer.
class SumTheorem : public Theorem {
 public:
  explicit SumTheorem(SumVariant variant) : variant_(std::move(variant)) {}

  std::string name() const override { return variant_.name; }
  std::string guarantee() const override { return kGuaranteeOfSum; }
  std::vector<std::string> observer_types() const override { return {variant_.observer_type}; }
  bool takes_several_sensors() const override { return true; }
  bool takes_flow_vertices() const override { return true; }
  bool sums_over_timers() const override { return true; }

  void require_applicable(const CertificateSubject& subject) const override {
    const PlantMatrices& plant = subject.plant;
    if (plant.modes.size() > 1 || plant.jumps()) {
      throw std::invalid_argument("it is about plants that do not jump");
    }
    if (plant.sampled.size() < 2) throw std::invalid_argument("it needs several sampled sensors");
    if (!plant.is_linear() && plant.vertices.empty() && !plant.lipschitz_constant) {
      throw std::invalid_argument("it needs plant/lipschitz_constant or plant/vertices");
    }
    const std::vector<SamplingTimes> times = times_of_timers(subject);
    if (times.size() != plant.sampled.size()) {
      throw std::invalid_argument(
          "it needs T1 and T2 of each sensor: sensors/NAME/sampling, or sampling: {NAME: {T1: …, "
          "T2: …}, …}");
    }
    for (const SamplingTimes& of_sensor : times) {
      if (0.0 < of_sensor.T1 && of_sensor.T1 <= of_sensor.T2 && std::isfinite(of_sensor.T2)) {
        continue;
      }
      throw std::invalid_argument("it is about times between samples with 0 < T1 <= T2 < ∞");
    }
  }

  std::vector<NamedShape> gains(const CertificateSubject& subject) const override {
    const PlantMatrices& plant = subject.plant;
    std::vector<NamedShape> all;
    for (std::size_t i = 0; i < plant.sampled.size(); ++i) {
      const Eigen::Index m = plant.sampled[i].rows;
      all.push_back(matrix_shape(gain_of_sensor("L", subject, i), plant.states(), m));
      if (variant_.has_H) all.push_back(matrix_shape(gain_of_sensor("H", subject, i), m, m));
    }
    return all;
  }
  std::vector<NamedShape> multipliers(const CertificateSubject& subject) const override {
    return sum(subject).shapes();
  }
  std::vector<std::string> unlimited_multipliers(const CertificateSubject& subject) const override {
    std::vector<std::string> names;
    for (const NamedShape& shape : multipliers(subject)) {
      if (shape.form == NamedShape::Form::kSymmetric || shape.name.rfind("nu/", 0) == 0) {
        names.push_back(shape.name);
      }
    }
    return names;
  }
  std::vector<NamedShape> parameters(const CertificateSubject& subject) const override {
    std::vector<NamedShape> all = {scalar_shape("lambda_t")};
    if (subject.plant.N.cols() > 0) all.push_back(scalar_shape("gamma"));
    return all;
  }
  std::string decay_parameter() const override { return "lambda_t"; }
  bool is_homogeneous(const CertificateSubject& subject) const override {
    return subject.plant.N.cols() == 0;
  }

  std::vector<Condition> conditions(const CertificateSubject& subject) const override {
    std::vector<Condition> all;
    bool has_times = true;
    for (const SamplingTimes& times : times_of_timers(subject)) {
      has_times &= 0.0 < times.T1 && times.T1 <= times.T2;
      for (Condition& domain : domain_of_times(times.T1, times.T2)) {
        all.push_back(std::move(domain));
      }
    }
    if (!has_times) return all;
    for (const NamedShape& parameter : parameters(subject)) all.push_back(positive(parameter.name));
    if (!subject.plant.is_linear() && subject.plant.vertices.empty()) {
      all.push_back({"lipschitz_constant >= 0", *subject.plant.lipschitz_constant, std::nullopt,
                     Condition::Kind::kNonNegative});
    }
    for (Condition& condition : sum(subject).conditions()) all.push_back(std::move(condition));
    return all;
  }

  std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const override {
    return std::make_unique<const TimerDependentSumBound>(sum(subject), longest_times(subject),
                                                          values, assumptions);
  }

  TimerDependentSum sum(const CertificateSubject& subject) const {
    const CertificateSubject on_nodes = subject.timer_nodes.empty() ? with_cells(subject) : subject;
    return {variant_.error(subject), on_nodes.timer_nodes, shortest_times(subject)};
  }

 private:
  SumVariant variant_;
};

}  // namespace

const Theorem& timer_dependent_sum_constant_gain() {
  static const SumTheorem theorem(
      {"timer_dependent_sum_constant_gain", "ConstantGainObserver", constant_gain_error});
  return theorem;
}

const Theorem& timer_dependent_sum_intersample_injection() {
  static const SumTheorem theorem({"timer_dependent_sum_intersample_injection",
                                   "IntersampleInjectionObserver", injection_error, true});
  return theorem;
}

const Theorem& timer_dependent_sum_sample_and_hold() {
  static const SumTheorem theorem(
      {"timer_dependent_sum_sample_and_hold", "SampleAndHoldObserver", held_injection_error});
  return theorem;
}

std::optional<TimerDependentSum> timer_dependent_sum(const Theorem& theorem,
                                                     const CertificateSubject& subject) {
  const auto* own = dynamic_cast<const SumTheorem*>(&theorem);
  if (own == nullptr) return std::nullopt;
  return own->sum(subject);
}

}  // namespace sampled_data_observers
