#include <stdexcept>
#include <string>
#include <utility>

#include "certificate/bernard2022.h"
#include "certificate/theorems.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// Corollary 5.2 and section 7.3.2 of bernard2022 with the gain L(τ) of a metric (MetricGain),
/// which is eliminated as in sferlazza2019: for V = eᵀ P_q e and Ψ = e^{−Aᵀτ} P_q e^{−Aτ}, before a
/// jump V was eᵀ Ψ e. L(τ) makes e⁺ = A_d e' of it, where e' is in the null space of H and e'ᵀ Ψ e'
/// <= eᵀ Ψ e. So V falls by e^{−2 jump_decay} where, for N that spans that null space,
///
///   Nᵀ (e^{−2 jump_decay} Ψ − A_dᵀ P_q' A_d) N > 0,
///
/// and no gain does better, since e itself may be in it. That supposes that the gain is L(τ): where
/// rounding hides that the outputs are independent, MetricGain takes L(0) instead.
class MetricCondition : public Theorem {
 public:
  MetricCondition(std::string name, std::string observer_type, std::string guarantee)
      : name_(std::move(name)),
        observer_type_(std::move(observer_type)),
        guarantee_(std::move(guarantee)) {}

  std::string name() const override { return name_; }
  std::string guarantee() const override { return guarantee_; }
  std::vector<std::string> observer_types() const override { return {observer_type_}; }

  void require_applicable(const CertificateSubject& subject) const override {
    if (!is_switched()) {
      require_linear_jumping_plant(subject);
      if (!subject.plant.stated.is_empty()) {
        throw std::invalid_argument("it is about the plant's own maps, not stated ones");
      }
    } else if (subject.plant.modes.size() < 2) {
      throw std::invalid_argument("it is about switched plants: plant/modes with two or more");
    }
    for (const ModeMatrices& mode : subject.plant.modes) {
      if (mode.C_d.rows() == 0) {
        throw std::invalid_argument("a metric needs a sensor that is `measured: at_jumps`");
      }
      if (null_space(mode.C_d).cols() != mode.C_d.cols() - mode.C_d.rows()) {
        throw std::invalid_argument("its outputs at jumps must not depend on each other");
      }
    }
  }

  std::vector<NamedShape> gains(const CertificateSubject& subject) const override {
    std::vector<NamedShape> all;
    for (const ModeMatrices& mode : subject.plant.modes) {
      all.push_back(symmetric_shape(metric_of(mode), mode.A.rows()));
    }
    return all;
  }

  std::vector<NamedShape> multipliers(const CertificateSubject&) const override { return {}; }
  std::vector<NamedShape> parameters(const CertificateSubject&) const override {
    return {scalar_shape("jump_decay")};
  }

  bool is_homogeneous(const CertificateSubject&) const override { return true; }

  std::string decay_parameter() const override { return "jump_decay"; }
  GuaranteedFigure decay_figure(const NamedMatrices& values) const override {
    return jump_decay_figure(values);
  }

  std::vector<Condition> conditions(const CertificateSubject& subject) const override {
    const MatrixExpression kept = exponential(-2.0 * symbol("jump_decay"));
    std::vector<Condition> all = domain_of_times(subject.T1, subject.T2);
    all.push_back(positive("jump_decay"));
    for (const ModeMatrices& mode : subject.plant.modes) {
      all.push_back({"P > 0" + in(mode), P_of(mode), std::nullopt});
      if (mode.C_d.rows() > 1) all.push_back(independent_outputs(subject, mode));
      const Eigen::MatrixXd directions = null_space(mode.C_d);
      if (directions.cols() == 0) continue;  // all of the state is measured
      // Projected, since directions that are rounded are not quite in the null space: any basis
      // will do, but it must be exact for a proof.
      const Eigen::Index n = mode.A.rows();
      const MatrixExpression H = mode.C_d;
      const MatrixExpression N =
          (identity(n) - transpose(H) * inverse(H * transpose(H)) * H) * directions;
      const MatrixExpression back = exponential(-(time_tau() * MatrixExpression(mode.A))) * N;
      const MatrixExpression after = MatrixExpression(jump_of(mode)) * N;
      for (const ModeMatrices& next : subject.plant.modes) {
        if (is_switched() && &next == &mode) continue;
        all.push_back(
            {"jump" + in(mode) + (is_switched() ? " to" + in(next).substr(3) : "") +
                 ", bernard2022 (52), sferlazza2019 (21)",
             kept * (transpose(back) * P_of(mode) * back) - transpose(after) * P_of(next) * after,
             Condition::Range{subject.T1, subject.T2}});
      }
    }
    return all;
  }

  std::unique_ptr<const ErrorBound> error_bound(const CertificateSubject&, const NamedMatrices&,
                                                const ErrorAssumptions&) const override {
    // What the noise of an output adds depends on τ.
    return nullptr;
  }

 private:
  bool is_switched() const { return observer_type_ == "SwitchedObserver"; }
  std::string in(const ModeMatrices& mode) const {
    return is_switched() ? " in mode " + std::to_string(mode.label) : "";
  }
  /// W − c diag(W) > 0 with W = H Ψ⁻¹ Hᵀ: of each row of H Ψ^{−1/2} more than √c of its length is
  /// across the others.
  Condition independent_outputs(const CertificateSubject& subject, const ModeMatrices& mode) const {
    constexpr double kShare = 1e-10;
    const Eigen::Index m = mode.C_d.rows();
    const MatrixExpression moved =
        MatrixExpression(mode.C_d) * exponential(time_tau() * MatrixExpression(mode.A));
    const MatrixExpression W = moved * inverse(P_of(mode)) * transpose(moved);
    MatrixExpression independent = W;
    for (Eigen::Index i = 0; i < m; ++i) {
      Eigen::MatrixXd only = Eigen::MatrixXd::Zero(m, m);
      only(i, i) = 1.0;
      independent = independent - kShare * (MatrixExpression(only) * W * only);
    }
    return {kIndependentOutputs + in(mode), independent, Condition::Range{subject.T1, subject.T2}};
  }
  std::string metric_of(const ModeMatrices& mode) const {
    return is_switched() ? of_mode("metric", mode) : "metric";
  }
  MatrixExpression P_of(const ModeMatrices& mode) const {
    return symbol(metric_of(mode), mode.A.rows(), mode.A.rows());
  }

  std::string name_;
  std::string observer_type_;
  std::string guarantee_;
};

}  // namespace

const Theorem& bernard2022_corollary5_2_metric() {
  static const MetricCondition theorem(
      "bernard2022_corollary5_2_metric", "SynchronizedObserver",
      "the error falls by the factor exp(-jump_decay) or more from jump to jump, in the norm of "
      "the metric, for all times between jumps in [T1, T2]");
  return theorem;
}

const Theorem& bernard2022_section7_3_2_metric() {
  static const MetricCondition theorem(
      "bernard2022_section7_3_2_metric", "SwitchedObserver",
      "the error falls by the factor exp(-jump_decay) or more from switch to switch, in the norms "
      "of the metrics of their modes, when every switch changes the mode, for all times between "
      "switches in [T1, T2]");
  return theorem;
}

}  // namespace sampled_data_observers
