#include <map>
#include <stdexcept>

#include "certificate/bernard2022.h"
#include "certificate/modal_bound.h"
#include "certificate/theorems.h"
#include "observer/observable_form.h"

namespace sampled_data_observers {
namespace {

/// bernard2022, example 4.2: (22) with the high-gain L_c(ℓ) of (24), for one continuous output.
/// Corollary 4.1 says that some ℓ is large enough; this says that one is.
class Example42 : public Theorem {
 public:
  std::string name() const override { return "bernard2022_example4_2"; }

  std::string guarantee() const override {
    return "the error falls by the factor exp(-jump_decay) or more from jump to jump, in the norm "
           "of P, for all times between jumps of T1 or more, with the continuous output known at "
           "all times";
  }

  TheoremTimes times() const override { return TheoremTimes::kFromT1; }

  std::vector<std::string> observer_types() const override { return {"HighGainObserver"}; }

  void require_applicable(const CertificateSubject& subject) const override {
    require_linear_jumping_plant(subject);
    const ModeMatrices& plant = subject.plant.mode();
    if (plant.C_c.rows() != 1) {
      throw std::invalid_argument("it is about one output that is `measured: continuous`");
    }
    observable_form(plant.A, plant.C_c);
  }

  std::vector<NamedShape> gains(const CertificateSubject& subject) const override {
    return {scalar_shape("ell"), matrix_shape("K", 1, subject.plant.states())};
  }

  std::map<std::string, std::string> gain_choices() const override { return {{"form", "linear"}}; }

  std::vector<NamedShape> multipliers(const CertificateSubject& subject) const override {
    return {symmetric_shape("P", subject.plant.states())};
  }

  std::vector<NamedShape> parameters(const CertificateSubject&) const override {
    return {scalar_shape("flow_decay"), scalar_shape("jump_decay")};
  }

  std::string decay_parameter() const override { return "jump_decay"; }
  GuaranteedFigure decay_figure(const NamedMatrices& values) const override {
    return jump_decay_figure(values);
  }

  std::vector<NamedRange> search_ranges(const CertificateSubject& subject) const override {
    return {{"flow_decay", flow_decay_range(subject)}};
  }

  bool is_homogeneous(const CertificateSubject&) const override { return true; }

  std::vector<Condition> conditions(const CertificateSubject& subject) const override {
    const ModeMatrices& plant = subject.plant.mode();
    std::vector<Condition> all = quadratic_conditions(
        subject, FlowOfError::kDecays, plant.A - high_gain_of(plant) * plant.C_c,
        MatrixExpression(*plant.A_d), "bernard2022 (22");
    all.push_back(positive("ell"));
    return all;
  }

  std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const override {
    // Stated maps of the error take outputs as known at all times, which come in messages.
    if (!subject.plant.stated.is_empty()) return nullptr;
    const ModeMatrices& plant = subject.plant.mode();
    const ObservableForm form = observable_form(plant.A, plant.C_c);
    const double ell = scalar_value(values, "ell");
    const Eigen::VectorXd K = values.at("K").transpose();
    const Eigen::MatrixXd L_c = high_gain(plant.A, plant.C_c, form, ell, {K});
    return held_output_bound(subject, {{values.at("P"), L_c, Eigen::MatrixXd()}},
                             scalar_value(values, "flow_decay"), assumptions);
  }

 private:
  /// 𝒱⁻¹ (𝐃 + ℓ 𝓛(ℓ) 𝐊), (24)
  static MatrixExpression high_gain_of(const ModeMatrices& plant) {
    const Eigen::Index n = plant.A.rows();
    const ObservableForm form = observable_form(plant.A, plant.C_c);
    const MatrixExpression ell = symbol("ell");
    const MatrixExpression K = transpose(symbol("K", 1, n));
    MatrixExpression gain = form.D;
    MatrixExpression power = ell;
    for (Eigen::Index i = n - 1; i >= 0; --i) {
      Eigen::MatrixXd entry = Eigen::MatrixXd::Zero(n, n);
      entry(i, i) = 1.0;
      gain = gain + power * (MatrixExpression(entry) * K);
      power = power * ell;
    }
    return MatrixExpression(form.basis) * gain;
  }
};

}  // namespace

const Theorem& bernard2022_example4_2() {
  static const Example42 theorem;
  return theorem;
}

}  // namespace sampled_data_observers
