#include <stdexcept>
#include <utility>

#include "certificate/bernard2022.h"
#include "certificate/jump_based_bound.h"
#include "certificate/modal_bound.h"
#include "certificate/theorems.h"

namespace sampled_data_observers {
namespace {

const char* const kConverges =
    "the error falls by the factor exp(-jump_decay) or more from jump to jump, in the norm of P, "
    "for all times between jumps in [T1, T2]";
const char* const kWithKnownOutput =
    "the error falls by the factor exp(-jump_decay) or more from jump to jump, in the norm of P, "
    "for all times between jumps of T1 or more, with the continuous output known at all times";

// That it is an average is a bound on N(t, s), the number of jumps between s and t >= s.
const char* const kConvergesForDwellTime =
    "the error falls at the rate decay in the norm of P but for a factor exp((flow_growth + 2 "
    "decay) tau N0 / 2), for all jumps with a reverse average dwell time: N(t, s) >= (t - s) / tau "
    "- N0";
const char* const kWithKnownOutputForDwellTime =
    "the error falls at the rate decay in the norm of P but for a factor exp((flow_decay - 2 "
    "decay) "
    "tau N0 / 2), for all jumps with an average dwell time: N(t, s) <= (t - s) / tau + N0, with "
    "the continuous output known at all times";

/// Where the innovation acts.
enum class Innovation { kFlowAndJumps, kFlow, kJumps };

/// bernard2022, Theorem 3.1 with V = (x − x̂)ᵀ P (x − x̂) for linear maps; see
/// quadratic_conditions().
class QuadraticCondition : public LyapunovTheorem {
 public:
  QuadraticCondition(int number, Innovation innovation, TheoremTimes times, std::string guarantee)
      : LyapunovTheorem(
            innovation == Innovation::kJumps ? FlowOfError::kMayGrow : FlowOfError::kDecays, times),
        number_(std::to_string(number)),
        in_flow_(innovation != Innovation::kJumps),
        at_jumps_(innovation != Innovation::kFlow),
        guarantee_(std::move(guarantee)) {}

  std::string name() const override {
    std::string name = "bernard2022_equation" + number_;
    if (times() == TheoremTimes::kAverageDwellTime) name += "_average_dwell_time";
    if (times() == TheoremTimes::kReverseAverageDwellTime) name += "_reverse_average_dwell_time";
    return name;
  }
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

  std::vector<NamedRange> search_ranges(const CertificateSubject& subject) const override {
    if (in_flow_) return {{"flow_decay", flow_decay_range(subject)}};
    return {{"flow_growth", flow_growth_range(subject)}};
  }

  bool is_homogeneous(const CertificateSubject&) const override { return true; }

  std::vector<Condition> conditions(const CertificateSubject& subject) const override {
    const Eigen::Index n = subject.plant.states();
    const ModeMatrices& plant = subject.plant.mode();
    MatrixExpression flow = plant.A;
    MatrixExpression reset = *plant.A_d;
    if (in_flow_) flow = flow - symbol("L_c", n, plant.C_c.rows()) * plant.C_c;
    if (at_jumps_) reset = reset - symbol("L_d", n, plant.C_d.rows()) * plant.C_d;
    return quadratic_conditions(subject, kind(), flow, reset, "bernard2022 (" + number_);
  }

  std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const override {
    if (in_flow_) {
      const Eigen::MatrixXd L_d = at_jumps_ ? values.at("L_d") : Eigen::MatrixXd();
      return held_output_bound(subject, {{values.at("P"), values.at("L_c"), L_d}},
                               scalar_value(values, "flow_decay"), assumptions);
    }
    const Eigen::MatrixXd& L_d = values.at("L_d");
    const LyapunovRates rates = lyapunov_rates(subject, kind());
    const double a_c = evaluate(rates.a_c, values)(0, 0);
    const double a_d = evaluate(rates.a_d, values)(0, 0);
    return jump_based_bound(subject, values.at("P"), L_d, {a_d / 2.0, a_c / 2.0}, assumptions);
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
  if (!subject.plant.mode().A_d) {
    throw std::invalid_argument(
        "it is about jump maps by matrices; design/A_d may state that of the error");
  }
}

std::vector<Condition> quadratic_conditions(const CertificateSubject& subject, FlowOfError kind,
                                            const MatrixExpression& flow,
                                            const MatrixExpression& reset,
                                            const std::string& source) {
  const MatrixExpression P = symbol("P", flow.rows(), flow.rows());
  const LyapunovRates rates = lyapunov_rates(subject, kind);
  std::vector<Condition> all = rates.domains;
  all.push_back({"P > 0", P, std::nullopt});
  all.push_back({"flow, " + source + "a)", rates.a_c * P - He(P * flow), std::nullopt});
  all.push_back({"jump, " + source + "b)",
                 exponential(rates.a_d) * P - transpose(reset) * P * reset, std::nullopt});
  return all;
}

const Theorem& bernard2022_equation14() {
  static const QuadraticCondition theorem(14, Innovation::kFlowAndJumps, TheoremTimes::kFromT1,
                                          kWithKnownOutput);
  return theorem;
}

const Theorem& bernard2022_equation14_average_dwell_time() {
  static const QuadraticCondition theorem(
      14, Innovation::kFlowAndJumps, TheoremTimes::kAverageDwellTime, kWithKnownOutputForDwellTime);
  return theorem;
}

const Theorem& bernard2022_equation22() {
  static const QuadraticCondition theorem(22, Innovation::kFlow, TheoremTimes::kFromT1,
                                          kWithKnownOutput);
  return theorem;
}

const Theorem& bernard2022_equation22_average_dwell_time() {
  static const QuadraticCondition theorem(22, Innovation::kFlow, TheoremTimes::kAverageDwellTime,
                                          kWithKnownOutputForDwellTime);
  return theorem;
}

const Theorem& bernard2022_equation26() {
  static const QuadraticCondition theorem(26, Innovation::kJumps, TheoremTimes::kUpToT2,
                                          kConverges);
  return theorem;
}

const Theorem& bernard2022_equation26_reverse_average_dwell_time() {
  static const QuadraticCondition theorem(
      26, Innovation::kJumps, TheoremTimes::kReverseAverageDwellTime, kConvergesForDwellTime);
  return theorem;
}

}  // namespace sampled_data_observers
