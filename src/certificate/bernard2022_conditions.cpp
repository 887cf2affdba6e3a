#include <stdexcept>
#include <utility>

#include "jump_based_bound.h"
#include "theorems.h"

namespace sampled_data_observers {
namespace {

/// Where the innovation acts.
enum class Innovation { kFlowAndJumps, kFlow, kJumps };

/// bernard2022, Theorem 3.1 with V = (x − x̂)ᵀ P (x − x̂) for linear maps: V̇ <= a_c V in flow,
/// V⁺ <= e^{a_d} V at jumps, and a_c τ + a_d < 0 at both ends of [T1, T2], which is (C1a) for
/// a_c < 0 and (C2a) for a_d < 0.
class QuadraticCondition : public Theorem {
 public:
  QuadraticCondition(int number, Innovation innovation, std::string guarantee)
      : number_(std::to_string(number)),
        in_flow_(innovation != Innovation::kJumps),
        at_jumps_(innovation != Innovation::kFlow),
        guarantee_(std::move(guarantee)) {}

  std::string name() const override { return "bernard2022_equation" + number_; }
  std::string guarantee() const override { return guarantee_; }
  std::vector<std::string> observer_types() const override { return {"SynchronizedObserver"}; }

  void require_applicable(const CertificateSubject& subject) const override {
    require_linear_jumping_plant(subject);
    if (in_flow_ && subject.plant.mode().C_c.rows() == 0) {
      throw std::invalid_argument("L_c needs a sensor that is `measured: continuous`");
    }
    if (at_jumps_ && subject.plant.mode().C_d.rows() == 0) {
      throw std::invalid_argument("L_d needs a sensor that is `measured: at_jumps`");
    }
  }

  std::vector<NamedShape> gains(const CertificateSubject& subject) const override {
    const Eigen::Index n = subject.plant.states();
    std::vector<NamedShape> all;
    if (in_flow_) all.push_back(matrix_shape("L_c", n, subject.plant.mode().C_c.rows()));
    if (at_jumps_) all.push_back(matrix_shape("L_d", n, subject.plant.mode().C_d.rows()));
    return all;
  }

  std::vector<NamedShape> multipliers(const CertificateSubject& subject) const override {
    return {symmetric_shape("P", subject.plant.states())};
  }

  std::vector<NamedShape> parameters(const CertificateSubject&) const override {
    return {scalar_shape("a_c"), scalar_shape("a_d")};
  }

  bool is_homogeneous(const CertificateSubject&) const override { return true; }

  std::vector<Condition> conditions(const CertificateSubject& subject) const override {
    const Eigen::Index n = subject.plant.states();
    const ModeMatrices& plant = subject.plant.mode();
    MatrixExpression flow = plant.A;
    MatrixExpression reset = *plant.A_d;
    if (in_flow_) flow = flow - symbol("L_c", n, plant.C_c.rows()) * plant.C_c;
    if (at_jumps_) reset = reset - symbol("L_d", n, plant.C_d.rows()) * plant.C_d;
    return quadratic_conditions(subject, flow, reset, "bernard2022 (" + number_);
  }

  std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const override {
    // y_c is taken as known at all times. It comes in messages and is held between them.
    if (in_flow_ || !subject.plant.stated.is_empty()) return nullptr;
    const ModeMatrices& plant = subject.plant.mode();
    const Eigen::MatrixXd& L_d = values.at("L_d");
    return jump_based_bound(subject, values.at("P"), *plant.A_d - L_d * plant.C_d, L_d,
                            {scalar_value(values, "a_d") / 2.0, scalar_value(values, "a_c") / 2.0},
                            assumptions);
  }

 private:
  std::string number_;
  bool in_flow_;
  bool at_jumps_;
  std::string guarantee_;
};

}  // namespace

void require_linear_jumping_plant(const CertificateSubject& subject) {
  if (subject.plant.modes.size() > 1) {
    throw std::invalid_argument("it is about plants that do not switch");
  }
  if (!subject.plant.is_linear()) {
    throw std::invalid_argument("it is about linear flows; design/A may state that of the error");
  }
  if (!subject.plant.jumps()) throw std::invalid_argument("it is about plants that jump");
}

std::vector<Condition> quadratic_conditions(const CertificateSubject& subject,
                                            const MatrixExpression& flow,
                                            const MatrixExpression& reset,
                                            const std::string& source) {
  const MatrixExpression P = symbol("P", flow.rows(), flow.rows());
  const MatrixExpression a_c = symbol("a_c");
  const MatrixExpression a_d = symbol("a_d");
  return {
      {"P > 0", P, std::nullopt},
      {"flow, " + source + "a)", a_c * P - He(P * flow), std::nullopt},
      {"jump, " + source + "b)", exponential(a_d) * P - transpose(reset) * P * reset, std::nullopt},
      {"a_c T1 + a_d < 0, bernard2022 (C)", -(a_c * MatrixExpression(subject.T1) + a_d),
       std::nullopt},
      {"a_c T2 + a_d < 0, bernard2022 (C)", -(a_c * MatrixExpression(subject.T2) + a_d),
       std::nullopt},
  };
}

const Theorem& bernard2022_equation14() {
  static const QuadraticCondition theorem(
      14, Innovation::kFlowAndJumps,
      "the error converges exponentially for all times between jumps in [T1, T2], with the "
      "continuous output known at all times");
  return theorem;
}

const Theorem& bernard2022_equation22() {
  static const QuadraticCondition theorem(
      22, Innovation::kFlow,
      "the error converges exponentially for all times between jumps in [T1, T2], with the "
      "continuous output known at all times");
  return theorem;
}

const Theorem& bernard2022_equation26() {
  static const QuadraticCondition theorem(
      26, Innovation::kJumps,
      "the error converges exponentially for all times between jumps in [T1, T2]");
  return theorem;
}

}  // namespace sampled_data_observers
