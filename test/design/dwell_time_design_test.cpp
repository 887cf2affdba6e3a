// bernard2022: designs for jumps that are bounded on average, and for times without end.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "design/bernard2022_plants.h"

namespace sampled_data_observers {
namespace {

/// Times between jumps, in turn, of which every N0-th is long and the others are none.
std::vector<double> bursts(double tau, int N0) {
  std::vector<double> times(static_cast<std::size_t>(N0), 0.0);
  times.front() = tau * N0;
  return times;
}

/// The largest part of an error that is left after whole turns of these times, per second.
double rate_over(const ModeMatrices& plant, const Eigen::MatrixXd& flow,
                 const Eigen::MatrixXd& reset, const std::vector<double>& times) {
  Eigen::MatrixXd turn = Eigen::MatrixXd::Identity(plant.A.rows(), plant.A.rows());
  double length = 0.0;
  for (const double tau : times) {
    turn = (reset * exponential_of(tau * flow) * turn).eval();
    length += tau;
  }
  return std::log(spectral_radius(turn)) / length;
}

DwellTime average(double tau, double N0) { return {DwellTime::Kind::kAverage, tau, N0}; }
DwellTime reverse_average(double tau, double N0) {
  return {DwellTime::Kind::kReverseAverage, tau, N0};
}

CertificateSubject with_dwell_time(CertificateSubject subject, const DwellTime& dwell_time) {
  subject.T1 = 0.0;
  subject.T2 = std::numeric_limits<double>::infinity();
  subject.dwell_time = dwell_time;
  return subject;
}

TEST(Bernard2022, AnAverageDwellTimeLetsJumpsComeInBursts) {
  CertificateSubject subject = with_dwell_time(bouncing_ball(), average(1.0, 3.0));
  ModeMatrices& mode = subject.plant.modes.front();
  mode.C_c = Eigen::MatrixXd::Identity(1, 2);
  mode.A_d = Eigen::MatrixXd(-1.5 * Eigen::MatrixXd::Identity(2, 2));
  for (const char* method :
       {"bernard2022_equation22_average_dwell_time", "bernard2022_equation15_average_dwell_time"}) {
    SCOPED_TRACE(method);
    const Design design =
        designed(method, subject, Objective::kFeasible, {{"decay", 0.2}, {"gain_bound", 10.0}});
    const NamedMatrices& values = design.certificate.values;
    const Eigen::MatrixXd flow = mode.A - values.at("L_c") * mode.C_c;
    Eigen::MatrixXd reset = *mode.A_d;
    if (values.count("L_d") > 0) reset -= values.at("L_d") * mode.C_d;
    const double decay = scalar_value(values, "decay");
    EXPECT_GT(decay, 0.0);
    for (const int N0 : {1, 2, 3}) {
      EXPECT_LT(rate_over(mode, flow, reset, bursts(1.0, N0)), -decay) << N0;
    }
    const std::vector<GuaranteedFigure> figures =
        design.certificate.theorem->guaranteed_figures(subject, values);
    ASSERT_EQ(figures.size(), 1u);
    const double a_d = scalar_value(values, "flow_decay") - 2.0 * decay;
    EXPECT_NEAR(figures.front().value, std::exp(1.5 * a_d), 1e-9 * figures.front().value);
  }
  // Too many jumps for the gain.
  subject.dwell_time->tau = 1e-3;
  EXPECT_THROW(designed("bernard2022_equation22_average_dwell_time", subject, Objective::kFeasible,
                        {{"gain_bound", 10.0}}),
               DesignError);
}

TEST(Bernard2022, AReverseAverageDwellTimeLetsJumpsBeLeftOut) {
  const CertificateSubject subject = with_dwell_time(bouncing_ball(), reverse_average(0.5, 2.0));
  const Design design = designed("bernard2022_equation26_reverse_average_dwell_time", subject);
  const NamedMatrices& values = design.certificate.values;
  const ModeMatrices& mode = subject.plant.mode();
  const Eigen::MatrixXd reset = *mode.A_d - values.at("L_d") * mode.C_d;
  for (const int N0 : {1, 2}) {
    EXPECT_LT(rate_over(mode, mode.A, reset, bursts(0.5, N0)), -scalar_value(values, "decay"));
  }
  // The bound holds over pauses and bursts, and falls.
  DrivenBound bound(
      design.certificate.theorem->error_bound(subject, values, assumptions(2.0, 0.0, 0.0)));
  Eigen::Vector2d e(1.0, -1.0);
  for (int turn = 0; turn < 40; ++turn) {
    for (const double tau : {1.2, 0.01, 0.01}) {
      bound.flow_to(tau);
      e = (exponential_of(tau * mode.A) * e).eval();
      ASSERT_LE(e.norm(), bound.value());
      bound.jump();
      e = (reset * e).eval();
      ASSERT_LE(e.norm(), bound.value());
    }
  }
  EXPECT_LT(bound.value(), 1.0);
}

TEST(Bernard2022, SwitchedPlantsHaveDwellTimesOnAverage) {
  CertificateSubject subject = with_dwell_time(switched(), average(0.5, 2.0));
  for (ModeMatrices& mode : subject.plant.modes) {
    mode.C_d.resize(0, 3);
    mode.C_c = Eigen::MatrixXd::Zero(2, 3);
    mode.C_c(0, 0) = 1.0;
    mode.C_c(1, 2) = 1.0;
  }
  designed("bernard2022_example7_1_average_dwell_time", subject);
  // Of which jumps show enough in each mode.
  for (ModeMatrices& mode : subject.plant.modes) {
    mode.C_d = Eigen::MatrixXd::Identity(2, 3);
    mode.C_c.resize(0, 3);
    mode.A -= 0.2 * Eigen::MatrixXd::Identity(3, 3);
    mode.A_d = Eigen::MatrixXd(0.9 * Eigen::MatrixXd::Identity(3, 3));
  }
  subject.dwell_time = reverse_average(0.5, 2.0);
  const Design design = designed("bernard2022_equation49_reverse_average_dwell_time", subject);
  Eigen::MatrixXd turn = Eigen::MatrixXd::Identity(3, 3);
  for (const ModeMatrices& mode : subject.plant.modes) {
    const Eigen::MatrixXd& L_d = design.certificate.values.at(of_mode("L_d", mode));
    turn = (*mode.A_d - L_d * mode.C_d) * exponential_of(0.5 * mode.A) * turn;
  }
  EXPECT_LT(spectral_radius(turn), 1.0);
}

TEST(Bernard2022, FlowThatConvergesNeedsNoLongestTime) {
  CertificateSubject subject = bouncing_ball();
  subject.T1 = 0.5;
  subject.T2 = std::numeric_limits<double>::infinity();
  subject.plant.modes.front().C_c = Eigen::MatrixXd::Identity(1, 2);
  designed("bernard2022_equation22", subject);
  EXPECT_THROW(designed("bernard2022_equation26", subject), DesignError);
  EXPECT_THROW(designed("bernard2022_equation36", subject), DesignError);
  // Nor a shortest one, where jumps contract as well.
  subject.T1 = 0.0;
  designed("bernard2022_equation15", subject);
}

TEST(Bernard2022, AHighGainBearsAnyAverageDwellTime) {
  CertificateSubject subject = bouncing_ball();
  ModeMatrices& mode = subject.plant.modes.front();
  mode.C_c = Eigen::MatrixXd::Identity(1, 2);
  mode.A_d = Eigen::MatrixXd(-3.0 * Eigen::MatrixXd::Identity(2, 2));
  for (const double tau : {2.0, 0.1}) {
    const Design design = designed("bernard2022_example4_2_average_dwell_time",
                                   with_dwell_time(subject, average(tau, 5.0)));
    const NamedMatrices& values = design.certificate.values;
    // Jumps of e^{a_d}, a_d = 2 log 3, take a decay in flow of a_d / tau and what is to be left.
    const double needed = 2.0 * std::log(3.0) + 2.0 * 0.01;
    EXPECT_NEAR(scalar_value(values, "flow_decay") * tau, needed, 2e-3 * needed);
    EXPECT_NEAR(design.certificate.theorem->guaranteed_figures(design.certificate.subject, values)
                    .front()
                    .value,
                std::pow(3.0, 5.0), 0.01 * std::pow(3.0, 5.0));
  }
}

}  // namespace
}  // namespace sampled_data_observers
