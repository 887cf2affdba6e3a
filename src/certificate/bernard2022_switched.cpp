#include <optional>
#include <stdexcept>
#include <utility>

#include "certificate/bernard2022.h"
#include "certificate/modal_bound.h"
#include "certificate/theorems.h"

namespace sampled_data_observers {
namespace {

std::string between(const ModeMatrices& from, const ModeMatrices& to) {
  return " from mode " + std::to_string(from.label) + " to " + std::to_string(to.label);
}

/// V = (x − x̂)ᵀ P_q (x − x̂) with a matrix for each mode q.
class SwitchedCondition : public LyapunovTheorem {
 public:
  using LyapunovTheorem::LyapunovTheorem;

  std::vector<std::string> observer_types() const override { return {"SwitchedObserver"}; }

  std::vector<NamedShape> multipliers(const CertificateSubject& subject) const override {
    std::vector<NamedShape> all;
    for (const ModeMatrices& mode : subject.plant.modes) {
      all.push_back(symmetric_shape(of_mode("P", mode), subject.plant.states()));
    }
    return all;
  }

  bool is_homogeneous(const CertificateSubject&) const override { return true; }

 protected:
  /// What a certificate says of each mode.
  /// @param L_c, L_d  the names of these gains, or empty
  static std::vector<ModalProof> proofs_of(const CertificateSubject& subject,
                                           const NamedMatrices& values, const std::string& L_c,
                                           const std::string& L_d) {
    const auto gain = [&](const std::string& name, const ModeMatrices& mode) {
      return name.empty() ? Eigen::MatrixXd() : values.at(of_mode(name, mode));
    };
    std::vector<ModalProof> proofs;
    for (const ModeMatrices& mode : subject.plant.modes) {
      proofs.push_back({values.at(of_mode("P", mode)), gain(L_c, mode), gain(L_d, mode)});
    }
    return proofs;
  }

  static MatrixExpression P_of(const ModeMatrices& mode) {
    return symbol(of_mode("P", mode), mode.A.rows(), mode.A.rows());
  }

  static void require_modes(const CertificateSubject& subject) {
    if (subject.plant.modes.size() > 1) return;
    throw std::invalid_argument("it is about switched plants: plant/modes with two or more");
  }
};

/// Theorem 3.1 by (47b) in each mode and (49) between all, with lyapunov_rates(): as example 7.1
/// has it, with a gain in flow, or with one at switches.
class RatesOfModes : public SwitchedCondition {
 public:
  RatesOfModes(std::string name, FlowOfError kind, TheoremTimes times, std::string guarantee)
      : SwitchedCondition(kind, times), name_(std::move(name)), guarantee_(std::move(guarantee)) {}

  std::string name() const override { return name_; }
  std::string guarantee() const override { return guarantee_; }

  void require_applicable(const CertificateSubject& subject) const override {
    require_modes(subject);
    if (outputs_of(subject.plant.mode()).rows() > 0) return;
    throw std::invalid_argument(in_flow() ? "L_c needs a sensor that is `measured: continuous`"
                                          : "L_d needs a sensor that is `measured: at_jumps`");
  }

  std::vector<NamedShape> gains(const CertificateSubject& subject) const override {
    std::vector<NamedShape> all;
    for (const ModeMatrices& mode : subject.plant.modes) {
      all.push_back(matrix_shape(gain_of(mode), mode.A.rows(), outputs_of(mode).rows()));
    }
    return all;
  }

  std::vector<NamedRange> search_ranges(const CertificateSubject& subject) const override {
    if (in_flow()) return {{"flow_decay", flow_decay_range(subject)}};
    return {{"flow_growth", flow_growth_range(subject)}};
  }

  std::vector<Condition> conditions(const CertificateSubject& subject) const override {
    const LyapunovRates rates = lyapunov_rates(subject, kind());
    std::vector<Condition> all = rates.domains;
    for (const ModeMatrices& mode : subject.plant.modes) {
      const MatrixExpression P = P_of(mode);
      const Eigen::MatrixXd& C = outputs_of(mode);
      const MatrixExpression innovation = symbol(gain_of(mode), mode.A.rows(), C.rows()) * C;
      MatrixExpression flow = mode.A;
      MatrixExpression reset = jump_of(mode);
      MatrixExpression& corrected = in_flow() ? flow : reset;
      corrected = corrected - innovation;
      const std::string label = std::to_string(mode.label);
      all.push_back({"P > 0 in mode " + label, P, std::nullopt});
      all.push_back({"flow in mode " + label + ", bernard2022 (47b)", rates.a_c * P - He(P * flow),
                     std::nullopt});
      for (const ModeMatrices& next : subject.plant.modes) {
        all.push_back({"switch" + between(mode, next) + ", bernard2022 (49)",
                       exponential(rates.a_d) * P - transpose(reset) * P_of(next) * reset,
                       std::nullopt});
      }
    }
    return all;
  }

  std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const override {
    if (!in_flow()) {
      return switch_bound(subject, proofs_of(subject, values, "", "L_d"), std::nullopt,
                          assumptions);
    }
    return held_output_bound(subject, proofs_of(subject, values, "L_c", ""),
                             scalar_value(values, "flow_decay"), assumptions);
  }

 private:
  bool in_flow() const { return kind() == FlowOfError::kDecays; }
  const Eigen::MatrixXd& outputs_of(const ModeMatrices& mode) const {
    return in_flow() ? mode.C_c : mode.C_d;
  }
  std::string gain_of(const ModeMatrices& mode) const {
    return of_mode(in_flow() ? "L_c" : "L_d", mode);
  }

  std::string name_;
  std::string guarantee_;
};

/// Section 7.3.2 with a constant gain for each mode: V falls by e^{−2 jump_decay} from just after a
/// switch to just after the next, into any other mode.
class Section732 : public SwitchedCondition {
 public:
  Section732() : SwitchedCondition(FlowOfError::kMayGrow, TheoremTimes::kUpToT2) {}

  std::string name() const override { return "bernard2022_section7_3_2"; }

  std::string guarantee() const override {
    return "the error falls by the factor exp(-jump_decay) or more from switch to switch, in the "
           "norms of the P of their modes, when every switch changes the mode, for all times "
           "between switches in [T1, T2]";
  }

  void require_applicable(const CertificateSubject& subject) const override {
    require_modes(subject);
    if (subject.plant.mode().C_d.rows() > 0) return;
    throw std::invalid_argument("L_d needs a sensor that is `measured: at_jumps`");
  }

  std::vector<NamedShape> gains(const CertificateSubject& subject) const override {
    std::vector<NamedShape> all;
    for (const ModeMatrices& mode : subject.plant.modes) {
      all.push_back(matrix_shape(of_mode("L_d", mode), mode.A.rows(), mode.C_d.rows()));
    }
    return all;
  }

  std::vector<NamedShape> parameters(const CertificateSubject&) const override {
    return {scalar_shape("jump_decay")};
  }

  std::vector<Condition> conditions(const CertificateSubject& subject) const override {
    const MatrixExpression jump_decay = symbol("jump_decay");
    const MatrixExpression kept = exponential(-2.0 * jump_decay);
    std::vector<Condition> all = domain_of_times(subject.T1, subject.T2);
    all.push_back(positive("jump_decay"));
    for (const ModeMatrices& mode : subject.plant.modes) {
      const MatrixExpression P = P_of(mode);
      const MatrixExpression L = symbol(of_mode("L_d", mode), mode.A.rows(), mode.C_d.rows());
      all.push_back({"P > 0 in mode " + std::to_string(mode.label), P, std::nullopt});
      const MatrixExpression cycle =
          (jump_of(mode) - L * mode.C_d) * exponential(time_tau() * MatrixExpression(mode.A));
      for (const ModeMatrices& next : subject.plant.modes) {
        if (&next == &mode) continue;
        all.push_back({"cycle" + between(mode, next) + ", bernard2022 (52)",
                       kept * P - transpose(cycle) * P_of(next) * cycle,
                       Condition::Range{subject.T1, subject.T2}});
      }
    }
    return all;
  }

  std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const override {
    return switch_bound(subject, proofs_of(subject, values, "", "L_d"),
                        scalar_value(values, "jump_decay"), assumptions);
  }
};

}  // namespace

const Theorem& bernard2022_example7_1() {
  static const RatesOfModes theorem(
      "bernard2022_example7_1", FlowOfError::kDecays, TheoremTimes::kFromT1,
      "the error falls by the factor exp(-jump_decay) or more from switch to switch, in the norms "
      "of the P of their modes, for all times between switches of T1 or more, with the continuous "
      "output known at all times");
  return theorem;
}

const Theorem& bernard2022_example7_1_average_dwell_time() {
  static const RatesOfModes theorem(
      "bernard2022_example7_1_average_dwell_time", FlowOfError::kDecays,
      TheoremTimes::kAverageDwellTime,
      "the error falls at the rate decay in the norms of the P of the modes but for a factor "
      "exp((flow_decay - 2 decay) tau N0 / 2), for all switches with an average dwell time: N(t, "
      "s) <= (t - s) / tau + N0, with the continuous output known at all times");
  return theorem;
}

const Theorem& bernard2022_equation49_reverse_average_dwell_time() {
  static const RatesOfModes theorem(
      "bernard2022_equation49_reverse_average_dwell_time", FlowOfError::kMayGrow,
      TheoremTimes::kReverseAverageDwellTime,
      "the error falls at the rate decay in the norms of the P of the modes but for a factor "
      "exp((flow_growth + 2 decay) tau N0 / 2), for all switches with a reverse average dwell "
      "time: N(t, s) >= (t - s) / tau - N0");
  return theorem;
}

const Theorem& bernard2022_section7_3_2() {
  static const Section732 theorem;
  return theorem;
}

}  // namespace sampled_data_observers
