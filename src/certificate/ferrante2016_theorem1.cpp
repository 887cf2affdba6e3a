#include <algorithm>
#include <cmath>

#include "certificate/exponential_norm.h"
#include "certificate/ferrante2016_bounds.h"
#include "certificate/flown_errors.h"
#include "certificate/form_maximum.h"
#include "certificate/interval_bound.h"
#include "certificate/linear_sampling.h"
#include "certificate/outward.h"
#include "certificate/theorems.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

Eigen::MatrixXd unit(const CertificateSubject& subject) {
  return Eigen::MatrixXd::Identity(subject.plant.states(), subject.plant.states());
}

/// With R of P = Rᵀ R, the level is |R ε| just before a sample: √V there, V of ferrante2016 (13). A
/// sample with noise η and a flow over τ, ε ← e^{Aτ} ((I − LC) ε − L η), make it
///   ‖R e^{Aτ} (I − LC) R⁻¹‖ level + ‖R e^{Aτ} L‖ |η|,
/// where by (12) the first factor is less than 1 for τ in [T1, T2]. This is how V changes in (19)
/// and (29), with the τ that came rather than the worst one, whether it lies in [T1, T2] or not.
/// Until the next sample the error is e^{Aτ} ((I − LC) R⁻¹ z level − L η) with |z| <= 1. Before the
/// first sample the level is |ε| where the estimate began, and |R ε| may be known there, too.
class Theorem1Bound : public SampledErrorBound {
 public:
  Theorem1Bound(const CertificateSubject& subject, const ErrorAssumptions& assumptions,
                const Eigen::MatrixXd& R, const Eigen::MatrixXd& L, const FlowGrowth& growth)
      : Theorem1Bound(subject, assumptions, R, inverse_of(R), L, growth) {}

  Eigen::Index workspace_size() const override { return errors_.workspace_size(); }

 protected:
  void begin_numbers(double error, double* numbers) const override {
    numbers[kLevel] = error;
    numbers[kWeighted] = kUnknown;
  }
  void narrow_numbers(const Eigen::Ref<const Eigen::MatrixXd>& Q, double* numbers) const override {
    numbers[kWeighted] = raised(std::sqrt(square_of_weighted_.over(Q)));
  }
  void sample_numbers(const Interval& at, double* numbers, double*) const override {
    double& level = numbers[kLevel];
    if (at.is_first) {
      level = first_weight_.at(at.tau) * level;
      const double weighted = numbers[kWeighted];
      if (weighted != kUnknown) {
        level = std::min(level, weighted_weight_.at(at.tau) * weighted);
      }
      return;
    }
    const double weight = weight_.at(at.tau);
    const double kept = is_foreseen(at.tau) ? std::min(1.0, weight) : weight;
    level = kept * level + noise_weight_.at(at.tau) * noise_;
  }
  double error(const Interval& at, const double* numbers) const override {
    const double level = numbers[kLevel];
    if (!at.is_first) return growth_.at(at.tau) * level + noise_growth_.at(at.tau) * noise_;
    const double error = first_growth_.at(at.tau) * level;
    const double weighted = numbers[kWeighted];
    if (weighted == kUnknown) return error;
    return std::min(error, weighted_growth_.at(at.tau) * weighted);
  }
  void errors(const Interval& at, const double* numbers, double* workspace,
              Eigen::Ref<Eigen::VectorXd> bounds) const override {
    errors_.bounds(at.tau, balls(at, numbers), workspace, bounds);
  }
  void error_ellipsoid(const Interval& at, const double* numbers, double* workspace,
                       Eigen::Ref<Eigen::MatrixXd> Q) const override {
    errors_.ellipsoid(at.tau, balls(at, numbers), workspace, Q);
  }

 private:
  enum Entry : Eigen::Index { kLevel, kWeighted, kEntries };
  enum Shape : std::size_t { kAny, kWeightedBall, kKept, kNoise };
  static constexpr double kUnknown = -1.0;

  Theorem1Bound(const CertificateSubject& subject, const ErrorAssumptions& assumptions,
                const Eigen::MatrixXd& R, const Eigen::MatrixXd& inverse_R,
                const Eigen::MatrixXd& L, const FlowGrowth& growth)
      : Theorem1Bound(subject, assumptions, R, inverse_R,
                      (unit(subject) - L * subject.plant.C()) * inverse_R, L, growth) {}

  /// @param kept  (I − LC) R⁻¹
  Theorem1Bound(const CertificateSubject& subject, const ErrorAssumptions& assumptions,
                const Eigen::MatrixXd& R, const Eigen::MatrixXd& inverse_R,
                const Eigen::MatrixXd& kept, const Eigen::MatrixXd& L, const FlowGrowth& growth)
      : SampledErrorBound(subject, assumptions, kEntries),
        noise_(assumptions.noise),
        first_growth_(unit(subject), subject.plant.A(), unit(subject), subject.T2, growth),
        first_weight_(R, subject.plant.A(), unit(subject), subject.T2, growth),
        growth_(unit(subject), subject.plant.A(), kept, subject.T2, growth),
        weight_(R, subject.plant.A(), kept, subject.T2, growth),
        noise_growth_(unit(subject), subject.plant.A(), L, subject.T2, growth),
        noise_weight_(R, subject.plant.A(), L, subject.T2, growth),
        weighted_growth_(unit(subject), subject.plant.A(), inverse_R, subject.T2, growth),
        weighted_weight_(R, subject.plant.A(), inverse_R, subject.T2, growth),
        square_of_weighted_(R.transpose() * R, R.cwiseAbs().transpose() * R.cwiseAbs()),
        errors_(subject.plant.A(), growth, shapes(subject, R, L)) {}

  static std::vector<FlownErrors::Shape> shapes(const CertificateSubject& subject,
                                                const Eigen::MatrixXd& R,
                                                const Eigen::MatrixXd& L) {
    const Eigen::MatrixXd& C = subject.plant.C();
    const Eigen::MatrixXd I = unit(subject);
    const FlownErrors::Shape LC =
        product_with_rounding(L, 0.0 * L, {C, Eigen::MatrixXd::Zero(C.rows(), C.cols())});
    const Eigen::MatrixXd rounding = LC.rounding + 1e-15 * (I + LC.X.cwiseAbs());
    const FlownErrors::Shape inverse_R = inverse_with_rounding(R);
    return {{I, 0.0 * I},
            inverse_R,
            product_with_rounding(I - LC.X, rounding, inverse_R),
            {L, 0.0 * L}};
  }

  FlownErrors::Balls balls(const Interval& at, const double* numbers) const {
    if (!at.is_first) return {{kKept, numbers[kLevel]}, {kNoise, noise_}};
    if (numbers[kWeighted] == kUnknown) return {{kAny, numbers[kLevel]}};
    return {{kWeightedBall, numbers[kWeighted]}};
  }

  double noise_;
  ExponentialNorm first_growth_;
  ExponentialNorm first_weight_;
  ExponentialNorm growth_;
  ExponentialNorm weight_;
  ExponentialNorm noise_growth_;
  ExponentialNorm noise_weight_;
  ExponentialNorm weighted_growth_;
  ExponentialNorm weighted_weight_;
  FormMaximum square_of_weighted_;
  FlownErrors errors_;
};

class Ferrante2016Theorem1 : public Theorem {
 public:
  std::string name() const override { return "ferrante2016_theorem1"; }

  std::string guarantee() const override {
    return "the error converges exponentially, at the rate decay from sample to sample, for all "
           "times between samples from T1 to T2, and stays bounded under bounded noise";
  }

  std::vector<std::string> observer_types() const override { return {"ConstantGainObserver"}; }

  void require_applicable(const CertificateSubject& subject) const override {
    require_linear_sampling("ferrante2016", subject);
  }

  std::vector<NamedShape> gains(const CertificateSubject& subject) const override {
    return {matrix_shape("L", subject.plant.states(), subject.plant.C().rows())};
  }

  std::vector<NamedShape> multipliers(const CertificateSubject& subject) const override {
    return {symmetric_shape("P", subject.plant.states())};
  }

  std::vector<NamedShape> parameters(const CertificateSubject&) const override {
    return {scalar_shape("decay")};
  }

  std::string decay_parameter() const override { return "decay"; }

  bool is_homogeneous(const CertificateSubject&) const override { return true; }

  /// (12) for the error times e^{decay t}, which flows by A + decay I. With decay = 0 it is (12) as
  /// printed.
  std::vector<Condition> conditions(const CertificateSubject& subject) const override {
    const Eigen::Index n = subject.plant.states();
    const MatrixExpression A = subject.plant.A();
    const MatrixExpression C = subject.plant.C();
    const MatrixExpression P = symbol("P", n, n);
    const MatrixExpression L = symbol("L", n, subject.plant.C().rows());
    const MatrixExpression flow = exponential(time_tau() * (A + symbol("decay") * identity(n)));
    const MatrixExpression step = flow * (identity(n) - L * C);
    std::vector<Condition> all = domain_of_times(subject.T1, subject.T2);
    all.push_back(not_negative("decay"));
    all.push_back({"P > 0", P, std::nullopt});
    all.push_back({"(I - L C)' e^(A' tau) P e^(A tau) (I - L C) - P < 0, ferrante2016 (12)",
                   P - transpose(step) * P * step, Condition::Range{subject.T1, subject.T2}});
    return all;
  }

  std::vector<GuaranteedFigure> guaranteed_figures(const CertificateSubject& subject,
                                                   const NamedMatrices& values) const override {
    const Ferrante2016Bounds bounds = ferrante2016_bounds(subject, values);
    return {{"gamma/2 of (21), the rate in t + j [1/s]", bounds.gamma / 2.0},
            {"sqrt(alpha_2/alpha_1) e^(R/2) of (21), the factor on the initial error",
             std::sqrt(bounds.alpha_2 / bounds.alpha_1) * std::exp(bounds.R / 2.0)},
            {"gain of (35) from the noise to the error", bounds.noise_gain}};
  }

  std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const override {
    require_no_disturbance("ferrante2016", assumptions);
    const Eigen::MatrixXd& L = values.at("L");
    const Eigen::MatrixXd R = cholesky_root(values.at("P"));
    return std::make_unique<const Theorem1Bound>(subject, assumptions, R, L,
                                                 flow_growth(subject.plant.A(), subject.T2));
  }
};

}  // namespace

const Theorem& ferrante2016_theorem1() {
  static const Ferrante2016Theorem1 theorem;
  return theorem;
}

}  // namespace sampled_data_observers
