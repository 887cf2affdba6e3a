// A design does not depend on the units of the plant file.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "design/certificate_proof.h"
#include "design/plant_scaling.h"
#include "design/run_time_figures.h"
#include "ferrante2019_examples.h"
#include "linear_algebra/matrix_functions.h"
#include "paper_plants.h"
#include "support/long_tests.h"

namespace sampled_data_observers::test {
namespace {

/// The same plant for x = D z, y = E v for all outputs, t = c s.
struct Rewriting {
  std::vector<double> D;
  double E = 1.0;
  double c = 1.0;
};

CertificateSubject rewritten(CertificateSubject subject, const Rewriting& units) {
  const Eigen::VectorXd D =
      Eigen::Map<const Eigen::VectorXd>(units.D.data(), subject.plant.states());
  const Eigen::MatrixXd to_z = D.cwiseInverse().asDiagonal();
  PlantMatrices& plant = subject.plant;
  for (ModeMatrices& mode : plant.modes) {
    mode.A = units.c * to_z * mode.A * D.asDiagonal();
    for (Eigen::MatrixXd* C : {&mode.C, &mode.C_c, &mode.C_d}) {
      if (C->rows() > 0) *C = *C * D.asDiagonal() / units.E;
    }
    if (mode.A_d) *mode.A_d = to_z * *mode.A_d * D.asDiagonal();
  }
  if (plant.lipschitz_jump) plant.lipschitz_jump->J *= D.asDiagonal();
  for (Eigen::MatrixXd& vertex : plant.vertices) vertex = units.c * to_z * vertex * D.asDiagonal();
  plant.N = units.c * to_z * plant.N;
  plant.G = units.c * to_z * plant.G;
  plant.S = plant.S * D.asDiagonal();
  plant.C_p = plant.C_p * D.asDiagonal();
  subject.T1 /= units.c;
  subject.T2 /= units.c;
  if (subject.dwell_time) subject.dwell_time->tau /= units.c;
  return subject;
}

/// Both, or by turns one of the two.
std::vector<Rewriting> rewritings() {
  const std::vector<Rewriting> all = {{{1e6, 1e-6, 2.0}, 1e3, 1e-3}, {{3e-6, 7e4, 1e5}, 2e-5, 1e3}};
  if (long_tests_are_wanted()) return all;
  static std::size_t turn = 0;
  return {all[turn++ % all.size()]};
}

/// An objective, and the figure of a design that it makes small or large, in SI units.
struct Aim {
  Objective objective;
  double tolerance;
};
constexpr Aim kLongest = {Objective::kMaxT2, 2e-3};
constexpr Aim kFastest = {Objective::kMaxDecay, 1e-2};
constexpr Aim kLeastGain = {Objective::kMinGamma, 1e-2};

double figure(const Design& design, const Aim& aim, double c) {
  const Certificate& certificate = design.certificate;
  switch (aim.objective) {
    case Objective::kMaxT2:
      return certificate.subject.T2 * c;
    case Objective::kMaxDecay: {
      const std::string decay = certificate.theorem->decay_parameter();
      return scalar_value(certificate.values, decay) / (decay == "jump_decay" ? 1.0 : c);
    }
    default:
      // The L2 gain from w to y_p is |y_p|/|w|, whatever the time is measured in.
      return scalar_value(certificate.values, "gamma");
  }
}

/// What is given to methods is a rate or has no unit.
Parameters rewritten(Parameters given, const Rewriting& units) {
  for (auto& [name, value] : given) value *= is_rate(name) ? units.c : 1.0;
  return given;
}

void expect_same(const char* method, const CertificateSubject& subject, const Parameters& given,
                 const Aim& aim) {
  const double expected = figure(design_by(method, subject, given, aim.objective), aim, 1.0);
  for (const Rewriting& units : rewritings()) {
    const Design other =
        design_by(method, rewritten(subject, units), rewritten(given, units), aim.objective);
    EXPECT_NEAR(figure(other, aim, units.c), expected, aim.tolerance * expected)
        << method << ", c = " << units.c;
    // As whoever loads the gains checks them, in the units of the plant file.
    const auto checks = check(other.certificate);
    EXPECT_TRUE(all_hold(checks)) << method << ": " << describe_violations(checks);
  }
}

TEST(UnitIndependence, OfConstantGains) {
  expect_same("ferrante2016_corollary1", aircraft(1.0, 1.5), {}, kLongest);
  Eigen::MatrixXd A(2, 2);
  A << 0, 1,  //
      0, 0;
  const CertificateSubject cart = linear_subject(A, Eigen::MatrixXd::Identity(1, 2), 0.5, 1.0);
  expect_same("ferrante2016_corollary1", cart, {}, kFastest);
  expect_same("ferrante2016_proposition1", cart, {}, kFastest);
}

TEST(UnitIndependence, OfTimeVaryingGains) {
  expect_same("sferlazza2019_algorithm1", aircraft(1.0, 1.5), {}, kLongest);
}

/// All of whose states are measured.
TEST(UnitIndependence, OfTheInverseOfTheOutputs) {
  CertificateSubject subject = aircraft(1.0, 1.5);
  subject.plant.modes.front().C = Eigen::MatrixXd::Identity(3, 3);
  subject.plant.modes.front().C(0, 2) = 1.0;
  for (const Rewriting& units : rewritings()) {
    EXPECT_EQ(refusal("sferlazza2019_equation17", rewritten(subject, units), {{"lambda", 0.3}}),
              "");
  }
}

TEST(UnitIndependence, OfTheLeastGain) {
  for (const char* method : {"ferrante2019_proposition2", "ferrante2019_proposition3",
                             "ferrante2019_proposition4", "ferrante2019_proposition5",
                             "ferrante2019_alternating", "ferrante2019_proposition2_predictor",
                             "ferrante2019_alternating_predictor", "ferrante2019_proposition3_hold",
                             "ferrante2019_proposition4_hold", "ferrante2019_alternating_hold"}) {
    expect_same(method, oscillator(0.2), {{"lambda_t", 0.05}, {"delta", 6.0}}, kLeastGain);
  }
}

/// With the defaults, and with a nonlinearity.
TEST(UnitIndependence, OfTheLargestTimesOfFerrante2019) {
  expect_same("ferrante2019_proposition2", oscillator(0.3), {}, kLongest);
  expect_same("ferrante2019_proposition5", oscillator(0.2), {{"delta", 6.0}}, kLongest);
  CertificateSubject pendulum = oscillator(0.3);
  pendulum.plant.G = Eigen::MatrixXd::Identity(2, 1).colwise().reverse();
  pendulum.plant.S = Eigen::MatrixXd::Identity(1, 2);
  pendulum.plant.lipschitz_constant = 0.5;
  expect_same("ferrante2019_proposition2", pendulum, {{"lambda_t", 0.05}, {"delta", 4.0}},
              kLeastGain);
}

/// The drive of etienne2019, example 6, without its nonlinearity.
CertificateSubject drive() {
  Eigen::MatrixXd A(3, 3);
  A << 0, 1, 0,   //
      0, -3, 1,   //
      0, -1, -1;  //
  return linear_subject(A, Eigen::MatrixXd::Identity(1, 3), 0.1, 0.4);
}

TEST(UnitIndependence, OfHeldInnovations) {
  expect_same("etienne2019_proposition1", drive(), {{"alpha", 1.0}}, kLongest);
  expect_same("etienne2019_proposition1", drive(), {}, kFastest);
}

/// The bound is on the norm of the state, so that all states have one unit.
TEST(UnitIndependence, OfTheFinalErrorOfHeldInnovations) {
  CertificateSubject subject = drive();
  subject.plant.N = Eigen::MatrixXd::Identity(3, 1).colwise().reverse();
  const Parameters given = {{"alpha", 1.0}, {"noise_size", 0.05}, {"disturbance_size", 0.2}};
  const auto final_error = [&](const Rewriting& units) {
    Parameters own = rewritten(given, units);
    own["noise_size"] /= units.E;
    const Certificate certificate =
        design_by("etienne2019_proposition2", rewritten(subject, units), own, Objective::kMinGamma)
            .certificate;
    return certificate.theorem->gain_figure(certificate.values).value * units.D.front();
  };
  const double expected = final_error({{1.0, 1.0, 1.0}, 1.0, 1.0});
  for (const double unit : {1e6, 1e-5, 1.0}) {
    for (const double c : {1e-3, 1.0, 1e3}) {
      const Rewriting units = {{unit, unit, unit}, 2e-4, c};
      EXPECT_NEAR(final_error(units), expected, 1e-2 * expected) << unit << ", c = " << c;
    }
  }
}

/// A position that falls, and is turned back at jumps at which it is seen, as at all times.
CertificateSubject bouncing() {
  Eigen::MatrixXd A(2, 2);
  A << 0, 1,  //
      0, -0.1;
  CertificateSubject subject = linear_subject(A, Eigen::MatrixXd(0, 2), 1.0, 5.0);
  ModeMatrices& mode = subject.plant.modes.front();
  mode.A_d = Eigen::MatrixXd(2, 2);
  *mode.A_d << -1, 0,  //
      0, -0.8;
  mode.C_c = Eigen::MatrixXd::Identity(1, 2);
  mode.C_d = Eigen::MatrixXd::Identity(1, 2);
  return subject;
}

CertificateSubject switched() {
  CertificateSubject subject = bouncing();
  std::vector<ModeMatrices>& modes = subject.plant.modes;
  modes.front().A_d.reset();
  modes.front().label = 1;
  modes.push_back(modes.front());
  modes.back().label = 2;
  modes.back().A(1, 0) = -1.0;
  subject.T1 = 0.6;
  subject.T2 = 1.4;
  return subject;
}

TEST(UnitIndependence, OfGainsAtJumps) {
  const Aim fastest = {Objective::kMaxDecay, 2e-3};
  expect_same("bernard2022_equation15", bouncing(), {{"flow_decay", 0.5}}, fastest);
  expect_same("bernard2022_equation22", bouncing(), {{"flow_decay", 0.5}}, fastest);
  CertificateSubject often = bouncing();
  often.T2 = 2.0;
  expect_same("bernard2022_equation26", often, {}, fastest);
  expect_same("bernard2022_equation36", bouncing(), {}, fastest);
  expect_same("bernard2022_example4_2", bouncing(), {{"ell", 4.0}, {"decay_per_ell", 1.0}},
              fastest);
  CertificateSubject by_formulas = bouncing();
  by_formulas.plant.modes.front().A_d.reset();
  by_formulas.plant.lipschitz_jump = LipschitzJump{0.5, Eigen::MatrixXd::Identity(2, 2)};
  expect_same("bernard2022_corollary4_1", by_formulas, {{"ell", 6.0}, {"decay_per_ell", 1.0}},
              fastest);
  expect_same("bernard2022_example7_1", switched(), {{"flow_decay", 0.5}}, fastest);
  CertificateSubject only_at_jumps = switched();
  for (ModeMatrices& mode : only_at_jumps.plant.modes) mode.C_c.resize(0, 2);
  expect_same("bernard2022_section7_3_2", only_at_jumps, {}, fastest);
  expect_same("bernard2022_section7_3_2_metric", only_at_jumps, {}, fastest);
  CertificateSubject only_at_bounces = bouncing();
  only_at_bounces.plant.modes.front().C_c.resize(0, 2);
  expect_same("bernard2022_corollary5_2_metric", only_at_bounces, {}, fastest);
}

CertificateSubject with_dwell_time(CertificateSubject subject, DwellTime::Kind kind) {
  subject.T1 = 0.0;
  subject.T2 = std::numeric_limits<double>::infinity();
  subject.dwell_time = DwellTime{kind, 1.0, 2.0};
  return subject;
}

TEST(UnitIndependence, OfGainsForTimesWithoutBounds) {
  const Aim fastest = {Objective::kMaxDecay, 2e-3};
  const CertificateSubject seldom = with_dwell_time(bouncing(), DwellTime::Kind::kAverage);
  expect_same("bernard2022_equation22_average_dwell_time", seldom, {{"flow_decay", 0.5}}, fastest);
  const CertificateSubject often = with_dwell_time(bouncing(), DwellTime::Kind::kReverseAverage);
  expect_same("bernard2022_equation26_reverse_average_dwell_time", often, {}, fastest);
  CertificateSubject projected = switched();
  projected.T1 = 0.0;
  expect_same("bernard2022_section7_3_1", projected, {}, fastest);
}

/// For noise and disturbance in the units of the outputs and of N, the same design comes out: its
/// gains, in SI units.
void expect_same_gain_for_the_least_final_error(const char* method, const Parameters& given) {
  const auto found_for = [&](const CertificateSubject& subject, double noise, double c) {
    DesignProblem problem;
    problem.subject = subject;
    problem.subject.plant.C_p.resize(0, subject.plant.states());
    problem.objective = Objective::kMinFinalError;
    problem.assumptions.noise = noise;
    problem.assumptions.disturbance = 2.0;
    for (const auto& [name, value] : given) problem.given[name] = c * value;
    SynthesisOptions options;
    options.jobs = 2;
    return synthesize(*find_design_method(method), problem, options);
  };
  const CertificateSubject subject = oscillator(0.2);
  const Eigen::MatrixXd L = found_for(subject, 0.1, 1.0).certificate.values.at("L");
  for (const Rewriting& units : rewritings()) {
    const Design other = found_for(rewritten(subject, units), 0.1 / units.E, units.c);
    const Eigen::VectorXd D = Eigen::Map<const Eigen::VectorXd>(units.D.data(), 2);
    const Eigen::MatrixXd L_in_SI =
        D.asDiagonal() * other.certificate.values.at("L") / (units.E * units.c);
    EXPECT_LT(norm2(L_in_SI - L), 0.01 * norm2(L)) << L_in_SI << " and " << L;
  }
}

TEST(UnitIndependence, OfTheLeastFinalError) {
  expect_same_gain_for_the_least_final_error("ferrante2019_proposition2",
                                             {{"lambda_t", 0.1}, {"delta", 6.0}});
  expect_same_gain_for_the_least_final_error("etienne2019_proposition2", {{"alpha", 1.0}});
}

/// A flexible drive: angles [µrad], speeds [rpm], torque [kN m] of a slow actuator.
CertificateSubject flexible_drive() {
  Eigen::MatrixXd A(5, 5);
  A << 0, 1, 0, 0, 0,       //
      -40, -0.8, 40, 0, 1,  //
      0, 0, 0, 1, 0,        //
      25, 0, -30, -0.9, 0,  //
      0, 0, 0, 0, -2;
  Eigen::MatrixXd C(2, 5);
  C << 1, 0, 0, 0, 0,  //
      0, 0, 1, 0, 0;
  const double rpm = std::acos(-1.0) / 30.0;
  return rewritten(linear_subject(A, C, 0.02, 0.08), {{1e-6, rpm, 1e-6, rpm, 1e3}, 1e-6, 1.0});
}

TEST(UnitIndependence, LetsAllMethodsServeAPlantInTheUnitsOfItsField) {
  for (const char* method :
       {"ferrante2016_corollary1", "sferlazza2019_algorithm1", "ferrante2019_proposition2",
        "ferrante2019_proposition4", "etienne2019_proposition1"}) {
    EXPECT_EQ(refusal(method, flexible_drive()), "") << method;
  }
}

/// As `design verify --rigorous` does it, of the numbers in the file.
TEST(UnitIndependence, OfWhatCanBeProvedOfAGainFile) {
  const CertificateSubject wild =
      rewritten(flexible_drive(), {{1e6, 1e-6, 2.0, 3e5, 1e-4}, 1.0, 1e-3});
  for (const char* method : {"ferrante2016_corollary1", "sferlazza2019_algorithm1",
                             "ferrante2019_proposition2", "etienne2019_proposition1"}) {
    Certificate certificate = design_by(method, wild).certificate;
    EXPECT_EQ(first_unproved(prove(certificate, ProofOptions())), "") << method;
    const char* gain = certificate.values.count("L") > 0 ? "L" : "P";
    certificate.values.at(gain) *= -1.0;
    EXPECT_NE(first_unproved(prove(certificate, ProofOptions())), "") << method;
  }
}

/// In which eigenvalues of P as it is are lost in rounding.
TEST(UnitIndependence, OfWhetherThereIsABoundOnTheError) {
  ErrorAssumptions noise;
  noise.noise = 1.0;
  const CertificateSubject wild =
      rewritten(flexible_drive(), {{1e6, 1e-6, 2.0, 3e5, 1e-4}, 1.0, 1e-3});
  for (const char* method : {"ferrante2016_corollary1", "sferlazza2019_algorithm1",
                             "ferrante2019_proposition2", "ferrante2019_proposition4"}) {
    const Certificate certificate = design_by(method, wild).certificate;
    const RunTimeFigures figures =
        run_time_figures(*certificate.theorem, certificate.subject, certificate.values, noise);
    EXPECT_TRUE(std::isfinite(figures.final_error) && figures.final_error > 0.0) << method;
    EXPECT_GE(figures.factor_on_start, 1.0) << method;
  }
}

TEST(UnitIndependence, DesignsForFastModesThatPIsIdentitySolves) {
  Eigen::MatrixXd cart(2, 2);
  cart << 0, 1,  //
      0, -200;
  Eigen::MatrixXd servo(3, 3);
  servo << 0, 1, 0,  //
      0, -1, 1,      //
      0, 0, -100;
  for (const char* method : {"sferlazza2019_algorithm1", "ferrante2016_corollary1"}) {
    EXPECT_EQ(refusal(method, linear_subject(cart, Eigen::MatrixXd::Identity(1, 2), 0.05, 0.2)), "")
        << method;
    EXPECT_EQ(refusal(method, linear_subject(servo, Eigen::MatrixXd::Identity(1, 3), 0.05, 0.2)),
              "")
        << method;
  }
}

}  // namespace
}  // namespace sampled_data_observers::test
