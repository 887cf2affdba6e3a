#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "certificate/bound_flow.h"
#include "certificate/ferrante2019_matrix.h"
#include "certificate/interval_bound.h"
#include "certificate/outward.h"
#include "certificate/sublevel_set.h"
#include "certificate/theorems.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// Bounds of V(x) = εᵀ P1 ε + e^{δτ} θ̃ᵀ P2 θ̃, ferrante2019 (27), for (A1) and (A2).
struct LyapunovBounds {
  double alpha_1 = 0.0;  ///< λ_min(P1)
  double alpha_2 = 0.0;  ///< λ_max(P1)
  double omega_2 = 0.0;  ///< λ_max(P2) e^{δ T2}
};

LyapunovBounds bounds_of_V(const CertificateSubject& subject, const NamedMatrices& values) {
  const Eigen::VectorXd of_P1 = symmetric_eigenvalues(values.at("P1"));
  return {least_eigenvalue_below(values.at("P1")), raised(of_P1(of_P1.size() - 1)),
          largest_eigenvalue_above(values.at("P2")) *
              std::exp(scalar_value(values, "delta") * subject.T2)};
}

/// V where the estimate begins, at most, for an error of norm 1 and without injection: θ̃ = C ε.
double initial_V(const CertificateSubject& subject, const NamedMatrices& values) {
  const Eigen::MatrixXd& C = subject.plant.C();
  const double e = std::exp(scalar_value(values, "delta") * subject.T2);
  return largest_eigenvalue_above(values.at("P1") + e * C.transpose() * values.at("P2") * C);
}

/// W >= V with the timer τ set as if the next sample came T2 after the last: that decides nothing
/// of the flow, and at an earlier sample V falls all the more. So
///   Ẇ = −2 λ W + γ² |w|² between samples (18), W⁺ = W + ω2 |η|² at them (19),
/// and |ε|² <= W / λ_min(P1), ε_j² <= W (P1⁻¹)_jj. T1 plays no part. Later than T2 after a sample
/// the timer stands still: then V̇ lacks −δ e^{δτ} θ̃ᵀ P2 θ̃ and Ẇ = (δ − 2 λ) W + γ² |w|², until the
/// next sample.
class LyapunovErrorBound : public SampledErrorBound {
 public:
  LyapunovErrorBound(const CertificateSubject& subject, const NamedMatrices& values, double rate,
                     const ErrorAssumptions& assumptions)
      : SampledErrorBound(subject, assumptions, kEntries),
        rate_(2.0 * rate),
        late_growth_(std::max(0.0, scalar_value(values, "delta")) - rate_) {
    const LyapunovBounds V = bounds_of_V(subject, values);
    if (subject.plant.N.cols() > 0 && values.count("gamma") > 0) {
      const double level = scalar_value(values, "gamma") * assumptions.disturbance;
      push_ = level * level;
      final_ = push_ / rate_;
    }
    per_sample_ = V.omega_2 * assumptions.noise * assumptions.noise;
    least_ = positive_least_eigenvalue(values.at("P1"), "P1");
    set_ = SublevelSet(values.at("P1"), least_);
    of_estimate_ = V.alpha_2;
    // θ̃ = C ε − θ at first, and √V is a norm of (ε, θ̃).
    root_per_error_ = std::sqrt(initial_V(subject, values));
    root_of_injection_ = std::sqrt(V.omega_2) * assumptions.initial_injection;
    const Eigen::MatrixXd& C = subject.plant.C();
    const Eigen::MatrixXd& P2 = values.at("P2");
    const double e = std::exp(scalar_value(values, "delta") * subject.T2);
    const Eigen::MatrixXd size = e * C.cwiseAbs().transpose() * P2.cwiseAbs() * C.cwiseAbs();
    initial_V_ = {values.at("P1") + e * C.transpose() * P2 * C, values.at("P1").cwiseAbs() + size};
  }

  bool injects_between_samples() const override { return true; }

 protected:
  void begin_numbers(double error, double* numbers) const override {
    const double root = root_per_error_ * error + root_of_injection_;
    numbers[kW] = root * root;
    numbers[kOfEstimate] = of_estimate_ * error * error;
  }
  void narrow_numbers(const Eigen::Ref<const Eigen::MatrixXd>& Q, double* numbers) const override {
    const double root = std::sqrt(initial_V_.over(Q)) + root_of_injection_;
    numbers[kW] = std::min(numbers[kW], raised(root * root));
    const double of_estimate = raised(std::pow(set_.radius_around(Q), 2));
    numbers[kOfEstimate] = std::min(numbers[kOfEstimate], of_estimate);
  }
  void flow_numbers(double duration, const Interval& from, double* numbers) const override {
    double& W = numbers[kW];
    const double foreseen = foreseen_part(duration, from.tau);
    W = decayed(W, final_, rate_, foreseen);
    if (is_late(from.tau + duration)) {
      W = flowed_linearly(W, late_growth_, push_, duration - foreseen);
    }
  }
  void sample_numbers(const Interval& at, double* numbers, double*) const override {
    // A sample sets θ̃ to −η: of V, only ε's part stays. How large that is, is known at first only.
    const bool has_flowed = !at.is_first || at.tau > 0.0;
    numbers[kW] = numbers[has_flowed ? kW : kOfEstimate] + per_sample_;
  }
  double error(const Interval&, const double* numbers) const override {
    return std::sqrt(numbers[kW] / least_);
  }
  void errors(const Interval&, const double* numbers, double*,
              Eigen::Ref<Eigen::VectorXd> bounds) const override {
    set_.bounds(std::sqrt(numbers[kW]), bounds);
  }
  void error_ellipsoid(const Interval&, const double* numbers, double*,
                       Eigen::Ref<Eigen::MatrixXd> Q) const override {
    set_.ellipsoid(std::sqrt(numbers[kW]), Q);
  }

 private:
  enum Entry { kW, kOfEstimate, kEntries };  // W, and what of it is ε's where the estimate begins

  double rate_;                     // 2 λ
  double late_growth_;              // δ − 2 λ
  double push_ = 0.0;               // γ² |w|²
  double final_ = 0.0;              // of W, without noise
  double per_sample_ = 0.0;         // ω2 |η|²
  double of_estimate_ = 0.0;        // εᵀ P1 ε of |ε| = 1
  double root_per_error_ = 0.0;     // √V at first, of |ε| = 1
  double root_of_injection_ = 0.0;  // and of θ
  double least_ = 0.0;              // λ_min(P1)
  SublevelSet set_;                 // of εᵀ P1 ε
  FormMaximum initial_V_;           // V at first, of ε without θ
};

/// Theorem 2, and its corollaries for a rate only and for a gain only.
struct Variant {
  std::string name;
  std::string guarantee;
  std::string number;
  bool has_rate = true;
  bool has_gain = true;
};

class Ferrante2019Theorem : public Theorem {
 public:
  explicit Ferrante2019Theorem(Variant variant) : variant_(std::move(variant)) {}

  std::string name() const override { return variant_.name; }
  std::string guarantee() const override { return variant_.guarantee; }
  std::vector<std::string> observer_types() const override {
    return {"IntersampleInjectionObserver"};
  }

  void require_applicable(const CertificateSubject& subject) const override {
    const PlantMatrices& plant = subject.plant;
    if (plant.modes.size() > 1 || plant.jumps()) {
      throw std::invalid_argument("ferrante2019 is about plants that do not jump");
    }
    if (plant.C().rows() == 0) throw std::invalid_argument("ferrante2019 needs a sampled sensor");
    if (!plant.is_linear() && !plant.lipschitz_constant) {
      throw std::invalid_argument("ferrante2019 needs plant/lipschitz_constant");
    }
    if (!variant_.has_rate && plant.N.cols() == 0) {
      throw std::invalid_argument(name() + " is about the gain from a disturbance: give design/N");
    }
  }

  std::vector<NamedShape> gains(const CertificateSubject& subject) const override {
    const auto [n, m] = sizes(subject);
    return {matrix_shape("L", n, m), matrix_shape("H", m, m)};
  }

  std::vector<NamedShape> multipliers(const CertificateSubject& subject) const override {
    const auto [n, m] = sizes(subject);
    std::vector<NamedShape> all = {symmetric_shape("P1", n), symmetric_shape("P2", m)};
    if (!subject.plant.is_linear()) all.push_back(scalar_shape("chi"));
    return all;
  }

  std::vector<NamedShape> parameters(const CertificateSubject& subject) const override {
    std::vector<NamedShape> all = {scalar_shape("delta")};
    if (variant_.has_rate) all.push_back(scalar_shape("lambda_t"));
    if (relevant(subject).N.cols() > 0) all.push_back(scalar_shape("gamma"));
    return all;
  }

  std::string decay_parameter() const override { return variant_.has_rate ? "lambda_t" : ""; }

  std::vector<NamedRange> search_ranges(const CertificateSubject& subject) const override {
    return {{"delta", {0.1 / subject.T2, 30.0 / subject.T2, true}}};
  }

  bool is_homogeneous(const CertificateSubject& subject) const override {
    const PlantMatrices plant = relevant(subject);
    return plant.N.cols() == 0 && plant.C_p.rows() == 0;
  }

  std::vector<Condition> conditions(const CertificateSubject& subject) const override {
    const auto [n, m] = sizes(subject);
    std::vector<Condition> all = domain_of_times(subject.T1, subject.T2);
    for (const NamedShape& parameter : parameters(subject)) all.push_back(positive(parameter.name));
    if (!subject.plant.is_linear()) {
      all.push_back({"lipschitz_constant >= 0", *subject.plant.lipschitz_constant, std::nullopt,
                     Condition::Kind::kNonNegative});
      all.push_back(positive("chi"));
    }
    all.push_back({"P1 > 0", symbol("P1", n, n), std::nullopt});
    all.push_back({"P2 > 0", symbol("P2", m, m), std::nullopt});
    all.push_back({"M(0) <= 0, ferrante2019 " + variant_.number, -M(subject, 1.0), std::nullopt});
    all.push_back({"M(T2) <= 0, ferrante2019 " + variant_.number,
                   -M(subject, exponential(symbol("delta") * MatrixExpression(subject.T2))),
                   std::nullopt});
    return all;
  }

  std::vector<GuaranteedFigure> guaranteed_figures(const CertificateSubject& subject,
                                                   const NamedMatrices& values) const override {
    const LyapunovBounds V = bounds_of_V(subject, values);
    const double lambda = rate(subject, values);
    std::vector<GuaranteedFigure> figures;
    if (!variant_.has_rate) figures.push_back({"rate of convergence [1/s]", lambda});
    figures.push_back({"error over initial error, at most, without noise and disturbance",
                       std::sqrt(initial_V(subject, values) / V.alpha_1)});
    // (22) with the limit of its geometric series, and with λ_min(P1) for ρ1, since only ε counts.
    const double series = 1.0 / (1.0 - std::exp(-2.0 * lambda * subject.T1));
    figures.push_back(
        {"final error over noise [state/output]", std::sqrt(V.omega_2 * series / V.alpha_1)});
    if (relevant(subject).C_p.rows() > 0) {
      // Of Theorem 1 (ii), where the root of V is printed as V: α = √ρ2.
      figures.push_back(
          {"L2 norm of the performance output over the initial norm of error and injection's error",
           std::sqrt(std::max(V.alpha_2, V.omega_2))});
    }
    if (relevant(subject).N.cols() > 0) {
      figures.push_back({"final error over disturbance [state/w]",
                         scalar_value(values, "gamma") / std::sqrt(2.0 * lambda * V.alpha_1)});
    }
    return figures;
  }

  std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const override {
    if (!variant_.has_gain && assumptions.disturbance > 0.0) {
      throw std::invalid_argument("it is about plants without disturbance");
    }
    return std::make_unique<const LyapunovErrorBound>(subject, values, rate(subject, values),
                                                      assumptions);
  }

 private:
  struct Sizes {
    Eigen::Index n;
    Eigen::Index m;
  };
  static Sizes sizes(const CertificateSubject& subject) {
    return {subject.plant.states(), subject.plant.C().rows()};
  }

  /// What the inequalities speak of. Without the row of w, C_pᵀ C_p says nothing either: the other
  /// terms may be scaled until they outweigh it.
  PlantMatrices relevant(const CertificateSubject& subject) const {
    PlantMatrices plant = subject.plant;
    if (!variant_.has_gain) {
      plant.N.resize(plant.states(), 0);
      plant.C_p.resize(0, plant.states());
    }
    return plant;
  }

  MatrixExpression M(const CertificateSubject& subject, const MatrixExpression& e) const {
    const auto [n, m] = sizes(subject);
    const MatrixExpression L = symbol("L", n, m);
    const MatrixExpression P2_CL_H =
        symbol("P2", m, m) * (MatrixExpression(subject.plant.C()) * L + symbol("H", m, m));
    return ferrante2019_M(relevant(subject), e, variant_.has_rate ? symbol("lambda_t") : 0.0,
                          symbol("P1", n, n) * L, P2_CL_H);
  }

  /// λ_t, or β/(2 ρ2) of Corollary 2. M is affine in e^{δτ}: its largest eigenvalue is at an end.
  double rate(const CertificateSubject& subject, const NamedMatrices& values) const {
    if (variant_.has_rate) return scalar_value(values, "lambda_t");
    const MatrixExpression at_T2 =
        M(subject, exponential(symbol("delta") * MatrixExpression(subject.T2)));
    // With room for the rounding of M, not of its eigenvalues alone.
    const auto above = [&](const MatrixExpression& expression) {
      const Eigen::MatrixXd value = evaluate(expression, values);
      return max_eigenvalue(value) + 1e3 * eigenvalue_rounding(value.rows(), value.norm());
    };
    const double beta = -std::max(above(M(subject, 1.0)), above(at_T2));
    const LyapunovBounds V = bounds_of_V(subject, values);
    return beta / (2.0 * std::max(V.alpha_2, V.omega_2));
  }

  Variant variant_;
};

}  // namespace

const Theorem& ferrante2019_theorem2() {
  static const Ferrante2019Theorem theorem(
      {"ferrante2019_theorem2",
       "the error converges at the rate lambda_t, and its performance output has the L2 gain gamma "
       "from the disturbance, for all times between samples up to T2",
       "(28)", true, true});
  return theorem;
}

const Theorem& ferrante2019_corollary1() {
  static const Ferrante2019Theorem theorem({"ferrante2019_corollary1",
                                            "without disturbance the error converges at the rate "
                                            "lambda_t, for all times between samples "
                                            "up to T2",
                                            "(32)", true, false});
  return theorem;
}

const Theorem& ferrante2019_corollary2() {
  static const Ferrante2019Theorem theorem({"ferrante2019_corollary2",
                                            "the error converges, and its performance output has "
                                            "the L2 gain gamma from the disturbance, "
                                            "for all times between samples up to T2",
                                            "(33)", false, true});
  return theorem;
}

}  // namespace sampled_data_observers
