#include <map>
#include <stdexcept>

#include "certificate/bernard2022.h"
#include "certificate/modal_bound.h"
#include "certificate/theorems.h"
#include "observer/observable_form.h"

namespace sampled_data_observers {
namespace {

/// By what a jump makes of the error at most.
enum class JumpOfError { kMatrix, kLipschitzConstant };

/// bernard2022, example 4.2: (22) with the high-gain L_c(ℓ) of (24), for one continuous output.
/// Corollary 4.1 says that for any average dwell time some ℓ is large enough; this says that one
/// is, for such a time or for times of T1 or more.
///
/// Of a jump map g by formulas its Lipschitz constant k is known. In the proof of Corollary 4.1
/// that makes V⁺ <= c̄ k² |x − x̂|² and V >= c̲ |x − x̂|², c̲ and c̄ the least and largest eigenvalue
/// of P, the matrix of V. So V⁺ <= e^{a_d} V for all such g where, and only where, for a number p
///
///   P <= p JᵀJ,  k² p JᵀJ <= e^{a_d} P,  J = I.
class Example42 : public LyapunovTheorem {
 public:
  Example42(JumpOfError jump, TheoremTimes times)
      : LyapunovTheorem(FlowOfError::kDecays, times), jump_(jump) {}

  std::string name() const override {
    return (is_lipschitz() ? std::string("bernard2022_corollary4_1") : "bernard2022_example4_2") +
           (is_of_average(times()) ? "_average_dwell_time" : "");
  }

  std::string guarantee() const override {
    if (is_of_average(times())) {
      return "the error falls at the rate decay in the norm of P but for a factor "
             "exp((flow_decay - 2 decay) tau N0 / 2), for all jumps with an average dwell time: "
             "N(t, s) <= (t - s) / tau + N0, with the continuous output known at all times";
    }
    return "the error falls by the factor exp(-jump_decay) or more from jump to jump, in the norm "
           "of P, for all times between jumps of T1 or more, with the continuous output known at "
           "all times";
  }

  std::vector<std::string> observer_types() const override { return {"HighGainObserver"}; }

  void require_applicable(const CertificateSubject& subject) const override {
    if (is_lipschitz()) {
      require_lipschitz_jumps(subject);
    } else {
      require_linear_jumping_plant(subject);
    }
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
    std::vector<NamedShape> all = {symmetric_shape("P", subject.plant.states())};
    if (is_lipschitz()) all.push_back(scalar_shape("P_largest"));
    return all;
  }

  std::vector<NamedRange> search_ranges(const CertificateSubject& subject) const override {
    return {{"flow_decay", flow_decay_range(subject)}};
  }

  bool is_homogeneous(const CertificateSubject&) const override { return true; }

  std::vector<Condition> conditions(const CertificateSubject& subject) const override {
    const ModeMatrices& plant = subject.plant.mode();
    const MatrixExpression flow = plant.A - high_gain_of(plant) * plant.C_c;
    std::vector<Condition> all =
        is_lipschitz() ? lipschitz_conditions(subject, flow)
                       : quadratic_conditions(subject, FlowOfError::kDecays, flow,
                                              MatrixExpression(*plant.A_d), "bernard2022 (22");
    all.push_back(positive("ell"));
    return all;
  }

  std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const override {
    const ModeMatrices& plant = subject.plant.mode();
    const ObservableForm form = observable_form(plant.A, plant.C_c);
    const double ell = scalar_value(values, "ell");
    const Eigen::VectorXd K = values.at("K").transpose();
    const Eigen::MatrixXd L_c = high_gain(plant.A, plant.C_c, form, ell, {K});
    return held_output_bound(subject, {{values.at("P"), L_c, Eigen::MatrixXd()}},
                             scalar_value(values, "flow_decay"), assumptions);
  }

 private:
  bool is_lipschitz() const { return jump_ == JumpOfError::kLipschitzConstant; }

  static void require_lipschitz_jumps(const CertificateSubject& subject) {
    if (subject.plant.modes.size() > 1) {
      throw std::invalid_argument("it is about plants that do not switch");
    }
    if (!subject.plant.is_linear()) throw std::invalid_argument("it is about linear flows");
    if (!subject.plant.lipschitz_jump) {
      throw std::invalid_argument(
          "it is about jump maps with a Lipschitz constant: plant/jump_map/lipschitz_constant");
    }
  }

  static std::vector<Condition> lipschitz_conditions(const CertificateSubject& subject,
                                                     const MatrixExpression& flow) {
    const MatrixExpression P = symbol("P", flow.rows(), flow.rows());
    const LyapunovRates rates = lyapunov_rates(subject, FlowOfError::kDecays);
    const LipschitzJump& jump = *subject.plant.lipschitz_jump;
    const Eigen::MatrixXd squared = jump.J.transpose() * jump.J;
    const MatrixExpression largest = symbol("P_largest") * MatrixExpression(squared);
    std::vector<Condition> all = rates.domains;
    all.push_back(positive("P_largest"));
    all.push_back({"P > 0", P, std::nullopt});
    all.push_back({"flow, bernard2022 (22a)", rates.a_c * P - He(P * flow), std::nullopt});
    all.push_back({"largest eigenvalue of P, bernard2022 (23a)", largest - P, std::nullopt});
    all.push_back({"jump, bernard2022 corollary 4.1",
                   exponential(rates.a_d) * P - MatrixExpression(jump.constant) *
                                                    (MatrixExpression(jump.constant) * largest),
                   std::nullopt});
    return all;
  }

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

  JumpOfError jump_;
};

}  // namespace

const Theorem& bernard2022_example4_2() {
  static const Example42 theorem(JumpOfError::kMatrix, TheoremTimes::kFromT1);
  return theorem;
}

const Theorem& bernard2022_example4_2_average_dwell_time() {
  static const Example42 theorem(JumpOfError::kMatrix, TheoremTimes::kAverageDwellTime);
  return theorem;
}

const Theorem& bernard2022_corollary4_1() {
  static const Example42 theorem(JumpOfError::kLipschitzConstant, TheoremTimes::kFromT1);
  return theorem;
}

const Theorem& bernard2022_corollary4_1_average_dwell_time() {
  static const Example42 theorem(JumpOfError::kLipschitzConstant, TheoremTimes::kAverageDwellTime);
  return theorem;
}

}  // namespace sampled_data_observers
