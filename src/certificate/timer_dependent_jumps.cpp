#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "certificate/theorems.h"
#include "certificate/timer_dependent_jump_bound.h"
#include "certificate/timer_dependent_theorem.h"

namespace sampled_data_observers {
namespace {

/// The observer of a plant that jumps: its timer is the time since the last jump.
class SynchronizedTimerTheorem : public TimerDependentTheorem {
 public:
  std::string name() const override { return "timer_dependent_synchronized"; }
  std::string guarantee() const override {
    return "with outputs known at all times in flow, the error converges at the rate lambda_t, and "
           "its performance output has the L2 gain gamma from the disturbance, for all times "
           "between jumps from T1 to T2";
  }
  std::vector<std::string> observer_types() const override { return {"SynchronizedObserver"}; }

  void require_applicable(const CertificateSubject& subject) const override {
    const PlantMatrices& plant = subject.plant;
    if (plant.modes.size() > 1) {
      throw std::invalid_argument("it is about plants that do not switch");
    }
    if (!plant.jumps()) throw std::invalid_argument("it is about plants that jump");
    if (!plant.mode().A_d) {
      throw std::invalid_argument(
          "it is about jump maps by matrices; design/A_d may state that of the error");
    }
    if (!plant.sampled.empty()) {
      throw std::invalid_argument("it is about outputs in flow and at jumps, not sampled ones");
    }
    if (!plant.is_linear() && plant.vertices.empty() && !plant.lipschitz_constant) {
      throw std::invalid_argument("it needs plant/lipschitz_constant or plant/vertices");
    }
    if (plant.mode().C_c.rows() + plant.mode().C_d.rows() == 0) {
      throw std::invalid_argument("it needs an output in flow or at jumps");
    }
    if (subject.T1 > 0.0 && subject.T1 <= subject.T2 && std::isfinite(subject.T2)) return;
    throw std::invalid_argument("it is about times between jumps with 0 < T1 <= T2 < inf");
  }

  std::vector<NamedShape> gains(const CertificateSubject& subject) const override {
    const ModeMatrices& mode = subject.plant.mode();
    const Eigen::Index n = subject.plant.states();
    std::vector<NamedShape> all;
    if (mode.C_c.rows() > 0) all.push_back(matrix_shape("L_c", n, mode.C_c.rows()));
    if (mode.C_d.rows() > 0) all.push_back(matrix_shape("L_d", n, mode.C_d.rows()));
    return all;
  }

  std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const override {
    return timer_dependent_jump_bound({function(subject)}, subject, values, assumptions);
  }

 protected:
  ErrorSystem error(const CertificateSubject& subject) const override {
    return synchronized_error(subject);
  }
};

}  // namespace

const Theorem& timer_dependent_synchronized() {
  static const SynchronizedTimerTheorem theorem;
  return theorem;
}

}  // namespace sampled_data_observers
