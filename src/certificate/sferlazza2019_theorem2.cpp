#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include "certificate/exponential_norm.h"
#include "certificate/flown_errors.h"
#include "certificate/form_maximum.h"
#include "certificate/interval_bound.h"
#include "certificate/linear_sampling.h"
#include "certificate/outward.h"
#include "certificate/spectral_norm.h"
#include "certificate/theorems.h"
#include "linear_algebra/matrix_functions.h"
#include "linear_algebra/ordered_linear_algebra.h"
#include "observer/time_varying_gain.h"
#include "sampled_data_observers/plant/linear_flow.h"

namespace sampled_data_observers {
namespace {

/// Of a product of matrices, relative to the product of their absolute values: rounding of the
/// product itself, and of e^{Aτ}.
constexpr double kRounding = 1e-12;

/// With R of P = Rᵀ R, the level is √V with V of sferlazza2019 (9): |R e| just after a sample, and
/// the same until the next one, which makes it
///   ‖R (I − K(τ) C) e^{Aτ} R⁻¹‖ level + ‖R K(τ)‖ |η|.
/// Both factors are computed at the sample, for the τ that came and the gain that the law used, to
/// the bit. By (13), (14) the first one is less than 1 for τ in [T1, T2] where P is the one of the
/// gain. Outside, and in the norm of a P that has nothing to do with the gain, it is what it is.
class Theorem2Bound : public SampledErrorBound {
 public:
  Theorem2Bound(const CertificateSubject& subject, const ErrorAssumptions& assumptions,
                const Eigen::MatrixXd& R, std::unique_ptr<const TimeVaryingGain> gain,
                bool falls = true)
      : SampledErrorBound(subject, assumptions, 1),
        falls_(falls),
        per_error_(raised(norm2(R))),
        n_(R.rows()),
        m_(subject.plant.C().rows()),
        noise_(assumptions.noise),
        C_(subject.plant.C()),
        R_(R),
        inverse_R_(inverse_of(R)),
        gain_(std::move(gain)),
        forward_(subject.plant.A(), Eigen::MatrixXd::Zero(n_, 0)),
        backward_(-subject.plant.A(), Eigen::MatrixXd::Zero(n_, 0)),
        growth_(Eigen::MatrixXd::Identity(n_, n_), subject.plant.A(), inverse_R_, subject.T2,
                flow_growth(subject.plant.A(), subject.T2)),
        square_of_level_(R.transpose() * R, R.cwiseAbs().transpose() * R.cwiseAbs()),
        errors_(subject.plant.A(), flow_growth(subject.plant.A(), subject.T2),
                {inverse_with_rounding(R)}) {}

  Eigen::Index workspace_size() const override {
    const Eigen::Index of_sample =
        kSquares * n_ * n_ + n_ * m_ + m_ * n_ +
        std::max({n_, gain_->workspace_size(), spectral_norm_workspace(n_)});
    return std::max(of_sample, errors_.workspace_size());
  }

 protected:
  void begin_numbers(double error, double* level) const override { *level = per_error_ * error; }
  void narrow_numbers(const Eigen::Ref<const Eigen::MatrixXd>& Q, double* level) const override {
    *level = std::min(*level, raised(std::sqrt(square_of_level_.over(Q))));
  }
  void sample_numbers(const Interval& at, double* level, double* workspace) const override {
    const Factors factors = factors_at(at.tau, workspace);
    const double kept = falls_ && is_foreseen(at.tau) ? std::min(1.0, factors.kept) : factors.kept;
    *level = kept * *level + factors.noise * noise_;
  }
  double error(const Interval& at, const double* level) const override {
    return growth_.at(at.tau) * *level;
  }
  void errors(const Interval& at, const double* level, double* workspace,
              Eigen::Ref<Eigen::VectorXd> bounds) const override {
    errors_.bounds(at.tau, {{0, *level}}, workspace, bounds);
  }
  void error_ellipsoid(const Interval& at, const double* level, double* workspace,
                       Eigen::Ref<Eigen::MatrixXd> Q) const override {
    errors_.ellipsoid(at.tau, {{0, *level}}, workspace, Q);
  }

 private:
  /// Matrices of n x n in the workspace.
  static constexpr Eigen::Index kSquares = 4;

  struct Factors {
    double kept = 0.0;   ///< ‖R (I − K(τ) C) e^{Aτ} R⁻¹‖
    double noise = 0.0;  ///< ‖R K(τ)‖
  };

  Factors factors_at(double tau, double* workspace) const {
    double* flown = workspace;  // e^{Aτ}, then e^{Aτ} R⁻¹
    double* kept = flown + n_ * n_;
    double* product = kept + n_ * n_;
    double* magnitude = product + n_ * n_;
    double* K = magnitude + n_ * n_;
    double* measured = K + n_ * m_;
    double* scratch = measured + m_ * n_;
    const Duration duration = from_seconds(tau);
    backward_.transition(duration, kept, scratch);
    gain_->evaluate(kept, K, scratch);
    multiply(R_.data(), n_, n_, K, m_, product);
    Factors factors;
    factors.noise = spectral_norm_bound(product, n_, m_, scratch) + rounding_of_noise(K);
    forward_.transition(duration, flown, scratch);
    factors.kept = rounding_of_kept(K, flown, magnitude, product, measured);
    multiply(flown, n_, n_, inverse_R_.data(), n_, kept);
    multiply(C_.data(), m_, n_, kept, n_, measured);
    for (Eigen::Index i = 0; i < m_ * n_; ++i) measured[i] = -measured[i];
    for (Eigen::Index j = 0; j < n_; ++j) add_product(K, n_, m_, measured + j * m_, kept + j * n_);
    multiply(R_.data(), n_, n_, kept, n_, product);
    factors.kept += spectral_norm_bound(product, n_, n_, scratch);
    return factors;
  }

  /// Of |R| |K|.
  double rounding_of_noise(const double* K) const {
    double sum = 0.0;
    for (Eigen::Index j = 0; j < m_; ++j) {
      for (Eigen::Index i = 0; i < n_; ++i) {
        double entry = 0.0;
        for (Eigen::Index k = 0; k < n_; ++k) entry += std::abs(R_(i, k) * K[j * n_ + k]);
        sum += entry * entry;
      }
    }
    return kRounding * std::sqrt(sum);
  }

  /// Of |R| (I + |K| |C|) |e^{Aτ}| |R⁻¹|.
  double rounding_of_kept(const double* K, const double* flown, double* a, double* b,
                          double* measured) const {
    const auto add_absolute = [](const double* M, Eigen::Index rows, Eigen::Index inner,
                                 const double* X, Eigen::Index cols, double* Y) {
      for (Eigen::Index j = 0; j < cols; ++j) {
        for (Eigen::Index k = 0; k < inner; ++k) {
          for (Eigen::Index i = 0; i < rows; ++i) {
            Y[j * rows + i] += std::abs(M[k * rows + i] * X[j * inner + k]);
          }
        }
      }
    };
    std::fill_n(a, n_ * n_, 0.0);
    add_absolute(flown, n_, n_, inverse_R_.data(), n_, a);
    std::fill_n(measured, m_ * n_, 0.0);
    add_absolute(C_.data(), m_, n_, a, n_, measured);
    add_absolute(K, n_, m_, measured, n_, a);
    std::fill_n(b, n_ * n_, 0.0);
    add_absolute(R_.data(), n_, n_, a, n_, b);
    return kRounding * std::sqrt(dot(b, b, n_ * n_));
  }

  bool falls_;        ///< whether the level certainly falls at samples in time
  double per_error_;  ///< the level of an error of norm 1, at most
  Eigen::Index n_;
  Eigen::Index m_;
  double noise_;
  Eigen::MatrixXd C_;
  Eigen::MatrixXd R_;
  Eigen::MatrixXd inverse_R_;
  std::unique_ptr<const TimeVaryingGain> gain_;
  LinearFlow forward_;      ///< of ẋ = A x
  LinearFlow backward_;     ///< of ẋ = −A x, as the law has it
  ExponentialNorm growth_;  ///< ‖e^{Aτ} R⁻¹‖
  FormMaximum square_of_level_;
  FlownErrors errors_;  ///< e^{Aτ} R⁻¹ z level, |z| <= 1
};

/// The theorem as printed, or with a rate of convergence.
class Theorem2 : public Theorem {
 public:
  explicit Theorem2(bool has_rate) : has_rate_(has_rate) {}

  std::string name() const override {
    return has_rate_ ? "sferlazza2019_theorem2_rate" : "sferlazza2019_theorem2";
  }

  std::string guarantee() const override {
    return has_rate_ ? "the error converges at the rate decay from sample to sample, in the norm "
                       "of P, for all times between samples from T1 to T2"
                     : "the error converges, and a Lyapunov function of it falls at every sample, "
                       "for all times between samples from T1 to T2";
  }

  std::vector<std::string> observer_types() const override { return {"TimeVaryingGainObserver"}; }

  void require_applicable(const CertificateSubject& subject) const override {
    require_linear_sampling("sferlazza2019", subject);
    if (null_space(subject.plant.C()).cols() != subject.plant.states() - subject.plant.C().rows()) {
      throw std::invalid_argument(
          "sferlazza2019 needs outputs that don't depend on each other: the rows of C are not "
          "linearly independent");
    }
  }

  /// P is the certificate and what the gain is computed from, (25) and (36).
  std::vector<NamedShape> gains(const CertificateSubject& subject) const override {
    return {symmetric_shape("P", subject.plant.states()), scalar_shape("lambda")};
  }

  std::vector<NamedShape> multipliers(const CertificateSubject&) const override { return {}; }

  std::vector<NamedShape> parameters(const CertificateSubject&) const override {
    if (!has_rate_) return {};
    return {scalar_shape("decay")};
  }

  std::string decay_parameter() const override { return has_rate_ ? "decay" : ""; }

  bool is_homogeneous(const CertificateSubject&) const override { return true; }

  /// (21) for the error times e^{decay t}, which flows by A + decay I. That multiplies Ψ by a
  /// scalar, which cancels in (25): with λ = 0 the gain is the same. With λ > 0 it is that of A.
  /// Then V falls at samples by e^{−2 decay τ} or more, where with Ψ of A, μ = e^{−decay τ} and
  /// X = P C⊥ W C⊥ᵀ P, so that M22 = P − X and M21 M11⁻¹ M21ᵀ <= λ² M22,
  ///   P − (X + λ² (P − X))/μ² > 0: (1 − λ²/μ²)/(1 − λ²) P > X/μ²,
  /// which is (21) with another P in its last block.
  std::vector<Condition> conditions(const CertificateSubject& subject) const override {
    const Eigen::Index n = subject.plant.states();
    const MatrixExpression P = symbol("P", n, n);
    const MatrixExpression remains = 1.0 - square("lambda");
    std::vector<Condition> all = domain_of_times(subject.T1, subject.T2);
    all.push_back(not_negative("lambda"));
    all.push_back(
        {"lambda < 1, sferlazza2019 (38)", remains, std::nullopt, Condition::Kind::kPositive});
    MatrixExpression A = subject.plant.A();
    MatrixExpression P_kept = P;
    if (has_rate_) {
      const MatrixExpression decay = symbol("decay");
      const auto left_after = [&](const MatrixExpression& tau) {
        return 1.0 - square("lambda") * exponential(2.0 * decay * tau);
      };
      all.push_back(not_negative("decay"));
      all.push_back({"lambda exp(decay T2) < 1", left_after(subject.T2), std::nullopt,
                     Condition::Kind::kPositive});
      A = A + decay * identity(n);
      P_kept = left_after(time_tau()) * inverse(remains) * P;
    }
    const Eigen::MatrixXd directions = null_space(subject.plant.C());
    if (directions.cols() == 0) {
      // All of the state is measured: (21) is P > 0.
      all.push_back({"P > 0, sferlazza2019 (21)", P, std::nullopt});
      return all;
    }
    // Projected, since directions that are rounded are not quite in the null space: any basis will
    // do, but it must be exact for a proof.
    const MatrixExpression C = subject.plant.C();
    const MatrixExpression complement =
        (identity(n) - transpose(C) * inverse(C * transpose(C)) * C) * directions;
    const MatrixExpression flown_back = exponential(-(time_tau() * A)) * complement;
    all.push_back(
        {"Xi_P(tau) > 0, sferlazza2019 (21)",
         symmetric_blocks(
             {{transpose(flown_back) * P * flown_back, transpose(complement) * P}, {P_kept}}),
         Condition::Range{subject.T1, subject.T2}});
    return all;
  }

  std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const override {
    require_no_disturbance("sferlazza2019", assumptions);
    if (has_rate_ && scalar_value(values, "decay") < 0.0) {
      throw std::invalid_argument("decay must not be negative: V would not fall at samples");
    }
    return std::make_unique<const Theorem2Bound>(subject, assumptions,
                                                 cholesky_root(symmetric_part(values.at("P"))),
                                                 gain_of(subject, values));
  }

 protected:
  /// To the bit, as the gain needs it.
  static Eigen::MatrixXd symmetric_part(const Eigen::MatrixXd& P) {
    return (P + P.transpose()) / 2.0;
  }
  static std::unique_ptr<const TimeVaryingGain> gain_of(const CertificateSubject& subject,
                                                        const NamedMatrices& values) {
    return std::make_unique<const CertificateGain>(
        subject.plant.C(), symmetric_part(values.at("P")), scalar_value(values, "lambda"));
  }

 private:
  bool has_rate_;
};

/// The theorem as printed, with a bound at run time that follows the error in the norm of another
/// matrix Q than the P that the gain is made of. Any Q > 0 will do: what a sample does to |e|_Q is
/// computed when it comes.
class Theorem2InOtherNorm : public Theorem2 {
 public:
  Theorem2InOtherNorm() : Theorem2(false) {}

  std::string name() const override { return "sferlazza2019_theorem2_norm"; }

  std::string guarantee() const override {
    return "as sferlazza2019_theorem2; the bound at run time follows the error in the norm of Q";
  }

  std::vector<NamedShape> multipliers(const CertificateSubject& subject) const override {
    return {symmetric_shape("Q", subject.plant.states())};
  }

  std::vector<Condition> conditions(const CertificateSubject& subject) const override {
    const Eigen::Index n = subject.plant.states();
    std::vector<Condition> all = Theorem2::conditions(subject);
    all.push_back({"Q > 0", symbol("Q", n, n), std::nullopt});
    return all;
  }

  std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const override {
    require_no_disturbance("sferlazza2019", assumptions);
    return std::make_unique<const Theorem2Bound>(subject, assumptions,
                                                 cholesky_root(symmetric_part(values.at("Q"))),
                                                 gain_of(subject, values), false);
  }
};

/// sferlazza2019, (17): where all of the state is measured, any P > 0 proves (13) and (14).
class Equation17 : public Theorem {
 public:
  std::string name() const override { return "sferlazza2019_equation17"; }

  std::string guarantee() const override {
    return "each sample keeps the part lambda of the error that the last one left, whatever the "
           "times between samples";
  }

  std::vector<std::string> observer_types() const override { return {"TimeVaryingGainObserver"}; }

  void require_applicable(const CertificateSubject& subject) const override {
    require_linear_sampling("sferlazza2019", subject);
    if (subject.plant.C().rows() != subject.plant.states()) {
      throw std::invalid_argument(
          "sferlazza2019 (17) is about outputs that show all of the state at once: C must be "
          "square and invertible");
    }
  }

  std::vector<NamedShape> gains(const CertificateSubject&) const override {
    return {scalar_shape("lambda")};
  }
  std::vector<NamedShape> multipliers(const CertificateSubject&) const override { return {}; }
  std::vector<NamedShape> parameters(const CertificateSubject&) const override { return {}; }
  bool is_homogeneous(const CertificateSubject&) const override { return true; }

  std::vector<Condition> conditions(const CertificateSubject& subject) const override {
    const MatrixExpression C = subject.plant.C();
    std::vector<Condition> all = domain_of_times(subject.T1, subject.T2);
    all.push_back(not_negative("lambda"));
    all.push_back({"lambda < 1, sferlazza2019 (38)", 1.0 - symbol("lambda"), std::nullopt,
                   Condition::Kind::kPositive});
    all.push_back({"C invertible", C * transpose(C), std::nullopt});
    return all;
  }

  std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const override {
    require_no_disturbance("sferlazza2019", assumptions);
    // (I − K(τ) C) e^{Aτ} = λ I.
    const Eigen::Index n = subject.plant.states();
    return std::make_unique<const Theorem2Bound>(
        subject, assumptions, Eigen::MatrixXd::Identity(n, n),
        std::make_unique<const InverseOutputGain>(subject.plant.C(),
                                                  scalar_value(values, "lambda")));
  }
};

}  // namespace

const Theorem& sferlazza2019_equation17() {
  static const Equation17 theorem;
  return theorem;
}

const Theorem& sferlazza2019_theorem2() {
  static const Theorem2 theorem(false);
  return theorem;
}

const Theorem& sferlazza2019_theorem2_norm() {
  static const Theorem2InOtherNorm theorem;
  return theorem;
}

const Theorem& sferlazza2019_theorem2_rate() {
  static const Theorem2 theorem(true);
  return theorem;
}

}  // namespace sampled_data_observers
