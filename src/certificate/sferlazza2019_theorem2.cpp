#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "linear_sampling.h"
#include "sampled_data_observers/certificate/exponential_norm.h"
#include "sampled_data_observers/certificate/matrix_functions.h"
#include "sampled_data_observers/certificate/sampled_error_bound.h"
#include "sampled_data_observers/observer/time_varying_gain.h"
#include "theorems.h"

namespace sampled_data_observers {
namespace {

constexpr std::size_t kCells = 512;

/// With R of P = Rᵀ R, the level is √V with V of sferlazza2019 (9): |R e| just after a sample, and
/// the same until the next one, which makes it
///   ‖R (I − K(τ) C) e^{Aτ} R⁻¹‖ level + ‖R K(τ)‖ |η|.
/// By (13), (14) the first factor is less than 1 for τ in [T1, T2]. The factors are taken from the
/// gain itself at the ends and in the middle of short intervals of τ, and enlarged by what they
/// differ.
class Theorem2Bound : public SampledErrorBound {
 public:
  Theorem2Bound(const CertificateSubject& subject, const ErrorAssumptions& assumptions,
                const Eigen::MatrixXd& P, const Eigen::MatrixXd& R, double lambda)
      : SampledErrorBound(subject, norm2(R) * assumptions.initial_error),
        noise_(assumptions.noise),
        T1_(subject.T1),
        step_(subject.T2 / static_cast<double>(kCells)),
        growth_(Eigen::MatrixXd::Identity(P.rows(), P.rows()), subject.plant.A(), inverse_of(R),
                subject.T2) {
    const Eigen::MatrixXd& C = subject.plant.C();
    add_cells(subject, CertificateGain(C, P, 0.0), R);
    // Before T1 the gain may change between the two.
    if (lambda > 0.0) add_cells(subject, CertificateGain(C, P, lambda), R);
  }

 protected:
  double next_level(double level, double tau) const override {
    const std::size_t cell = cell_of(tau);
    return std::min(1.0, kept_[cell]) * level + noise_weight_[cell] * noise_;
  }
  double first_level(double level, double tau) const override {
    const std::size_t cell = cell_of(tau);
    const double kept = tau < T1_ ? kept_[cell] : std::min(1.0, kept_[cell]);
    return kept * level + noise_weight_[cell] * noise_;
  }
  double error(double level, double tau) const override { return growth_.at(tau) * level; }
  double first_error(double level, double tau) const override { return error(level, tau); }

 private:
  std::size_t cell_of(double tau) const {
    return static_cast<std::size_t>(std::clamp(tau / step_, 0.0, static_cast<double>(kCells - 1)));
  }

  /// Not less than a smooth function with these values at the ends and in the middle.
  static double upper(double low, double middle, double high) {
    return std::max({low, middle, high}) + std::abs(low - 2.0 * middle + high);
  }

  void add_cells(const CertificateSubject& subject, const TimeVaryingGain& gain,
                 const Eigen::MatrixXd& R) {
    const Eigen::MatrixXd& A = subject.plant.A();
    const Eigen::MatrixXd& C = subject.plant.C();
    const Eigen::MatrixXd inverse_R = inverse_of(R);
    const Eigen::Index n = A.rows();
    Eigen::MatrixXd K(n, C.rows());
    Eigen::VectorXd workspace(gain.workspace_size());
    std::vector<double> kept;
    std::vector<double> noise_weight;
    for (std::size_t i = 0; i <= 2 * kCells; ++i) {
      const double tau = step_ * static_cast<double>(i) / 2.0;
      const Eigen::MatrixXd backward = exponential_of(-A * tau);
      gain.evaluate(backward.data(), K.data(), workspace.data());
      const Eigen::MatrixXd error = exponential_of(A * tau) * inverse_R;
      kept.push_back(norm2(R * (error - K * (C * error))));
      noise_weight.push_back(norm2(R * K));
    }
    kept_.resize(kCells);
    noise_weight_.resize(kCells);
    for (std::size_t i = 0; i < kCells; ++i) {
      const std::size_t at = 2 * i;
      kept_[i] = std::max(kept_[i], upper(kept[at], kept[at + 1], kept[at + 2]));
      noise_weight_[i] = std::max(
          noise_weight_[i], upper(noise_weight[at], noise_weight[at + 1], noise_weight[at + 2]));
    }
  }

  double noise_;
  double T1_;
  double step_;
  ExponentialNorm growth_;            ///< ‖e^{Aτ} R⁻¹‖
  std::vector<double> kept_;          ///< ‖R (I − K(τ) C) e^{Aτ} R⁻¹‖ by intervals of τ
  std::vector<double> noise_weight_;  ///< ‖R K(τ)‖
};

class Theorem2 : public Theorem {
 public:
  std::string name() const override { return "sferlazza2019_theorem2"; }

  std::string guarantee() const override {
    return "the error converges, and a Lyapunov function of it falls at every sample, for all "
           "times between samples from T1 to T2";
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

  std::vector<NamedShape> parameters(const CertificateSubject&) const override { return {}; }

  bool is_homogeneous(const CertificateSubject&) const override { return true; }

  std::vector<Condition> conditions(const CertificateSubject& subject) const override {
    const Eigen::Index n = subject.plant.states();
    const MatrixExpression P = symbol("P", n, n);
    std::vector<Condition> all = {
        {"lambda < 1, sferlazza2019 (38)", 1.0 - square("lambda"), std::nullopt}};
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
    const MatrixExpression flown_back =
        exponential(-(time_tau() * MatrixExpression(subject.plant.A()))) * complement;
    all.push_back({"Xi_P(tau) > 0, sferlazza2019 (21)",
                   symmetric_blocks(
                       {{transpose(flown_back) * P * flown_back, transpose(complement) * P}, {P}}),
                   Condition::Range{subject.T1, subject.T2}});
    return all;
  }

  std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const override {
    require_no_disturbance("sferlazza2019", assumptions);
    // Symmetric to the bit, as the gain needs it.
    const Eigen::MatrixXd P = (values.at("P") + values.at("P").transpose()) / 2.0;
    return std::make_unique<const Theorem2Bound>(subject, assumptions, P, cholesky_root(P),
                                                 scalar_value(values, "lambda"));
  }
};

}  // namespace

const Theorem& sferlazza2019_theorem2() {
  static const Theorem2 theorem;
  return theorem;
}

}  // namespace sampled_data_observers
