#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "certificate/theorems.h"
#include "certificate/timer_dependent.h"
#include "certificate/timer_dependent_jump_bound.h"
#include "certificate/timer_dependent_theorem.h"

namespace sampled_data_observers {
namespace {

/// The observer of a plant that switches: V = eᵀ P_q(τ) e in mode q, τ the time since the last
/// switch.
class SwitchedTimerTheorem : public Theorem {
 public:
  std::string name() const override { return "timer_dependent_switched"; }
  std::string guarantee() const override {
    return "with outputs known at all times in flow, the error converges at the rate lambda_t, and "
           "its performance output has the L2 gain gamma from the disturbance, when every switch "
           "changes the mode, for all times between switches from T1 to T2";
  }
  std::vector<std::string> observer_types() const override { return {"SwitchedObserver"}; }

  void require_applicable(const CertificateSubject& subject) const override {
    const PlantMatrices& plant = subject.plant;
    if (plant.modes.size() < 2) {
      throw std::invalid_argument("it is about switched plants: plant/modes with two or more");
    }
    if (!plant.is_linear()) throw std::invalid_argument("it is about modes with linear flows");
    if (!plant.sampled.empty()) {
      throw std::invalid_argument("it is about outputs in flow and at switches, not sampled ones");
    }
    if (plant.mode().C_c.rows() + plant.mode().C_d.rows() == 0) {
      throw std::invalid_argument("it needs an output in flow or at switches");
    }
    if (subject.T1 > 0.0 && subject.T1 <= subject.T2 && std::isfinite(subject.T2)) return;
    throw std::invalid_argument("it is about times between switches with 0 < T1 <= T2 < inf");
  }

  std::vector<NamedShape> gains(const CertificateSubject& subject) const override {
    const Eigen::Index n = subject.plant.states();
    std::vector<NamedShape> all;
    for (const ModeMatrices& mode : subject.plant.modes) {
      if (mode.C_c.rows() > 0)
        all.push_back(matrix_shape(of_mode("L_c", mode), n, mode.C_c.rows()));
      if (mode.C_d.rows() > 0)
        all.push_back(matrix_shape(of_mode("L_d", mode), n, mode.C_d.rows()));
    }
    return all;
  }

  std::vector<NamedShape> multipliers(const CertificateSubject& subject) const override {
    std::vector<NamedShape> all;
    for (const TimerDependentFunction& function : functions_of_modes(subject)) {
      for (const NamedShape& shape : function.shapes()) {
        if (shape.form == NamedShape::Form::kSymmetric) all.push_back(shape);
      }
    }
    if (has_level(subject)) all.push_back(scalar_shape(kLevel));
    return all;
  }
  std::vector<std::string> unlimited_multipliers(const CertificateSubject& subject) const override {
    if (has_level(subject)) return {kLevel};
    return {};
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
    std::vector<Condition> all = domain_of_times(subject.T1, subject.T2);
    if (!(0.0 < subject.T1 && subject.T1 <= subject.T2)) return all;
    for (const NamedShape& parameter : parameters(subject)) all.push_back(positive(parameter.name));
    if (has_level(subject)) all.push_back(positive(kLevel));
    const std::vector<TimerDependentFunction> functions = functions_of_modes(subject);
    const auto append = [&](std::vector<Condition> some) {
      for (Condition& condition : some) {
        if (condition.name != positive(kLevel).name) all.push_back(std::move(condition));
      }
    };
    for (const TimerDependentFunction& function : functions) {
      append(function.flow_conditions());
      for (const TimerDependentFunction& next : functions) {
        if (&next != &function) append(function.jumps_into(next, 0));
      }
    }
    return all;
  }

  std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const override {
    return timer_dependent_jump_bound(functions_of_modes(subject), subject, values, assumptions);
  }

 private:
  /// ν, one for all modes.
  static constexpr const char* kLevel = "nu/jumps";

  static bool has_level(const CertificateSubject& subject) {
    return subject.plant.mode().C_d.rows() > 0;
  }
};

}  // namespace

std::vector<TimerDependentFunction> functions_of_modes(const CertificateSubject& subject) {
  std::vector<TimerDependentFunction> all;
  for (std::size_t mode = 0; mode < subject.plant.modes.size(); ++mode) {
    all.emplace_back(switched_error(subject, mode), grid_of(subject), shortest_times(subject));
  }
  return all;
}

const Theorem& timer_dependent_switched() {
  static const SwitchedTimerTheorem theorem;
  return theorem;
}

}  // namespace sampled_data_observers
