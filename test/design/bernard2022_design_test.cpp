// bernard2022: designs for its examples, against numbers computed independently.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "design/bernard2022_plants.h"
#include "design/certified.h"
#include "design/jump_observability.h"
#include "design/polytopic_embedding.h"
#include "design/synthesis.h"
#include "linear_algebra/matrix_functions.h"
#include "observer/observable_form.h"

namespace sampled_data_observers {
namespace {

const char* const kCorollary52 = "bernard2022_corollary5_2";

NamedMatrices with_L_d(std::initializer_list<double> entries, double jump_decay = 1e-3) {
  Eigen::MatrixXd L_d(static_cast<Eigen::Index>(entries.size()), 1);
  std::copy(entries.begin(), entries.end(), L_d.data());
  return {{"L_d", L_d}, {"jump_decay", scalar_matrix(jump_decay)}};
}

TEST(Bernard2022, ThePrintedGainsSatisfyCorollary52) {
  const DesignCandidate example =
      certified(kCorollary52, impulsive(), with_L_d({1.0, 0.2259, 1.0}));
  EXPECT_TRUE(example.is_verified()) << example.message;
  const DesignCandidate ball = certified(kCorollary52, bouncing_ball(), with_L_d({-1.0, -0.1085}));
  EXPECT_TRUE(ball.is_verified()) << ball.message;
  const DesignCandidate spiking =
      certified(kCorollary52, neuron(), with_L_d({0.0, 0.0028, -0.0063}));
  EXPECT_TRUE(spiking.is_verified()) << spiking.message;
}

TEST(Bernard2022, WithoutInnovationNothingIsProved) {
  EXPECT_FALSE(certified(kCorollary52, impulsive(), with_L_d({0.0, 0.0, 0.0})).is_verified());
  EXPECT_FALSE(certified(kCorollary52, neuron(), with_L_d({0.0, 0.0, 0.0})).is_verified());
}

TEST(Bernard2022, TheVerticesOfItsExamplesAreTheEndsOfTheInterval) {
  const CertificateSubject ball = bouncing_ball();
  const auto vertices = polytopic_embedding(ball.plant.A(), ball.T1, ball.T2);
  ASSERT_EQ(vertices.size(), 2U);
  Eigen::MatrixXd M2(2, 2);
  M2 << 1, 3.9347, 0, 0.6065;
  const bool is_first = vertices[0](0, 1) > vertices[1](0, 1);
  EXPECT_LT((vertices[is_first ? 0 : 1] - M2).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_LT((vertices[is_first ? 1 : 0] - Eigen::MatrixXd::Identity(2, 2)).norm(), 1e-9);

  const CertificateSubject spiking = neuron();
  const auto two = polytopic_embedding(spiking.plant.A(), 30.0, 50.0);
  ASSERT_EQ(two.size(), 2U);
  const double d00 = (two[0] - exponential_of(30.0 * spiking.plant.A())).norm();
  const double d01 = (two[0] - exponential_of(50.0 * spiking.plant.A())).norm();
  EXPECT_LT(std::min(d00, d01), 1e-7);
}

TEST(Bernard2022, Equation36FindsGainsForItsExamples) {
  for (const CertificateSubject& subject : {impulsive(), bouncing_ball(), neuron()}) {
    const Design design = designed("bernard2022_equation36", subject);
    const ModeMatrices& plant = subject.plant.mode();
    for (const double tau : {subject.T1, (subject.T1 + subject.T2) / 2.0, subject.T2}) {
      const Eigen::MatrixXd cycle = (*plant.A_d - design.certificate.values.at("L_d") * plant.C_d) *
                                    exponential_of(tau * plant.A);
      EXPECT_LT(spectral_radius(cycle), 1.0);
    }
  }
}

TEST(Bernard2022, Equation26WorksForTheBallButNotWhereJumpsAloneDetectNothing) {
  designed("bernard2022_equation26", bouncing_ball());
  EXPECT_THROW(designed("bernard2022_equation26", impulsive()), DesignError);
}

TEST(Bernard2022, FlowBasedAndCoupledGainsForTheBallWithMeasuredHeight) {
  CertificateSubject subject = bouncing_ball();
  subject.T1 = 0.5;
  subject.plant.modes.front().C_c = Eigen::MatrixXd::Identity(1, 2);
  const Design flow = designed("bernard2022_equation22", subject);
  const Eigen::MatrixXd closed =
      subject.plant.A() - flow.certificate.values.at("L_c") * subject.plant.mode().C_c;
  EXPECT_LT(eigenvalues_of(closed).real().maxCoeff(), 0.0);
  // Zeno: times between jumps may be anything.
  subject.T1 = 0.0;
  designed("bernard2022_equation15", subject);
}

TEST(Bernard2022, FlowBasedGainsNeedADwellTimeWhereJumpsExpand) {
  CertificateSubject subject = bouncing_ball();
  ModeMatrices& mode = subject.plant.modes.front();
  mode.C_c = Eigen::MatrixXd::Identity(1, 2);
  mode.A_d = Eigen::MatrixXd(-1.5 * Eigen::MatrixXd::Identity(2, 2));
  subject.T1 = 1e-3;
  EXPECT_THROW(
      designed("bernard2022_equation22", subject, Objective::kFeasible, {{"gain_bound", 10.0}}),
      DesignError);
  subject.T1 = 1.0;
  designed("bernard2022_equation22", subject, Objective::kFeasible, {{"gain_bound", 10.0}});
}

TEST(Bernard2022, TheLeastHighGainFallsWithTheDwellTime) {
  CertificateSubject subject = bouncing_ball();
  ModeMatrices& mode = subject.plant.modes.front();
  mode.C_c = Eigen::MatrixXd::Identity(1, 2);
  mode.A_d = Eigen::MatrixXd(-3.0 * Eigen::MatrixXd::Identity(2, 2));
  for (const double T1 : {0.5, 2.0}) {
    subject.T1 = T1;
    const Design design = designed("bernard2022_example4_2", subject);
    const double ell = scalar_value(design.certificate.values, "ell");
    // Where a jump multiplies the error by 3, any P will do for it: what counts is the rate alone,
    // which comes close to that of the eigenvalues, 2 ell.
    const double needed = 2.0 * std::log(3.0) + 2.0 * 0.01;
    EXPECT_NEAR(ell * design.parameters.at("decay_per_ell") * T1, needed, 2e-3 * needed);
    EXPECT_GT(ell * T1, needed / 2.0);
    EXPECT_LT(ell * T1, needed / 1.8);
    // Necessary: the error, sampled after jumps, shrinks.
    const Eigen::MatrixXd L_c = high_gain(mode.A, mode.C_c, observable_form(mode.A, mode.C_c), ell,
                                          {design.certificate.values.at("K").row(0).transpose()});
    EXPECT_LT(spectral_radius(*mode.A_d * exponential_of(T1 * (mode.A - L_c * mode.C_c))), 1.0);
  }
}

CertificateSubject with_lipschitz_jump(double constant, double T1) {
  CertificateSubject subject = bouncing_ball();
  ModeMatrices& mode = subject.plant.modes.front();
  mode.C_c = Eigen::MatrixXd::Identity(1, 2);
  mode.A_d.reset();
  subject.plant.lipschitz_jump = LipschitzJump{constant, Eigen::MatrixXd::Identity(2, 2)};
  subject.T1 = T1;
  return subject;
}

TEST(Bernard2022, TheHighGainOfCorollary41TakesTheLipschitzConstantOfTheJumpMapOnly) {
  constexpr double kConstant = 1.5;
  constexpr double kShortest = 2.0;
  const CertificateSubject subject = with_lipschitz_jump(kConstant, kShortest);
  const Design design = designed("bernard2022_corollary4_1", subject);
  const NamedMatrices& values = design.certificate.values;
  const double ell = scalar_value(values, "ell");
  // The condition at the end of its proof, with these P and rates.
  const Eigen::VectorXd of_P = symmetric_eigenvalues(values.at("P"));
  const double growth = std::log(kConstant * kConstant * of_P(1) / of_P(0));
  EXPECT_LT(-scalar_value(values, "flow_decay") * kShortest + growth, 0.0);
  // A matrix of the same norm is one such map.
  CertificateSubject linear = subject;
  linear.plant.modes.front().A_d = Eigen::MatrixXd(2, 2);
  *linear.plant.modes.front().A_d << 0.0, kConstant, -kConstant, 0.0;
  EXPECT_NEAR(ell,
              scalar_value(designed("bernard2022_corollary4_1", linear).certificate.values, "ell"),
              2e-3 * ell);
  EXPECT_LE(scalar_value(designed("bernard2022_example4_2", linear).certificate.values, "ell"),
            1.01 * ell);
  // A nonlinear one: its Jacobian has the norm max(|cos x2|, |sin x1|) kConstant.
  const ModeMatrices& mode = subject.plant.mode();
  const Eigen::MatrixXd L_c = high_gain(mode.A, mode.C_c, observable_form(mode.A, mode.C_c), ell,
                                        {values.at("K").row(0).transpose()});
  const Eigen::MatrixXd flow = exponential_of(kShortest * (mode.A - L_c * mode.C_c));
  const auto jumped = [&](const Eigen::Vector2d& x) {
    return Eigen::Vector2d(kConstant * std::sin(x(1)), kConstant * std::cos(x(0)));
  };
  const Eigen::MatrixXd& P = values.at("P");
  const double factor = std::exp(-scalar_value(values, "jump_decay"));
  double largest = 0.0;
  Eigen::Vector2d x(0.3, -1.0);
  for (int k = 0; k < 500; ++k) {
    const double angle = 0.7 * k;
    const Eigen::Vector2d error = 0.1 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d flowed = flow * error;
    x = jumped(x + Eigen::Vector2d(0.01 * k, 0.02 * k));
    const Eigen::Vector2d next = jumped(x) - jumped(x - flowed);
    largest = std::max(largest, std::sqrt(next.dot(P * next) / error.dot(P * error)));
  }
  EXPECT_LE(largest, factor);
  EXPECT_GT(largest, 0.01);
}

TEST(Bernard2022, Corollary41HoldsForAnAverageDwellTime) {
  CertificateSubject subject = with_lipschitz_jump(1.2, 0.0);
  subject.T2 = std::numeric_limits<double>::infinity();
  subject.dwell_time = DwellTime{DwellTime::Kind::kAverage, 1.0, 2.0};
  const Design design = designed("bernard2022_corollary4_1_average_dwell_time", subject);
  EXPECT_GT(scalar_value(design.certificate.values, "flow_decay"), std::log(1.2 * 1.2));
}

TEST(Bernard2022, JumpMapsByFormulasAreForNoTheoremAboutMatrices) {
  const CertificateSubject subject = with_lipschitz_jump(1.2, 1.0);
  for (const char* method : {"bernard2022_equation22", "bernard2022_example4_2"}) {
    EXPECT_THROW(designed(method, subject), DesignError) << method;
  }
}

TEST(Bernard2022, ConstantGainsForTheSwitchedPlantWhoseModesShowTheStateOnlyTogether) {
  const CertificateSubject subject = switched();
  const Design design = designed("bernard2022_section7_3_2", subject);
  Eigen::MatrixXd product = Eigen::MatrixXd::Identity(3, 3);
  for (const ModeMatrices& mode : subject.plant.modes) {
    const Eigen::MatrixXd& L_d = design.certificate.values.at("L_d/" + std::to_string(mode.label));
    product =
        (Eigen::MatrixXd::Identity(3, 3) - L_d * mode.C_d) * exponential_of(1.2 * mode.A) * product;
  }
  EXPECT_LT(spectral_radius(product), 1.0);
}

TEST(Bernard2022, FlowBasedGainsForASwitchedPlantWithObservableModes) {
  CertificateSubject subject = switched();
  for (ModeMatrices& mode : subject.plant.modes) {
    mode.C_d.resize(0, 3);
    mode.C_c = Eigen::MatrixXd::Zero(2, 3);
    mode.C_c(0, 0) = 1.0;
    mode.C_c(1, 2) = 1.0;
  }
  const Design design = designed("bernard2022_example7_1", subject);
  for (const ModeMatrices& mode : subject.plant.modes) {
    const Eigen::MatrixXd closed =
        mode.A - design.certificate.values.at(of_mode("L_c", mode)) * mode.C_c;
    EXPECT_LT(eigenvalues_of(closed).real().maxCoeff(), 0.0) << mode.label;
  }
}

TEST(Bernard2022, FasterDesignsFallFasterFromJumpToJump) {
  const Design design = designed("bernard2022_equation36", bouncing_ball(), Objective::kMaxDecay);
  const double decay = scalar_value(design.certificate.values, "jump_decay");
  // At bounces without flight between them the velocity keeps 0.8 of its error, whatever the gain.
  EXPECT_NEAR(decay, -std::log(0.8), 1e-3 * decay);
}

TEST(Bernard2022, TheBoundHoldsAlongErrorsAndIsLostAtAJumpSoonerThanT1) {
  CertificateSubject subject = impulsive();
  subject.plant.N = Eigen::MatrixXd::Identity(3, 3);
  NamedMatrices fixed = with_L_d({1.0, 0.2259, 1.0}, 0.05);
  const DesignCandidate proof = certified(kCorollary52, subject, fixed);
  ASSERT_TRUE(proof.is_verified()) << proof.message;
  DrivenBound bound(find_theorem(kCorollary52)
                        ->error_bound(subject, proof.values, assumptions(2.0, 0.01, 0.001)));
  const ModeMatrices& plant = subject.plant.mode();
  const Eigen::MatrixXd& L_d = fixed.at("L_d");
  Eigen::Vector3d e(1.0, -1.0, 1.0);
  EXPECT_LE(e.norm(), bound.value());
  // The first interval may be shorter than T1.
  for (const double tau : {0.3, 2.0, 5.0, 3.1, 5.0, 2.0, 4.4, 5.0, 5.0, 2.5, 5.0, 2.0}) {
    constexpr int kSteps = 100;
    for (int i = 1; i <= kSteps; ++i) {
      e += tau / kSteps * (plant.A * e + Eigen::Vector3d(0.0, 0.001, 0.0));
      bound.flow_to(i == kSteps ? tau : i * tau / kSteps);
      ASSERT_LE(e.norm(), bound.value());
    }
    e = (*plant.A_d * e - L_d * (e(0) + 0.01)).eval();
    bound.jump();
    ASSERT_LE(e.norm(), bound.value());
  }
  ASSERT_TRUE(std::isfinite(bound.value()));
  // Without its outputs a jump corrects nothing.
  bound.flow_to(3.0);
  e = exponential_of(plant.A * 3.0) * e;
  bound.uncorrected_jump();
  e = (*plant.A_d * e).eval();
  EXPECT_LE(e.norm(), bound.value());
  ASSERT_TRUE(std::isfinite(bound.value()));
  const double before = bound.value();
  bound.flow_to(9.0);
  e = exponential_of(plant.A * 9.0) * e;
  EXPECT_LE(e.norm(), bound.value());
  bound.jump();
  e = (*plant.A_d * e - L_d * e(0)).eval();
  EXPECT_LE(e.norm(), bound.value());
  EXPECT_GT(bound.value(), before);
  ASSERT_TRUE(std::isfinite(bound.value()));
  // Sooner than T1: the plant has jumped, or the jump was told twice and only the estimate moved.
  bound.flow_to(1.0);
  e = exponential_of(plant.A * 1.0) * e;
  bound.jump(3.0);
  const Eigen::Vector3d jumped = *plant.A_d * e - L_d * e(0);
  EXPECT_LE(std::max(jumped.norm(), e.norm() + 3.0), bound.value());
  EXPECT_TRUE(std::isfinite(bound.value()));
}

TEST(Bernard2022, ABoundWithoutNoiseGoesToZero) {
  const CertificateSubject subject = impulsive();
  const DesignCandidate proof =
      certified(kCorollary52, subject, with_L_d({1.0, 0.2259, 1.0}, 0.05));
  ASSERT_TRUE(proof.is_verified()) << proof.message;
  DrivenBound bound(
      find_theorem(kCorollary52)->error_bound(subject, proof.values, assumptions(1.0, 0.0, 0.0)));
  bound.jump();
  const double first = bound.value();
  for (int i = 0; i < 100; ++i) {
    bound.flow_to(3.0);
    bound.jump();
  }
  EXPECT_NEAR(bound.value(), first * std::exp(-0.05 * 100), 1e-9 * first);
}

TEST(Bernard2022, StatedMapsGiveTheBoundOfAPlantThatHasThem) {
  CertificateSubject subject = neuron();
  const DesignCandidate proof = certified(kCorollary52, subject, with_L_d({0.0, 0.0028, -0.0063}));
  ASSERT_TRUE(proof.is_verified());
  const auto value = [&] {
    DrivenBound bound(
        find_theorem(kCorollary52)->error_bound(subject, proof.values, assumptions(1.0, 0.1, 0.0)));
    bound.jump();
    bound.flow_to(35.0);
    return bound.value();
  };
  const double own = value();
  subject.plant.stated.A = subject.plant.A();
  EXPECT_EQ(own, value());
}

TEST(Bernard2022, JumpObservabilityFindsTheIntervalThatHidesTheState) {
  // x1 is seen, x2 turns into it: after half a turn it does not show.
  Eigen::MatrixXd A(2, 2);
  A << 0, 1, -1, 0;
  const double pi = std::acos(-1.0);
  CertificateSubject subject =
      jumping(A, Eigen::MatrixXd::Identity(2, 2), pi / 2.0, 3.0 * pi / 2.0);
  const JumpObservability hidden = jump_observability(subject, 2, 5);
  EXPECT_NEAR(hidden.least_gramian, 0.0, 1e-12);
  EXPECT_NEAR(hidden.worst_intervals[1], pi, 1e-12);
  subject.T1 = 0.5;
  subject.T2 = 2.0;
  EXPECT_GT(jump_observability(subject, 2).least_gramian, 0.05);
  // Nothing tells x3, which each jump overwrites.
  EXPECT_NEAR(jump_observability(impulsive(), 2).least_gramian, 0.0, 1e-12);
}

}  // namespace
}  // namespace sampled_data_observers
