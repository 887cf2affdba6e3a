#include <stdexcept>

#include "certificate/bernard2022.h"
#include "certificate/jump_based_bound.h"
#include "certificate/theorems.h"

namespace sampled_data_observers {
namespace {

/// bernard2022, Corollary 5.2, with a margin in it: V = (x − x̂)ᵀ P (x − x̂) falls by the factor
/// e^{−2 jump_decay} from jump to jump. (32) is this for some jump_decay > 0, since [T1, T2] is
/// compact.
class Corollary52 : public Theorem {
 public:
  std::string name() const override { return "bernard2022_corollary5_2"; }

  std::string guarantee() const override {
    return "the error falls by the factor exp(-jump_decay) or more from jump to jump, in the norm "
           "of P, for all times between jumps in [T1, T2]";
  }

  std::vector<std::string> observer_types() const override { return {"SynchronizedObserver"}; }

  void require_applicable(const CertificateSubject& subject) const override {
    require_linear_jumping_plant(subject);
    if (subject.plant.mode().C_d.rows() == 0) {
      throw std::invalid_argument("L_d needs a sensor that is `measured: at_jumps`");
    }
  }

  std::vector<NamedShape> gains(const CertificateSubject& subject) const override {
    return {matrix_shape("L_d", subject.plant.states(), subject.plant.mode().C_d.rows())};
  }

  std::vector<NamedShape> multipliers(const CertificateSubject& subject) const override {
    return {symmetric_shape("P", subject.plant.states())};
  }

  std::vector<NamedShape> parameters(const CertificateSubject&) const override {
    return {scalar_shape("jump_decay")};
  }

  std::string decay_parameter() const override { return "jump_decay"; }
  GuaranteedFigure decay_figure(const NamedMatrices& values) const override {
    return jump_decay_figure(values);
  }

  bool is_homogeneous(const CertificateSubject&) const override { return true; }

  std::vector<Condition> conditions(const CertificateSubject& subject) const override {
    const Eigen::Index n = subject.plant.states();
    const ModeMatrices& plant = subject.plant.mode();
    const MatrixExpression P = symbol("P", n, n);
    const MatrixExpression jump_decay = symbol("jump_decay");
    const MatrixExpression cycle = (*plant.A_d - symbol("L_d", n, plant.C_d.rows()) * plant.C_d) *
                                   exponential(time_tau() * MatrixExpression(plant.A));
    std::vector<Condition> all = domain_of_times(subject.T1, subject.T2);
    all.push_back(positive("jump_decay"));
    all.push_back({"P > 0", P, std::nullopt});
    all.push_back({"bernard2022 (32)",
                   exponential(-2.0 * jump_decay) * P - transpose(cycle) * P * cycle,
                   Condition::Range{subject.T1, subject.T2}});
    return all;
  }

  std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const override {
    const Eigen::MatrixXd& L_d = values.at("L_d");
    return jump_based_bound(subject, values.at("P"), L_d,
                            {-scalar_value(values, "jump_decay"), 0.0}, assumptions);
  }
};

}  // namespace

const Theorem& bernard2022_corollary5_2() {
  static const Corollary52 theorem;
  return theorem;
}

}  // namespace sampled_data_observers
