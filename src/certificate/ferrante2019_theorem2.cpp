#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "sampled_data_observers/certificate/matrix_functions.h"
#include "theorems.h"

namespace sampled_data_observers {
namespace {

/// W >= V(x) = εᵀ P1 ε + e^{δτ} θ̃ᵀ P2 θ̃ of ferrante2019 (27): between samples
/// Ẇ = −2 λ_t W + γ² |w|² (18), at a sample W⁺ = W + λ_max(P2) e^{δ T2} |η|² (19).
class Theorem2Bound : public ErrorBound {
 public:
  Theorem2Bound(const CertificateSubject& subject, const NamedMatrices& values,
                const ErrorAssumptions& assumptions)
      : T2_(subject.T2) {
    const Eigen::MatrixXd& P1 = values.at("P1");
    const double omega_2 =
        max_eigenvalue(values.at("P2")) * std::exp(scalar_value(values, "delta") * subject.T2);
    const double decay = 2.0 * scalar_value(values, "lambda_t");
    // The held innovation starts at zero: θ̃ = C ε.
    const double initial_theta = norm2(subject.plant.C()) * assumptions.initial_error;
    initial_ = max_eigenvalue(P1) * assumptions.initial_error * assumptions.initial_error +
               omega_2 * initial_theta * initial_theta;
    rate_ = decay;
    if (subject.plant.N.cols() > 0) {
      const double gamma = scalar_value(values, "gamma");
      const double level = gamma * assumptions.disturbance;
      final_ = level * level / decay;
    }
    per_sample_ = omega_2 * assumptions.noise * assumptions.noise;
    least_ = min_eigenvalue(P1);
  }

  // W, and the time since the last sample [s].
  Eigen::Index state_size() const override { return 2; }
  void initialize(double* state) const override {
    state[0] = initial_;
    state[1] = 0.0;
  }
  void flow(double duration, double* state) const override {
    state[1] += duration;
    state[0] = final_ + (state[0] - final_) * std::exp(-rate_ * duration);
    if (state[1] > T2_) state[0] = std::numeric_limits<double>::infinity();
  }
  void sample(double* state) const override {
    state[0] += per_sample_;
    state[1] = 0.0;
  }
  void jump(double*) const override {}
  double bound(const double* state) const override { return std::sqrt(state[0] / least_); }

 private:
  double T2_;
  double initial_ = 0.0;
  double rate_ = 0.0;
  double final_ = 0.0;
  double per_sample_ = 0.0;
  double least_ = 0.0;
};

class Theorem2 : public Theorem {
 public:
  std::string name() const override { return "ferrante2019_theorem2"; }

  std::string guarantee() const override {
    return "the error converges at the rate lambda_t, and its performance output has the L2 gain "
           "gamma from the disturbance, for all times between samples up to T2";
  }

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
    std::vector<NamedShape> all = {scalar_shape("delta"), scalar_shape("lambda_t")};
    if (subject.plant.N.cols() > 0) all.push_back(scalar_shape("gamma"));
    return all;
  }

  std::string decay_parameter() const override { return "lambda_t"; }

  std::vector<NamedRange> search_ranges(const CertificateSubject& subject) const override {
    return {{"delta", {0.1 / subject.T2, 30.0 / subject.T2, true}}};
  }

  bool is_homogeneous(const CertificateSubject& subject) const override {
    return subject.plant.N.cols() == 0 && subject.plant.C_p.rows() == 0;
  }

  std::vector<Condition> conditions(const CertificateSubject& subject) const override {
    const auto [n, m] = sizes(subject);
    std::vector<Condition> all = {
        {"P1 > 0", symbol("P1", n, n), std::nullopt},
        {"P2 > 0", symbol("P2", m, m), std::nullopt},
        {"M(0) <= 0, ferrante2019 (28)", -M(subject, 1.0), std::nullopt},
        {"M(T2) <= 0, ferrante2019 (28)",
         -M(subject, exponential(symbol("delta") * MatrixExpression(subject.T2))), std::nullopt},
    };
    if (!subject.plant.is_linear()) all.push_back({"chi > 0", symbol("chi"), std::nullopt});
    return all;
  }

  std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const override {
    return std::make_unique<const Theorem2Bound>(subject, values, assumptions);
  }

 private:
  struct Sizes {
    Eigen::Index n;
    Eigen::Index m;
  };
  static Sizes sizes(const CertificateSubject& subject) {
    return {subject.plant.states(), subject.plant.C().rows()};
  }

  /// M(τ) of ferrante2019 (30), e = e^{δτ}; the rows of ψ and of w only where the plant has them
  /// (Remark 2).
  static MatrixExpression M(const CertificateSubject& subject, const MatrixExpression& e) {
    const auto [n, m] = sizes(subject);
    const PlantMatrices& plant = subject.plant;
    const MatrixExpression A = plant.A();
    const MatrixExpression C = plant.C();
    const MatrixExpression L = symbol("L", n, m);
    const MatrixExpression H = symbol("H", m, m);
    const MatrixExpression P1 = symbol("P1", n, n);
    const MatrixExpression P2 = symbol("P2", m, m);
    const MatrixExpression delta = symbol("delta");
    const MatrixExpression lambda_t = symbol("lambda_t");

    MatrixExpression corner = He(P1 * (A - L * C)) + 2.0 * lambda_t * P1;
    if (plant.C_p.rows() > 0) corner = corner + Eigen::MatrixXd(plant.C_p.transpose() * plant.C_p);
    std::vector<MatrixExpression> first;
    std::vector<MatrixExpression> second = {e *
                                            (He(P2 * (C * L + H)) + (2.0 * lambda_t - delta) * P2)};
    std::vector<std::vector<MatrixExpression>> rest;
    const MatrixExpression coupling = P1 * L + e * (transpose(C * A - C * L * C - H * C) * P2);
    const auto add_column = [&, C](const MatrixExpression& gain) {
      first.push_back(P1 * gain);
      second.push_back(e * (P2 * C * gain));
    };
    const Eigen::Index n_w = plant.N.cols();
    const Eigen::Index n_s = plant.G.cols();
    if (n_w > 0) {
      add_column(plant.N);
      rest.push_back({-(square("gamma") * identity(n_w))});
      if (n_s > 0) rest.back().push_back(zeros(n_w, n_s));
    }
    if (n_s > 0) {
      add_column(plant.G);
      const double ell = *plant.lipschitz_constant;
      corner =
          corner + symbol("chi") *
                       MatrixExpression(Eigen::MatrixXd(ell * ell * plant.S.transpose() * plant.S));
      rest.push_back({-(symbol("chi") * identity(n_s))});
    }
    first.insert(first.begin(), {corner, coupling});
    std::vector<std::vector<MatrixExpression>> rows = {first, second};
    rows.insert(rows.end(), rest.begin(), rest.end());
    return symmetric_blocks(rows);
  }
};

}  // namespace

const Theorem& ferrante2019_theorem2() {
  static const Theorem2 theorem;
  return theorem;
}

}  // namespace sampled_data_observers
