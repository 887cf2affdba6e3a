// bernard2022: gains L(τ) of a metric, and projections that let no switch make V grow.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "certificate/theorems.h"
#include "design/bernard2022_plants.h"
#include "design/certified.h"
#include "design/synthesis.h"
#include "linear_algebra/matrix_functions.h"
#include "observer/metric_gain.h"

namespace sampled_data_observers {
namespace {

CertificateSubject turning(double T1, double T2) {
  CertificateSubject subject = switched();
  subject.T1 = T1;
  subject.T2 = T2;
  return subject;
}

/// An oscillator whose jumps make its speed larger.
CertificateSubject kicked(double T1, double T2) {
  CertificateSubject subject;
  Eigen::MatrixXd A(2, 2);
  A << 0, 1, -1, 0;
  subject.plant = linear_plant(A);
  ModeMatrices& mode = subject.plant.modes.front();
  mode.A_d = Eigen::MatrixXd(Eigen::Vector2d(1.0, 1.2).asDiagonal());
  mode.C_d = Eigen::MatrixXd::Identity(1, 2);
  subject.T1 = T1;
  subject.T2 = T2;
  return subject;
}

/// By how much √V falls, at least, over random times and modes, with the gains of an observer.
double least_fall(const Design& design) {
  const CertificateSubject& subject = design.certificate.subject;
  const std::vector<ModeMatrices>& modes = subject.plant.modes;
  std::vector<MetricGain> gains;
  std::vector<Eigen::MatrixXd> metrics;
  for (const ModeMatrices& mode : modes) {
    metrics.push_back(
        design.certificate.values.at(modes.size() > 1 ? of_mode("metric", mode) : "metric"));
    gains.emplace_back(mode.A, jump_of(mode), mode.C_d, metrics.back());
  }
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> interval(subject.T1, subject.T2);
  std::normal_distribution<double> normal;
  const Eigen::Index n = subject.plant.states();
  double least = 1e9;
  for (int i = 0; i < 2000; ++i) {
    const std::size_t mode = static_cast<std::size_t>(i) % modes.size();
    const std::size_t next = (mode + 1) % modes.size();
    const double tau = i < 4 ? (i < 2 ? subject.T1 : subject.T2) : interval(generator);
    Eigen::VectorXd e(n);
    for (Eigen::Index k = 0; k < n; ++k) e(k) = normal(generator);
    Eigen::MatrixXd L(n, modes[mode].C_d.rows());
    Eigen::VectorXd workspace(gains[mode].workspace_size());
    gains[mode].evaluate(from_seconds(tau), L.data(), workspace.data());
    const Eigen::VectorXd before = exponential_of(tau * modes[mode].A) * e;
    const Eigen::VectorXd after = jump_of(modes[mode]) * before - L * modes[mode].C_d * before;
    least = std::min(least,
                     0.5 * std::log(e.dot(metrics[mode] * e) / after.dot(metrics[next] * after)));
  }
  return least;
}

TEST(MetricDesignTest, GainsThatKnowTheTimeServeLongerOnesThanConstantGains) {
  for (const bool is_switched : {true, false}) {
    SCOPED_TRACE(is_switched);
    const CertificateSubject subject = is_switched ? turning(0.6, 1.4) : kicked(0.5, 0.8);
    const char* constant = is_switched ? "bernard2022_section7_3_2" : "bernard2022_equation36";
    const char* metric =
        is_switched ? "bernard2022_section7_3_2_metric" : "bernard2022_corollary5_2_metric";
    const Design fixed = designed(constant, subject, Objective::kMaxT2);
    const Design moving = designed(metric, subject, Objective::kMaxT2);
    EXPECT_GT(moving.certificate.subject.T2, 1.1 * fixed.certificate.subject.T2);
    // After half a turn the output shows the same again.
    EXPECT_LT(moving.certificate.subject.T2, std::acos(-1.0));
    EXPECT_GE(least_fall(moving), scalar_value(moving.certificate.values, "jump_decay"));
    RecordProperty(is_switched ? "switched" : "synchronized",
                   std::to_string(moving.certificate.subject.T2) + " s, constant " +
                       std::to_string(fixed.certificate.subject.T2) + " s");
  }
}

/// Three turning states of which two are measured.
CertificateSubject twice_measured(double T1, double T2) {
  CertificateSubject subject = kicked(T1, T2);
  Eigen::MatrixXd A(3, 3);
  A << 0, 1, 0, -1, 0, 1, 0, -1, 0;
  subject.plant = linear_plant(A);
  ModeMatrices& mode = subject.plant.modes.front();
  mode.A_d = Eigen::MatrixXd(1.05 * Eigen::MatrixXd::Identity(3, 3));
  mode.C_d = Eigen::MatrixXd::Identity(2, 3);
  return subject;
}

TEST(MetricDesignTest, GainsTakeSeveralOutputs) {
  const Design design = designed("bernard2022_corollary5_2_metric", twice_measured(0.5, 0.8));
  EXPECT_GE(least_fall(design), scalar_value(design.certificate.values, "jump_decay"));
}

/// What tells the second output from the first has decayed by e^-35: the gain of an observer would
/// be L(0), with which the error grows.
TEST(MetricDesignTest, OutputsThatTheFlowMakesAlikeAreRefused) {
  for (const bool are_alike : {true, false}) {
    SCOPED_TRACE(are_alike);
    const double tau = are_alike ? 35.0 : 1.0;
    CertificateSubject subject = kicked(tau, tau);
    subject.plant = linear_plant(Eigen::MatrixXd(Eigen::Vector3d(0.0, -1.0, 0.0).asDiagonal()));
    ModeMatrices& mode = subject.plant.modes.front();
    mode.A_d = Eigen::MatrixXd(0.9 * Eigen::MatrixXd::Identity(3, 3));
    mode.C_d.resize(2, 3);
    mode.C_d << 1, 0, 0, 1, 1, 0;
    Eigen::MatrixXd P(3, 3);
    P << 1, 0, 0, 0, 1, 0.9, 0, 0.9, 1;
    Certificate certificate{&bernard2022_corollary5_2_metric(), subject, {}};
    certificate.values = {{"metric", P}, {"jump_decay", scalar_matrix(0.1)}};
    for (const ConditionCheck& check : check(certificate)) {
      EXPECT_EQ(check.holds(), !are_alike || check.name != "independent outputs") << check.name;
    }
  }
}

/// Two modes that spin in opposite senses, each stable with its own gain.
CertificateSubject projected() {
  CertificateSubject subject;
  Eigen::MatrixXd A(3, 3);
  A << 0, 1, 0, -1, 0, 1, 0, 0, -0.1;
  subject.plant = linear_plant(A);
  subject.plant.modes.push_back(subject.plant.mode());
  ModeMatrices& second = subject.plant.modes.back();
  second.A << 0, -2, 0, 3, 0, -4, 1, 0, -0.1;
  for (int i = 0; i < 2; ++i) {
    ModeMatrices& mode = subject.plant.modes[static_cast<std::size_t>(i)];
    mode.label = i + 1;
    mode.C_c.resize(1, 3);
    mode.C_c << 0.6, 0.1, 0.3;
  }
  subject.T1 = 0.0;
  subject.T2 = std::numeric_limits<double>::infinity();
  return subject;
}

TEST(ProjectionDesignTest, NoSwitchingMakesTheErrorGrow) {
  const CertificateSubject subject = projected();
  const Design design =
      designed("bernard2022_section7_3_1", subject, Objective::kFeasible, {{"decay", 0.05}});
  const NamedMatrices& values = design.certificate.values;
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(3, 3);
  std::vector<Eigen::MatrixXd> flows;
  std::vector<Eigen::MatrixXd> projectors;
  std::vector<Eigen::MatrixXd> P;
  for (const ModeMatrices& mode : subject.plant.modes) {
    const Eigen::MatrixXd& H = mode.C_c;
    const Eigen::MatrixXd lifted =
        inverse_of(values.at(of_mode("projection", mode))) * H.transpose();
    projectors.push_back(unit - lifted * inverse_of(H * lifted) * H);
    P.push_back(projectors.back().transpose() * values.at("Q") * projectors.back() +
                H.transpose() * values.at(of_mode("S", mode)) * H);
    flows.push_back(mode.A - values.at(of_mode("L_c", mode)) * H);
  }
  std::mt19937_64 generator(9);
  std::exponential_distribution<double> interval(10.0);
  Eigen::VectorXd e = Eigen::Vector3d(1.0, -2.0, 0.5);
  double time = 0.0;
  const double first = e.dot(P[0] * e);
  for (std::size_t i = 0; i < 400; ++i) {
    const std::size_t mode = i % 2;
    const double tau = interval(generator);
    const double before = e.dot(P[mode] * e);
    e = (exponential_of(tau * flows[mode]) * e).eval();
    time += tau;
    EXPECT_LE(e.dot(P[mode] * e), before * std::exp(-0.1 * tau) * (1.0 + 1e-9));
    e = (projectors[mode] * e).eval();
    EXPECT_LE(e.dot(P[1 - mode] * e), before * (1.0 + 1e-9));
  }
  EXPECT_LT(e.dot(P[0] * e), first * std::exp(-0.1 * time) * (1.0 + 1e-6));
}

TEST(ProjectionDesignTest, RefusesOutputsThatDifferAndModesThatJump) {
  CertificateSubject subject = projected();
  subject.plant.modes.back().C_c(0, 0) = 0.7;
  EXPECT_THROW(designed("bernard2022_section7_3_1", subject), DesignError);
  subject = projected();
  subject.plant.modes.back().A_d = Eigen::MatrixXd(2.0 * Eigen::MatrixXd::Identity(3, 3));
  EXPECT_THROW(designed("bernard2022_section7_3_1", subject), DesignError);
}

/// Gains and metrics of other modes do not prove it: each flow counts with its own.
TEST(ProjectionDesignTest, ExchangedGainsAreNotProved) {
  const Design design = designed("bernard2022_section7_3_1", projected());
  Certificate exchanged = design.certificate;
  std::swap(exchanged.values.at("L_c/1"), exchanged.values.at("L_c/2"));
  EXPECT_FALSE(all_hold(check(exchanged)));
}

}  // namespace
}  // namespace sampled_data_observers
