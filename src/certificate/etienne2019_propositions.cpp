#include <cmath>
#include <stdexcept>
#include <utility>

#include "certificate/etienne2019_bound.h"
#include "certificate/theorems.h"
#include "certificate/wirtinger.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

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
    for (const Eigen::MatrixXd& R : etienne2019_flows(subject.plant)) {
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
    return etienne2019_bound(subject, values, 0.0, assumptions);
  }
};

/// Theorem 1 with (13) as it is.
class Etienne2019Theorem1 : public WithoutInputs {
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
    return etienne2019_bound(subject, values, scalar_value(values, "gamma") * input, assumptions);
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
    return etienne2019_bound(subject, values, scalar_value(values, "gamma") * input, assumptions);
  }

 private:
  static bool has_disturbance(const CertificateSubject& subject) {
    return subject.plant.N.cols() > 0;
  }
};

}  // namespace

const Theorem& etienne2019_theorem1() {
  static const Etienne2019Theorem1 theorem;
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
