#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "certificate/bound_flow.h"
#include "certificate/outward.h"
#include "certificate/theorems.h"
#include "certificate/wirtinger.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// R_i = A + Ψ_i, or A alone for a linear plant.
std::vector<Eigen::MatrixXd> flow_vertices_of(const PlantMatrices& plant) {
  if (plant.is_linear()) return {plant.A()};
  std::vector<Eigen::MatrixXd> R;
  for (const Eigen::MatrixXd& vertex : plant.vertices) R.emplace_back(plant.A() + vertex);
  return R;
}

/// V(z) = zᵀ P z of etienne2019, Theorem 1: from a sample on, V̇ = −α V + level² at worst.
/// Until the first sample nothing is injected and the error flows as the plant does; later than T2
/// after a sample it flows so, too, and is driven by what is held of that sample, L (C z + σ). The
/// theorem goes on from the next sample, whatever z is there: what it adds to V is zero at samples.
class IssBound : public ErrorBound {
 public:
  /// @param level  bound on γ |Γ|; 0 for Proposition 1, which is about Γ = 0
  IssBound(const CertificateSubject& subject, const NamedMatrices& values, double level,
           const ErrorAssumptions& assumptions)
      : T2_(subject.T2),
        rate_(scalar_value(values, "alpha")),
        initial_error_(assumptions.initial_error) {
    const Eigen::MatrixXd& P = values.at("P");
    const Eigen::MatrixXd& N = subject.plant.N;
    const Eigen::MatrixXd& L = values.at("L");
    final_ = raised(level * level / rate_);
    per_error_ = std::sqrt(largest_eigenvalue_above(P));
    least_ = positive_least_eigenvalue(P, "P");
    growth_ = -std::numeric_limits<double>::infinity();
    for (const Eigen::MatrixXd& flow : flow_vertices_of(subject.plant)) {
      growth_ = std::max(growth_, growth_above(P, flow));
    }
    if (N.cols() > 0) {
      push_ = std::sqrt(largest_eigenvalue_above(N.transpose() * P * N)) * assumptions.disturbance;
    }
    const Eigen::MatrixXd R = cholesky_root(P);
    held_ = raised(norm2(R * L * subject.plant.C() * inverse_of(R)));
    held_noise_ = raised(norm2(R * L)) * assumptions.noise;
  }

  // √V, the time since the last sample [s], whether there was one, and √V just after it.
  Eigen::Index state_size() const override { return 4; }
  void initialize(double* state) const override { begin(initial_error_, state); }
  void begin(double error, double* state) const override {
    state[0] = per_error_ * error;
    state[1] = 0.0;
    state[2] = 0.0;
    state[3] = 0.0;
  }
  void flow(double duration, double* state) const override {
    if (state[2] == 0.0) {
      state[0] = flowed_linearly(state[0], growth_, push_, duration);
      return;
    }
    const double foreseen = std::min(duration, std::max(0.0, T2_ - state[1]));
    state[1] += duration;
    state[0] = std::sqrt(final_ + (state[0] * state[0] - final_) * std::exp(-rate_ * foreseen));
    if (state[1] <= T2_) return;
    state[0] = flowed_linearly(state[0], growth_, push_ + held_ * state[3] + held_noise_,
                               duration - foreseen);
  }
  void sample(double* state, double*) const override {
    state[1] = 0.0;
    state[2] = 1.0;
    state[3] = state[0];
  }
  bool injects_between_samples() const override { return true; }
  void jump(double, double* state) const override {
    state[0] = std::numeric_limits<double>::infinity();
  }
  double bound(const double* state) const override { return state[0] / std::sqrt(least_); }

 private:
  double T2_;
  double rate_;
  double final_ = 0.0;
  double initial_error_;
  double per_error_ = 0.0;
  double least_ = 0.0;
  double growth_ = 0.0;
  double push_ = 0.0;
  double held_ = 0.0;        // ‖L C‖ in the norm of P
  double held_noise_ = 0.0;  // |L σ| in it
};

class Proposition : public Theorem {
 public:
  std::vector<std::string> observer_types() const override { return {"SampleAndHoldObserver"}; }

  void require_applicable(const CertificateSubject& subject) const override {
    const PlantMatrices& plant = subject.plant;
    if (plant.modes.size() > 1 || plant.jumps()) {
      throw std::invalid_argument("etienne2019 is about plants that do not jump");
    }
    if (plant.C().rows() == 0) throw std::invalid_argument("etienne2019 needs a sampled sensor");
    if (!plant.is_linear() && plant.vertices.empty()) {
      throw std::invalid_argument("etienne2019 needs plant/vertices, the polytope of G psi(S x)");
    }
  }

  std::string decay_parameter() const override { return "alpha"; }

  /// V falls at the rate α, the error at half of it.
  GuaranteedFigure decay_figure(const NamedMatrices& values) const override {
    return {"guaranteed rate of convergence [1/s]", scalar_value(values, "alpha") / 2.0};
  }

  std::vector<NamedShape> gains(const CertificateSubject& subject) const override {
    return {matrix_shape("L", subject.plant.states(), subject.plant.C().rows())};
  }

 protected:
  /// What drives the error besides itself: a block E of H_i = [R_i + L C, −I, L C, E …], which
  /// multiplies a signal of `size` entries.
  struct Channel {
    MatrixExpression through;
    Eigen::Index size = 0;
  };

  /// (13) at each vertex R_i and at both ends ρ of e^{−ατ}, with Ḡ = [G_1 G_2 …] of as many blocks
  /// as H_i has; M of (12), or of (16) with a block −γ² I for each channel.
  static std::vector<Condition> finsler_conditions(const CertificateSubject& subject,
                                                   const std::vector<MatrixExpression>& G,
                                                   const std::vector<Channel>& channels,
                                                   const std::string& number) {
    const Eigen::Index n = subject.plant.states();
    const MatrixExpression P = symbol("P", n, n);
    const MatrixExpression X = symbol("X", n, n);
    const MatrixExpression Y = symbol("Y", n, n);
    const MatrixExpression alpha = symbol("alpha");
    const MatrixExpression LC = symbol("L", n, subject.plant.C().rows()) * subject.plant.C();
    std::vector<Condition> all = domain_of_times(subject.T1, subject.T2);
    all.push_back(positive("alpha"));
    if (!channels.empty()) all.push_back(positive("gamma"));
    all.push_back({"P > 0", P, std::nullopt});
    all.push_back({"X > 0", X, std::nullopt});
    all.push_back({"Y > 0", Y, std::nullopt});
    const MatrixExpression decayed = exponential(-(alpha * MatrixExpression(subject.T2)));
    int vertex = 0;
    for (const Eigen::MatrixXd& R : flow_vertices_of(subject.plant)) {
      ++vertex;
      for (const auto& [end, rho] :
           {std::pair<const char*, MatrixExpression>{"1", 1.0},
            std::pair<const char*, MatrixExpression>{"exp(-alpha T2)", decayed}}) {
        // Π = [Π1 Π2; ⋆ Π3] with Π1 = −(2 h̄/π)² X, Π2 = Y, Π3 = X, in the order (y, w).
        std::vector<std::vector<MatrixExpression>> M = {
            {alpha * P, P, zeros(n, n)},
            {rho * (MatrixExpression(wirtinger_constant(subject.T2)) * X), -(rho * Y)},
            {-(rho * X)}};
        std::vector<MatrixExpression> H = {MatrixExpression(R) + LC, -identity(n), LC};
        for (const Channel& channel : channels) {
          for (std::size_t row = 0; row < M.size(); ++row) {
            M[row].push_back(zeros(row < 3 ? n : channels[row - 3].size, channel.size));
          }
          M.push_back({-(square("gamma") * identity(channel.size))});
          H.push_back(channel.through);
        }
        all.push_back({number + " at vertex " + std::to_string(vertex) + ", rho = " + end,
                       -(symmetric_blocks(M) + He(transpose(blocks({G})) * blocks({H}))),
                       std::nullopt});
      }
    }
    return all;
  }

  /// Else gamma would say nothing: it scales with P.
  static Condition normalized(Eigen::Index n) {
    return {"c_1 = 1: P > I", symbol("P", n, n) - identity(n), std::nullopt};
  }

  /// Final error for inputs of norm 1.
  static double final_error_per_level(const NamedMatrices& values) {
    return scalar_value(values, "gamma") /
           std::sqrt(min_eigenvalue(values.at("P")) * scalar_value(values, "alpha"));
  }
};

/// What Theorem 1 says of Γ = 0, for Proposition 1 and for slack matrices of any kind.
class WithoutInputs : public Proposition {
 public:
  std::string guarantee() const override {
    return "without noise and disturbance the error converges at the rate alpha / 2, for all times "
           "between samples up to T2";
  }

  std::vector<NamedShape> parameters(const CertificateSubject&) const override {
    return {scalar_shape("alpha")};
  }

  bool is_homogeneous(const CertificateSubject&) const override { return true; }

  std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const override {
    if (assumptions.noise > 0.0 || assumptions.disturbance > 0.0) {
      throw std::invalid_argument(
          "it is about measurements without noise and plants without disturbance; "
          "etienne2019_proposition2 bounds what they do");
    }
    return std::make_unique<const IssBound>(subject, values, 0.0, assumptions);
  }
};

/// Theorem 1 with (13) as it is.
class Theorem1 : public WithoutInputs {
 public:
  std::string name() const override { return "etienne2019_theorem1"; }

  std::vector<NamedShape> multipliers(const CertificateSubject& subject) const override {
    const Eigen::Index n = subject.plant.states();
    return {symmetric_shape("P", n),   symmetric_shape("X", n),   symmetric_shape("Y", n),
            matrix_shape("G_1", n, n), matrix_shape("G_2", n, n), matrix_shape("G_3", n, n)};
  }

  std::vector<Condition> conditions(const CertificateSubject& subject) const override {
    const Eigen::Index n = subject.plant.states();
    return finsler_conditions(subject,
                              {symbol("G_1", n, n), symbol("G_2", n, n), symbol("G_3", n, n)}, {},
                              "etienne2019 (13)");
  }
};

/// With G_1 = G_2 = G and G_3 = 0, though G_1 and G_2 differ by a unit of time.
class Proposition1 : public WithoutInputs {
 public:
  std::string name() const override { return "etienne2019_proposition1"; }

  std::vector<NamedShape> multipliers(const CertificateSubject& subject) const override {
    const Eigen::Index n = subject.plant.states();
    return {symmetric_shape("P", n), symmetric_shape("X", n), symmetric_shape("Y", n),
            matrix_shape("G", n, n)};
  }

  std::vector<Condition> conditions(const CertificateSubject& subject) const override {
    const Eigen::Index n = subject.plant.states();
    const MatrixExpression G = symbol("G", n, n);
    return finsler_conditions(subject, {G, G, zeros(n, n)}, {}, "etienne2019 (14)");
  }
};

class Proposition2 : public Proposition {
 public:
  std::string name() const override { return "etienne2019_proposition2"; }

  std::string guarantee() const override {
    return "the error is input-to-state stable: it converges at the rate alpha / 2 to at most "
           "gamma / sqrt(alpha) times the bound on L noise + disturbance, for all times between "
           "samples up to T2";
  }

  std::vector<NamedShape> multipliers(const CertificateSubject& subject) const override {
    const Eigen::Index n = subject.plant.states();
    return {symmetric_shape("P", n),   symmetric_shape("X", n),   symmetric_shape("Y", n),
            matrix_shape("G_1", n, n), matrix_shape("G_2", n, n), matrix_shape("G_3", n, n),
            matrix_shape("G_4", n, n)};
  }

  std::vector<NamedShape> parameters(const CertificateSubject&) const override {
    return {scalar_shape("alpha"), scalar_shape("gamma")};
  }

  bool is_homogeneous(const CertificateSubject&) const override { return false; }

  std::vector<Condition> conditions(const CertificateSubject& subject) const override {
    const Eigen::Index n = subject.plant.states();
    std::vector<MatrixExpression> G;
    for (const char* name : {"G_1", "G_2", "G_3", "G_4"}) G.push_back(symbol(name, n, n));
    std::vector<Condition> all =
        finsler_conditions(subject, G, {{identity(n), n}}, "etienne2019 (15)");
    all.push_back(normalized(n));
    return all;
  }

  std::vector<GuaranteedFigure> guaranteed_figures(const CertificateSubject&,
                                                   const NamedMatrices& values) const override {
    const GuaranteedFigure gain = gain_figure(values);
    return {gain, {"final error per unit of noise", gain.value * norm2(values.at("L"))}};
  }

  GuaranteedFigure gain_figure(const NamedMatrices& values) const override {
    return {"final error per unit of |L noise + disturbance| [s]", final_error_per_level(values)};
  }

  std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const override {
    const double input = norm2(values.at("L")) * assumptions.noise +
                         norm2(subject.plant.N) * assumptions.disturbance;
    return std::make_unique<const IssBound>(subject, values, scalar_value(values, "gamma") * input,
                                            assumptions);
  }
};

/// Proposition 2 with Γ = L σ + N w taken apart: the noise enters through L and the disturbance
/// through N, so that H_i = [R_i + L C, −I, L C, s L, d N]. V̇ + α V <= γ² (|σ/s|² + |w/d|²), with
/// the sizes s and d of noise and disturbance that γ is a gain for. Nothing is lost by norms of L
/// and N, as it is where Γ may have any direction.
class Proposition2Channels : public Proposition {
 public:
  std::string name() const override { return "etienne2019_proposition2_channels"; }

  std::string guarantee() const override {
    return "the error is input-to-state stable: it converges at the rate alpha / 2 to at most "
           "gamma / sqrt(alpha) times the root of (noise / noise_size)^2 + "
           "(disturbance / disturbance_size)^2, for all times between samples up to T2";
  }

  std::vector<NamedShape> multipliers(const CertificateSubject& subject) const override {
    const Eigen::Index n = subject.plant.states();
    std::vector<NamedShape> all = {symmetric_shape("P", n),
                                   symmetric_shape("X", n),
                                   symmetric_shape("Y", n),
                                   matrix_shape("G_1", n, n),
                                   matrix_shape("G_2", n, n),
                                   matrix_shape("G_3", n, n),
                                   matrix_shape("G_4", n, subject.plant.C().rows())};
    if (has_disturbance(subject)) all.push_back(matrix_shape("G_5", n, subject.plant.N.cols()));
    return all;
  }

  std::vector<NamedShape> parameters(const CertificateSubject& subject) const override {
    std::vector<NamedShape> all = {scalar_shape("alpha"), scalar_shape("gamma"),
                                   scalar_shape("noise_size")};
    if (has_disturbance(subject)) all.push_back(scalar_shape("disturbance_size"));
    return all;
  }

  bool is_homogeneous(const CertificateSubject&) const override { return false; }

  std::vector<Condition> conditions(const CertificateSubject& subject) const override {
    const Eigen::Index n = subject.plant.states();
    const Eigen::Index outputs = subject.plant.C().rows();
    std::vector<MatrixExpression> G;
    for (const char* name : {"G_1", "G_2", "G_3"}) G.push_back(symbol(name, n, n));
    G.push_back(symbol("G_4", n, outputs));
    std::vector<Channel> channels = {{symbol("noise_size") * symbol("L", n, outputs), outputs}};
    std::vector<Condition> sizes = {positive("noise_size")};
    if (has_disturbance(subject)) {
      const Eigen::Index inputs = subject.plant.N.cols();
      G.push_back(symbol("G_5", n, inputs));
      channels.push_back({symbol("disturbance_size") * MatrixExpression(subject.plant.N), inputs});
      sizes.push_back(positive("disturbance_size"));
    }
    std::vector<Condition> all =
        finsler_conditions(subject, G, channels, "etienne2019 (15) by channels");
    all.push_back(normalized(n));
    all.insert(all.end(), sizes.begin(), sizes.end());
    return all;
  }

  std::vector<GuaranteedFigure> guaranteed_figures(const CertificateSubject& subject,
                                                   const NamedMatrices& values) const override {
    const double gain = final_error_per_level(values);
    std::vector<GuaranteedFigure> all = {
        {"final error per unit of noise", gain / scalar_value(values, "noise_size")}};
    if (has_disturbance(subject)) {
      all.push_back(
          {"final error per unit of disturbance", gain / scalar_value(values, "disturbance_size")});
    }
    return all;
  }

  GuaranteedFigure gain_figure(const NamedMatrices& values) const override {
    return {"final error for noise or disturbance of their sizes", final_error_per_level(values)};
  }

  std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const override {
    double input = assumptions.noise / scalar_value(values, "noise_size");
    if (has_disturbance(subject)) {
      input = std::hypot(input, assumptions.disturbance / scalar_value(values, "disturbance_size"));
    }
    return std::make_unique<const IssBound>(subject, values, scalar_value(values, "gamma") * input,
                                            assumptions);
  }

 private:
  static bool has_disturbance(const CertificateSubject& subject) {
    return subject.plant.N.cols() > 0;
  }
};

}  // namespace

const Theorem& etienne2019_theorem1() {
  static const Theorem1 theorem;
  return theorem;
}

const Theorem& etienne2019_proposition1() {
  static const Proposition1 theorem;
  return theorem;
}

const Theorem& etienne2019_proposition2() {
  static const Proposition2 theorem;
  return theorem;
}

const Theorem& etienne2019_proposition2_channels() {
  static const Proposition2Channels theorem;
  return theorem;
}

}  // namespace sampled_data_observers
