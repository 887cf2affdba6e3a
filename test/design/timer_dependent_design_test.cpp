// Designs and proofs by Lyapunov functions that depend on timers, against numbers that an
// independent program gave.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "design/analysis.h"
#include "design/request_error.h"
#include "design/rigorous_check.h"
#include "design/run_time_figures.h"
#include "design/worst_intervals.h"
#include "timer_dependent_plants.h"

namespace sampled_data_observers::test {
namespace {

double gamma_of(const Design& design) {
  EXPECT_EQ(design.proved_conditions,
            design.certificate.theorem->conditions(design.certificate.subject).size());
  return scalar_value(design.certificate.values, "gamma");
}

double analyzed_gamma(int cells) {
  AnalysisProblem problem;
  problem.theorem = find_theorem("timer_dependent_intersample_injection");
  problem.subject = with_cells(densely_sampled_oscillator(0.41), cells);
  problem.gains["L"] = Eigen::Vector2d(2.067, -3.0);  // ferrante2019 (51)
  problem.gains["H"] = scalar_matrix(-1.384);
  problem.given = {{"lambda_t", 0.05}};
  problem.objective = Objective::kMinGamma;
  return gamma_of(analyze(problem, {}));
}

TEST(TimerDependentAnalysis, FindsTheGammaOfThePrintedGains) {
  // Theorem 2 of the paper proves 32.92 of them.
  EXPECT_NEAR(analyzed_gamma(4), 2.4457, 0.002 * 2.4457);
  EXPECT_NEAR(analyzed_gamma(8), 2.0037, 0.002 * 2.0037);
  EXPECT_NEAR(analyzed_gamma(16), 1.7830, 0.002 * 1.7830);
}

double designed_gamma(int cells) {
  return gamma_of(design_by("timer_dependent_constant_gain",
                            with_cells(densely_sampled_oscillator(0.41), cells),
                            {{"lambda_t", 0.05}}, Objective::kMinGamma));
}

TEST(TimerDependentDesign, OfOneGainIsTheBestForItsCells) {
  EXPECT_NEAR(designed_gamma(4), 1.717, 0.002 * 1.717);
  EXPECT_NEAR(designed_gamma(8), 1.404, 0.002 * 1.404);
  EXPECT_NEAR(designed_gamma(16), 1.251, 0.002 * 1.251);
}

TEST(TimerDependentDesign, RefinesItsCellsUntilThatGainsLittle) {
  const Design design = design_by("timer_dependent_constant_gain", densely_sampled_oscillator(0.41),
                                  {{"lambda_t", 0.05}}, Objective::kMinGamma);
  EXPECT_LE(gamma_of(design), 1.2);
  EXPECT_GT(design.certificate.subject.timer_nodes.front().size(), 16u);
}

TEST(TimerDependentDesign, FusesTwoSensorsByGainsOfBothTimers) {
  const Design design =
      design_by("timer_dependent_scheduled_gain", with_cells(triple_integrator(), 3),
                {{"lambda_t", 0.05}}, Objective::kMinGamma);
  EXPECT_LE(gamma_of(design), 0.0325);
  const std::string told = statement(design.certificate);
  for (const char* times : {"position: T1 = 0.2 s, T2 = 1 s", "speed: T1 = 0.05 s, T2 = 0.2 s)"}) {
    EXPECT_NE(told.find(times), std::string::npos) << told;
  }
}

TEST(TimerDependentDesign, FusesSensorsThatAreSampledAsDenselyAsOneLikes) {
  CertificateSubject subject = triple_integrator();
  set_sensor_times(subject, {{0.0, 1.0}, {0.0, 0.2}});
  const Design design = design_by("timer_dependent_scheduled_gain", with_cells(subject, 3),
                                  {{"lambda_t", 0.05}}, Objective::kMinGamma);
  // Fewer samples were foreseen in the other test.
  EXPECT_LE(gamma_of(design), 0.1);
  EXPECT_EQ(design.certificate.values.count("K/speed/0"), 0u);
  // Samples of one sensor one right after another: each changes what is measured alone.
  const Eigen::MatrixXd& P = design.certificate.values.at("P/0");
  const Eigen::MatrixXd C = Eigen::MatrixXd::Identity(3, 3).row(1);
  const double Z = design.certificate.values.at("Z/speed/0")(0, 0);
  const Eigen::Matrix3d reset = Eigen::Matrix3d::Identity() - P.inverse() * C.transpose() * Z * C;
  const Eigen::Matrix3d fall = P - reset.transpose() * P * reset;
  EXPECT_GT(fall(1, 1), 0.0);
  EXPECT_LT((fall - fall(1, 1) * C.transpose() * C).norm(), 1e-9 * P.norm());
}

/// x1' = 0.5 x1 + w, x2' = x2 + w, with a sensor of each.
CertificateSubject two_unstable_states() {
  const Eigen::MatrixXd A = Eigen::Vector2d(0.5, 1.0).asDiagonal();
  CertificateSubject subject = linear_subject(A, Eigen::MatrixXd::Identity(2, 2), 0.0, 0.0);
  subject.plant.sampled = {{"first", 0, 0, 1}, {"second", 1, 1, 1}};
  subject.plant.N = Eigen::MatrixXd::Ones(2, 1);
  subject.plant.C_p = Eigen::MatrixXd::Identity(2, 2);
  set_sensor_times(subject, {{0.1, 0.5}, {0.2, 0.6}});
  return subject;
}

TEST(TimerDependentDesign, NeedsEachOfTwoSensorsThatShowAnUnstableStateEach) {
  const Design design =
      design_by("timer_dependent_scheduled_gain", with_cells(two_unstable_states(), 3),
                {{"lambda_t", 0.05}}, Objective::kMinGamma);
  EXPECT_LE(gamma_of(design), 2.0);
  const CertificateSubject both = two_unstable_states();
  for (Eigen::Index sensor = 0; sensor < 2; ++sensor) {
    CertificateSubject alone = linear_subject(both.plant.A(), both.plant.C().row(sensor), 0.1, 0.6);
    const std::string reason =
        refusal("timer_dependent_constant_gain", alone, {{"lambda_t", 0.05}});
    EXPECT_NE(reason.find(sensor == 0 ? "x2" : "x1"), std::string::npos) << reason;
  }
}

TEST(TimerDependentDesign, OfTwoSensorsIsRunAtTheirTimesToTheNanosecond) {
  // Sums of rounded intervals would be sooner than T1, where no proof lets the bound fall.
  const CertificateSubject subject = [] {
    CertificateSubject of_uneven_times = two_unstable_states();
    set_sensor_times(of_uneven_times, {{0.1037, 0.5}, {0.2171, 0.6}});
    return with_cells(of_uneven_times, 3);
  }();
  const Design design = design_by("timer_dependent_scheduled_gain", subject, {{"lambda_t", 0.3}},
                                  Objective::kMinGamma);
  ErrorAssumptions noise;
  noise.noise = 1.0;
  const RunTimeFigures figures =
      run_time_figures(*design.certificate.theorem, subject, design.certificate.values, noise);
  EXPECT_LT(figures.factor_on_start, 1e5);
  EXPECT_LT(figures.time_to_hundredth, 100.0);
}

TEST(TimerDependentDesign, LeavesLessThanTheWorstIrregularTimesAtAnyOthers) {
  const Eigen::Matrix2d A{(Eigen::Matrix2d() << 0.0, 1.0, 0.0, 0.0).finished()};
  const Design design =
      design_by("timer_dependent_constant_gain",
                with_cells(linear_subject(A, Eigen::RowVector2d(1.0, 0.0), 0.1, 0.5), 4),
                {{"lambda_t", 0.3}}, Objective::kFeasible);
  CertificateSubject subject = design.certificate.subject;
  const Theorem& theorem = *design.certificate.theorem;
  const NamedMatrices& values = design.certificate.values;
  ErrorAssumptions noise;
  noise.noise = 1.0;
  const double regular = final_error(theorem, subject, values, noise);
  const std::optional<double> worst = worst_intervals_final_error(theorem, subject, values, noise);
  ASSERT_TRUE(worst);
  const auto bound = theorem.error_bound(subject, values, noise);
  std::vector<double> workspace(static_cast<std::size_t>(bound->workspace_size()));
  std::mt19937 random(1);
  double largest = 0.0;
  for (int run = 0; run < 20; ++run) {
    std::vector<double> state(static_cast<std::size_t>(bound->state_size()));
    bound->initialize(state.data());
    for (int sample = 0; sample < 500; ++sample) {
      // Noise of many short intervals adds up before a long one, in every second run.
      const bool is_long = run % 2 == 0 ? sample % 50 == 49 : random() % 2 == 0;
      bound->flow(is_long ? 0.5 : 0.1 + 1e-9 * static_cast<double>(random() % 1000), state.data());
      largest = std::max(largest, bound->bound(state.data()));
      bound->sample(0, state.data(), workspace.data());
    }
  }
  EXPECT_GT(largest, 1.01 * regular);
  EXPECT_LT(largest, 1.000001 * *worst);
  EXPECT_GT(largest, 0.9 * *worst);
  subject.T1 = subject.T2;
  EXPECT_FALSE(worst_intervals_final_error(theorem, subject, values, noise));
}

TEST(TimerDependentAnalysis, OfUselessGainsEndsAtNoTime) {
  AnalysisProblem problem;
  problem.theorem = find_theorem("timer_dependent_constant_gain");
  problem.subject =
      linear_subject(Eigen::MatrixXd::Ones(1, 1), Eigen::MatrixXd::Ones(1, 1), 0.1, 0.4);
  problem.gains = {{"L", scalar_matrix(0.01)}};
  problem.given = {{"lambda_t", 0.1}};
  problem.objective = Objective::kMaxT2;
  EXPECT_THROW(analyze(problem, {}), DesignError);
}

TEST(TimerDependentProof, IsAboutExactProducts) {
  // −2 F − 2 λ = C_p² exactly, which in double precision is less by one.
  constexpr double kRoot = 94906267.0;
  constexpr double kF = -4503599757937645.0;
  CertificateSubject subject =
      linear_subject(Eigen::MatrixXd::Constant(1, 1, kF), Eigen::MatrixXd::Ones(1, 1), 0.0, 1.0);
  subject.plant.N = Eigen::MatrixXd::Zero(1, 1);
  subject.plant.C_p = Eigen::MatrixXd::Constant(1, 1, kRoot);
  subject.timer_nodes = {{0.0, 1.0}};
  const Eigen::MatrixXd one = scalar_matrix(1.0);
  const NamedMatrices values = {{"L", one},    {"P_measured", one},      {"P_rest", one},
                                {"P/1", one},  {"nu/output", 4.0 * one}, {"lambda_t", one / 2.0},
                                {"gamma", one}};
  bool is_flow_proved = false;
  for (const ConditionProof& proof :
       prove(find_theorem("timer_dependent_constant_gain")->conditions(subject), values)) {
    if (proof.name.rfind("flow", 0) != 0) continue;
    is_flow_proved |= proof.status == ProofStatus::kProved;
  }
  EXPECT_FALSE(is_flow_proved);
}

TEST(TimerDependentDesign, CorrectsAtSwitchesWhatNoModeShowsAlone) {
  CertificateSubject subject =
      CertifiedGains("config/examples/bernard2022_switched/gains.yaml").certificate().subject;
  const auto design = [&] {
    return design_by("timer_dependent_switched_gain", with_cells(subject, 6), {{"lambda_t", 0.015}},
                     Objective::kFeasible);
  };
  const Design found = design();
  EXPECT_EQ(found.proved_conditions,
            found.certificate.theorem->conditions(found.certificate.subject).size());
  // After half a turn the output shows the same again.
  subject.T2 = 3.2;
  EXPECT_THROW(design(), DesignError);
  subject.plant.modes.pop_back();
  EXPECT_THROW(require_subject(*found.certificate.theorem, subject), std::invalid_argument);
}

TEST(TimerDependentDesign, CorrectsAtSwitchesBetweenThreeModes) {
  CertificateSubject subject =
      CertifiedGains("config/examples/bernard2022_switched/gains.yaml").certificate().subject;
  // Each mode turns two of the states.
  ModeMatrices third = subject.plant.modes.front();
  third.label = 7;
  third.A << 0, 0, 1, 0, 0, 0, -1, 0, 0;
  subject.plant.modes.push_back(third);
  for (ModeMatrices& mode : subject.plant.modes) mode.C_d = Eigen::MatrixXd::Identity(2, 3);
  const Design found = design_by("timer_dependent_switched_gain", with_cells(subject, 6),
                                 {{"lambda_t", 0.001}}, Objective::kFeasible);
  EXPECT_EQ(found.proved_conditions,
            found.certificate.theorem->conditions(found.certificate.subject).size());
  EXPECT_EQ(found.certificate.values.count("L_d/7"), 1u);
}

TEST(TimerDependentDesign, IsForAllFlowsInAHull) {
  CertificateSubject subject = with_cells(densely_sampled_oscillator(0.3), 4);
  const auto gamma = [&] {
    return gamma_of(design_by("timer_dependent_constant_gain", subject, {{"lambda_t", 0.05}},
                              Objective::kMinGamma));
  };
  const double of_one = gamma();
  // The same flow twice is the same; with others gamma grows.
  const Eigen::MatrixXd A = subject.plant.A();
  subject.plant.flow_vertices = {A, A};
  EXPECT_NEAR(gamma(), of_one, 0.01 * of_one);
  subject.plant.flow_vertices.back()(1, 0) = -8.0;
  EXPECT_GT(gamma(), 1.05 * of_one);
  EXPECT_THROW(require_subject(*find_theorem("ferrante2019_theorem2"), subject),
               std::invalid_argument);
}

TEST(TimerDependentTheorem, IsNotAboutJumpMapsByALipschitzConstant) {
  CertificateSubject subject =
      linear_subject(-Eigen::MatrixXd::Identity(2, 2), Eigen::MatrixXd(0, 2), 0.2, 0.4);
  ModeMatrices& mode = subject.plant.modes.front();
  subject.plant.sampled.clear();
  mode.C_d = Eigen::MatrixXd::Identity(1, 2);
  subject.plant.lipschitz_jump = LipschitzJump{1.5, Eigen::MatrixXd::Identity(2, 2)};
  const Theorem& theorem = *find_theorem("timer_dependent_synchronized");
  EXPECT_THROW(require_subject(theorem, subject), std::invalid_argument);
  mode.A_d = Eigen::MatrixXd::Identity(2, 2);
  EXPECT_NO_THROW(require_subject(theorem, subject));
}

}  // namespace
}  // namespace sampled_data_observers::test
