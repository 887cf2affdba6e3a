#include <cmath>
#include <functional>
#include <vector>

#include "certificate/wirtinger.h"
#include "design/methods/methods.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// etienne2019: with G_1 = G_2 = G, G_3 = G_4 = 0 and Q = Gᵀ L the conditions (13) are linear.
class GainDesign : public LmiDesignMethod {
 protected:
  /// What drives the error besides itself: Gᵀ E, where E is its block of H_i, and the size of the
  /// signal.
  struct Channel {
    MatrixExpression weighed;
    Eigen::Index size = 0;
  };

  static LmiProgram common_program(
      const CertificateSubject& subject, double alpha,
      const std::function<std::vector<Channel>(const MatrixExpression& G,
                                               const MatrixExpression& Q)>& channels) {
    const PlantMatrices& plant = subject.plant;
    const Eigen::Index n = plant.states();
    const double wirtinger = wirtinger_constant(subject.T2);
    LmiProgram program;
    const MatrixExpression P = program.symmetric("P", n);
    const MatrixExpression X = program.symmetric("X", n);
    const MatrixExpression Y = program.symmetric("Y", n);
    const MatrixExpression G = program.matrix("G", n, n);
    const MatrixExpression Q = program.matrix("Q", n, plant.C().rows());
    program.require_positive("P > 0", P);
    program.require_positive("X > 0", X);
    program.require_positive("Y > 0", Y);
    const MatrixExpression QC = Q * plant.C();
    const std::vector<Channel> channels_of = channels(G, Q);
    std::vector<Eigen::MatrixXd> vertices = plant.vertices;
    if (plant.is_linear()) vertices = {Eigen::MatrixXd::Zero(n, n)};
    for (const Eigen::MatrixXd& vertex : vertices) {
      const MatrixExpression R = Eigen::MatrixXd(plant.A() + vertex);
      const MatrixExpression GR = transpose(G) * R;
      for (const double rho : {1.0, std::exp(-alpha * subject.T2)}) {
        std::vector<std::vector<MatrixExpression>> rows = {
            {alpha * P + He(GR + QC), P + transpose(GR) - transpose(G) + transpose(QC), QC},
            {(rho * wirtinger) * X - He(G), QC - rho * Y},
            {-rho * X}};
        for (const Channel& channel : channels_of) {
          rows[0].push_back(channel.weighed);
          rows[1].push_back(channel.weighed);
          rows[2].push_back(zeros(n, channel.size));
          for (std::size_t row = 3; row < rows.size(); ++row) {
            rows[row].push_back(zeros(channels_of[row - 3].size, channel.size));
          }
          rows.push_back({-(square("gamma") * identity(channel.size))});
        }
        program.require_negative("(14)", symmetric_blocks(rows));
      }
    }
    return program;
  }

  static Eigen::MatrixXd gain(const NamedMatrices& solution) {
    return solve_linear(solution.at("G").transpose(), solution.at("Q"));
  }
};

/// The gain by (14), its proof by (13): G_1 = G_2, though of different units of time, is a choice
/// for the design alone.
class Proposition1Design : public GainDesign {
 public:
  std::string name() const override { return "etienne2019_proposition1"; }

  std::string summary() const override { return "held-innovation gain L for a rate alpha / 2"; }

  std::vector<DesignParameter> parameters(const CertificateSubject& subject) const override {
    return {{"alpha", "twice the rate of convergence [1/s]", 0.1 / subject.T2, std::nullopt}};
  }

  const Theorem& theorem() const override { return *find_theorem("etienne2019_theorem1"); }

  std::vector<Objective> objectives(const CertificateSubject&) const override {
    return {Objective::kFeasible, Objective::kMaxT2, Objective::kMaxDecay};
  }

 protected:
  LmiProgram program(const CertificateSubject& subject, const Parameters& parameters,
                     Objective) const override {
    LmiProgram program = common_program(
        subject, parameters.at("alpha"),
        [](const MatrixExpression&, const MatrixExpression&) { return std::vector<Channel>(); });
    const Eigen::Index n = subject.plant.states();
    program.bound_above("P <= I", symbol("P", n, n), identity(n));
    return program;
  }

  NamedMatrices gains(const CertificateSubject&, const Parameters&,
                      const NamedMatrices& solution) const override {
    return {{"L", gain(solution)}};
  }
};

/// Proposition 2 is an analysis; with the choice that makes Proposition 1 linear it gives gains,
/// too, after which the analysis is free in all of its matrices. Noise enters through L and the
/// disturbance through N, each as large as is said.
class Proposition2Design : public GainDesign {
 public:
  std::string name() const override { return "etienne2019_proposition2"; }

  std::string summary() const override {
    return "held-innovation gain L with a small final error for noise and disturbance";
  }

  const Theorem& theorem() const override {
    return *find_theorem("etienne2019_proposition2_channels");
  }

  std::vector<DesignParameter> parameters(const CertificateSubject& subject) const override {
    std::vector<DesignParameter> all = {
        {"alpha", "twice the rate of convergence [1/s]", std::nullopt,
         SearchRange{0.02 / subject.T2, 2.0 / subject.T2, true}},
        {"noise_size", "noise that gamma is for [output]", 1.0, std::nullopt}};
    if (subject.plant.N.cols() > 0) {
      all.push_back({"disturbance_size", "disturbance that gamma is for [w]", 1.0, std::nullopt});
    }
    return all;
  }

  std::vector<Objective> objectives(const CertificateSubject&) const override {
    return {Objective::kFeasible, Objective::kMinGamma, Objective::kMaxT2, Objective::kMaxDecay,
            Objective::kMinFinalError};
  }

  /// The least final error is the least gain for noise and disturbance of the sizes that are given,
  /// but for the root of 2 if there are both.
  DesignCandidate attempt(const CertificateSubject& subject, const Parameters& parameters,
                          Objective objective) const override {
    if (objective != Objective::kMinFinalError) {
      return GainDesign::attempt(subject, parameters, objective);
    }
    DesignCandidate none;
    none.message = "nothing but noise limits the gain L: it must be larger than 0";
    if (!(parameters.at("noise_size") > 0.0)) return none;
    return GainDesign::attempt(subject, parameters, Objective::kMinGamma);
  }

 protected:
  LmiProgram program(const CertificateSubject& subject, const Parameters& parameters,
                     Objective) const override {
    const Eigen::MatrixXd& N = subject.plant.N;
    LmiProgram program = common_program(
        subject, parameters.at("alpha"), [&](const MatrixExpression& G, const MatrixExpression& Q) {
          std::vector<Channel> channels = {{parameters.at("noise_size") * Q, Q.cols()}};
          if (N.cols() > 0) {
            channels.push_back(
                {parameters.at("disturbance_size") * (transpose(G) * MatrixExpression(N)),
                 N.cols()});
          }
          return channels;
        });
    const Eigen::Index n = subject.plant.states();
    program.bound_above("I <= P", identity(n), symbol("P", n, n));
    program.minimize(program.squared("gamma"));
    return program;
  }

  NamedMatrices gains(const CertificateSubject&, const Parameters&,
                      const NamedMatrices& solution) const override {
    return {{"L", gain(solution)}};
  }
};

}  // namespace

const DesignMethod& etienne2019_proposition1_design() {
  static const Proposition1Design method;
  return method;
}

const DesignMethod& etienne2019_proposition2_design() {
  static const Proposition2Design method;
  return method;
}

}  // namespace sampled_data_observers
