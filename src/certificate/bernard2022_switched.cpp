#include <stdexcept>

#include "certificate/bernard2022.h"
#include "certificate/modal_bound.h"
#include "certificate/theorems.h"

namespace sampled_data_observers {
namespace {

std::string between(const ModeMatrices& from, const ModeMatrices& to) {
  return " from mode " + std::to_string(from.label) + " to " + std::to_string(to.label);
}

/// V = (x − x̂)ᵀ P_q (x − x̂) with a matrix for each mode q.
class SwitchedCondition : public Theorem {
 public:
  std::vector<std::string> observer_types() const override { return {"SwitchedObserver"}; }

  std::vector<NamedShape> multipliers(const CertificateSubject& subject) const override {
    std::vector<NamedShape> all;
    for (const ModeMatrices& mode : subject.plant.modes) {
      all.push_back(symmetric_shape(of_mode("P", mode), subject.plant.states()));
    }
    return all;
  }

  bool is_homogeneous(const CertificateSubject&) const override { return true; }

  std::string decay_parameter() const override { return "jump_decay"; }
  GuaranteedFigure decay_figure(const NamedMatrices& values) const override {
    return jump_decay_figure(values);
  }

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

/// Example 7.1 with (C1a): (47b) in each mode with a_c = −flow_decay, and (49) between all with
/// a_d = flow_decay T1 − 2 jump_decay.
class Example71 : public SwitchedCondition {
 public:
  std::string name() const override { return "bernard2022_example7_1"; }

  std::string guarantee() const override {
    return "the error falls by the factor exp(-jump_decay) or more from switch to switch, in the "
           "norms of the P of their modes, for all times between switches of T1 or more, with the "
           "continuous output known at all times";
  }

  void require_applicable(const CertificateSubject& subject) const override {
    require_modes(subject);
    if (subject.plant.mode().C_c.rows() > 0) return;
    throw std::invalid_argument("L_c needs a sensor that is `measured: continuous`");
  }

  std::vector<NamedShape> gains(const CertificateSubject& subject) const override {
    std::vector<NamedShape> all;
    for (const ModeMatrices& mode : subject.plant.modes) {
      all.push_back(matrix_shape(of_mode("L_c", mode), mode.A.rows(), mode.C_c.rows()));
    }
    return all;
  }

  std::vector<NamedShape> parameters(const CertificateSubject&) const override {
    return {scalar_shape("flow_decay"), scalar_shape("jump_decay")};
  }

  std::vector<NamedRange> search_ranges(const CertificateSubject& subject) const override {
    return {{"flow_decay", flow_decay_range(subject)}};
  }

  std::vector<Condition> conditions(const CertificateSubject& subject) const override {
    const MatrixExpression flow_decay = symbol("flow_decay");
    const MatrixExpression jump_decay = symbol("jump_decay");
    const MatrixExpression a_c = -flow_decay;
    const MatrixExpression a_d = flow_decay * MatrixExpression(subject.T1) - 2.0 * jump_decay;
    std::vector<Condition> all = domain_of_times(subject.T1, subject.T2);
    all.push_back({"a_c < 0", flow_decay, std::nullopt, Condition::Kind::kPositive});
    all.push_back(positive("jump_decay"));
    for (const ModeMatrices& mode : subject.plant.modes) {
      const MatrixExpression P = P_of(mode);
      const MatrixExpression L = symbol(of_mode("L_c", mode), mode.A.rows(), mode.C_c.rows());
      const std::string label = std::to_string(mode.label);
      all.push_back({"P > 0 in mode " + label, P, std::nullopt});
      all.push_back({"flow in mode " + label + ", bernard2022 (47b)",
                     a_c * P - He(P * (mode.A - L * mode.C_c)), std::nullopt});
      const MatrixExpression A_d = jump_of(mode);
      for (const ModeMatrices& next : subject.plant.modes) {
        all.push_back({"switch" + between(mode, next) + ", bernard2022 (49)",
                       exponential(a_d) * P - transpose(A_d) * P_of(next) * A_d, std::nullopt});
      }
    }
    return all;
  }

  std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const override {
    return held_output_bound(subject, proofs_of(subject, values, "L_c", ""),
                             scalar_value(values, "flow_decay"), assumptions);
  }
};

/// Section 7.3.2 with a constant gain for each mode: V falls by e^{−2 jump_decay} from just after a
/// switch to just after the next, into any other mode.
class Section732 : public SwitchedCondition {
 public:
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
  static const Example71 theorem;
  return theorem;
}

const Theorem& bernard2022_section7_3_2() {
  static const Section732 theorem;
  return theorem;
}

}  // namespace sampled_data_observers
