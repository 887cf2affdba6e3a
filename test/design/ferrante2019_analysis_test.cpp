// ferrante2019: what can be proved of given gains, against numbers computed independently.
#include <gtest/gtest.h>

#include "design/analysis.h"
#include "ferrante2019_examples.h"

namespace sampled_data_observers {
namespace {

using test::flexible_link;
using test::oscillator;

NamedMatrices printed_51() {
  NamedMatrices gains;
  gains["L"].resize(2, 1);
  gains["L"] << 2.067, -3;
  gains["H"] = scalar_matrix(-1.384);
  return gains;
}

NamedMatrices predictor(const Eigen::MatrixXd& L, const CertificateSubject& subject) {
  return {{"L", L}, {"H", -subject.plant.C() * L}};
}

NamedMatrices printed_50() {
  Eigen::MatrixXd L(2, 1);
  L << 0.3648, -0.4655;
  return predictor(L, oscillator(0.41));
}

NamedMatrices postoyan() {
  Eigen::MatrixXd L(4, 2);
  L << 9.328, 1, -48.78, 22.11, -0.0524, 3.199, 19.41, -0.9032;
  return predictor(L, flexible_link(0.1));
}

Design analysis(const std::string& theorem, const CertificateSubject& subject,
                const NamedMatrices& gains, const Parameters& given, Objective objective) {
  AnalysisProblem problem;
  problem.theorem = find_theorem(theorem);
  problem.subject = subject;
  problem.gains = gains;
  problem.given = given;
  problem.objective = objective;
  SynthesisOptions options;
  options.jobs = 2;
  Design proof = analyze(problem, options);
  EXPECT_TRUE(all_hold(check(proof.certificate)));
  return proof;
}

double value(const Design& proof, const char* name) {
  return scalar_value(proof.certificate.values, name);
}

double figure(const Certificate& certificate, const std::string& beginning) {
  for (const GuaranteedFigure& figure :
       certificate.theorem->guaranteed_figures(certificate.subject, certificate.values)) {
    if (figure.meaning.rfind(beginning, 0) == 0) return figure.value;
  }
  ADD_FAILURE() << beginning;
  return 0.0;
}

const char* const kTheorem2 = "ferrante2019_theorem2";
const char* const kCorollary1 = "ferrante2019_corollary1";
const char* const kCorollary2 = "ferrante2019_corollary2";

TEST(Ferrante2019Analysis, FindsTheGammaOfThePrintedGains) {
  const Design proof = analysis(kTheorem2, oscillator(0.41), printed_51(), {{"lambda_t", 0.05}},
                                Objective::kMinGamma);
  EXPECT_NEAR(value(proof, "gamma"), 32.92, 0.01 * 32.92);
  EXPECT_NEAR(value(proof, "delta"), 3.0, 0.2);
}

TEST(Ferrante2019Analysis, FindsTheLargestRateAndTimeOfTheEarlierGains) {
  const auto longest = [](const char* theorem, double lambda_t) {
    return analysis(theorem, oscillator(0.41), printed_50(), {{"lambda_t", lambda_t}},
                    Objective::kMaxT2)
        .certificate.subject.T2;
  };
  const auto fastest = [](const char* theorem) {
    return value(analysis(theorem, oscillator(0.41), printed_50(), {}, Objective::kMaxDecay),
                 "lambda_t");
  };
  EXPECT_NEAR(longest(kTheorem2, 0.05), 0.314, 0.01 * 0.314);
  EXPECT_NEAR(fastest(kTheorem2), 0.0132, 0.01 * 0.0132);
  EXPECT_NEAR(longest(kCorollary1, 1e-4), 0.446, 0.01 * 0.446);
  EXPECT_NEAR(fastest(kCorollary1), 0.0132, 0.01 * 0.0132);
}

TEST(Ferrante2019Analysis, FindsTheLargestTimeOfPostoyansGain) {
  const Design longest = analysis(kCorollary1, flexible_link(0.1), postoyan(), {{"lambda_t", 0.01}},
                                  Objective::kMaxT2);
  EXPECT_NEAR(longest.certificate.subject.T2, 0.1145, 0.01 * 0.1145);
  EXPECT_NEAR(value(longest, "delta"), 15.0, 2.0);
}

TEST(Ferrante2019Analysis, RateOfCorollary2IsOneOfTheorem2) {
  const Design proof =
      analysis(kCorollary2, oscillator(0.3), printed_51(), {}, Objective::kMinGamma);
  const double rate = figure(proof.certificate, "rate of convergence");
  EXPECT_GT(rate, 0.0);
  Certificate with_rate = proof.certificate;
  with_rate.theorem = find_theorem(kTheorem2);
  with_rate.values["lambda_t"] = scalar_matrix(0.99 * rate);
  EXPECT_TRUE(all_hold(check(with_rate))) << describe_violations(check(with_rate));
}

TEST(Ferrante2019Analysis, FinalErrorsAreTheLimitsOfTheErrorBound) {
  const Certificate proof =
      analysis(kTheorem2, oscillator(0.3), printed_51(), {{"lambda_t", 0.05}}, Objective::kMinGamma)
          .certificate;
  const auto limit = [&](const ErrorAssumptions& assumptions, double between_samples) {
    const auto bound = proof.theorem->error_bound(proof.subject, proof.values, assumptions);
    std::vector<double> state(static_cast<std::size_t>(bound->state_size()));
    bound->initialize(state.data());
    for (int i = 0; i < 5000; ++i) {
      bound->flow(between_samples, state.data());
      bound->sample(0, state.data(), nullptr);
    }
    return bound->bound(state.data());
  };
  const double noise = figure(proof, "final error over noise");
  EXPECT_NEAR(limit({0.0, 1.0, 0.0}, proof.subject.T1), noise, 1e-6 * noise);
  const double disturbance = figure(proof, "final error over disturbance");
  EXPECT_NEAR(limit({0.0, 0.0, 1.0}, proof.subject.T2), disturbance, 1e-6 * disturbance);
}

/// Theorem 1 (ii) without disturbance, over 60 s of samples T2 apart: from any start, θ = 0.
TEST(Ferrante2019Analysis, BoundsTheEnergyOfThePerformanceOutput) {
  const CertificateSubject subject = oscillator(0.2);
  const Certificate proof =
      analysis(kTheorem2, subject, printed_51(), {{"lambda_t", 0.05}}, Objective::kMinGamma)
          .certificate;
  const double alpha = figure(proof, "L2 norm of the performance output");
  const Eigen::MatrixXd& A = subject.plant.A();
  const Eigen::MatrixXd& C = subject.plant.C();
  const Eigen::MatrixXd& L = proof.values.at("L");
  const double H = scalar_value(proof.values, "H");
  constexpr double kStep = 1e-3;
  for (const Eigen::Vector2d& start : {Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1)}) {
    Eigen::Vector2d error = start;
    double held = 0.0;
    double energy = 0.0;
    for (int i = 0; i < 60000; ++i) {
      if (i % 200 == 199) held = (C * error)(0);
      energy += kStep * (subject.plant.C_p * error).squaredNorm();
      error += kStep * (A * error - L * held);
      held += kStep * H * held;
    }
    const double injected = (C * start)(0);
    EXPECT_LE(std::sqrt(energy), alpha * std::hypot(start.norm(), injected));
    EXPECT_GE(std::sqrt(energy), 0.02 * alpha);
  }
}

TEST(Ferrante2019Analysis, TakesTheDefaultsOfTheDesign) {
  const Design plain = analysis(kTheorem2, oscillator(0.2), printed_51(), {}, Objective::kMinGamma);
  EXPECT_EQ(scalar_value(plain.certificate.values, "lambda_t"), 1e-3 / 0.2);
}

}  // namespace
}  // namespace sampled_data_observers
