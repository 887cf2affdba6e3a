#include "design/explanation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "design/design_method.h"
#include "design/ferrante2019_examples.h"
#include "design/paper_plants.h"

namespace sampled_data_observers {
namespace {

/// Without any output.
CertificateSubject plant(const Eigen::MatrixXd& A) {
  return test::linear_subject(A, Eigen::MatrixXd(0, A.rows()), 0.0, 0.0);
}

/// bernard2022, example 5.5
CertificateSubject unobserved_impulsive() {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3, 3);
  A(0, 1) = 1.0;
  CertificateSubject subject = plant(A);
  Eigen::MatrixXd A_d = Eigen::MatrixXd::Zero(3, 3);
  A_d(0, 0) = A_d(1, 1) = A_d(2, 0) = 1.0;
  subject.plant.modes.front().A_d = A_d;
  subject.plant.modes.front().C_d = Eigen::RowVector3d(1, 0, 0);
  subject.T1 = 2.0;
  subject.T2 = 5.0;
  return subject;
}

/// With one space between words, whatever the lines.
std::string words(const std::string& text) {
  std::istringstream in(text);
  std::string all;
  for (std::string word; in >> word;) all += (all.empty() ? "" : " ") + word;
  return all;
}

bool says(const CertificateSubject& subject, const std::string& part) {
  return words(explain(subject)).find(part) != std::string::npos;
}

TEST(Explanation, FindsFlowAndJumpsDetectableTogetherOnly) {
  EXPECT_TRUE(says(unobserved_impulsive(),
                   "Jumps alone, (A_d, C_d): not observable. - unseen: the mode 1, "
                   "which moves x2; it does not shrink: by 1 at each jump"))
      << explain(unobserved_impulsive());
  EXPECT_TRUE(says(unobserved_impulsive(), "detectable at all 101 values of tau looked at"));
  EXPECT_TRUE(
      says(unobserved_impulsive(), "(26), which takes flow and jumps one by one, can't hold"));
  EXPECT_FALSE(says(unobserved_impulsive(), "NO OBSERVER"));
}

/// Position and velocity, each sampled at times of its own.
CertificateSubject two_sensors(const Eigen::MatrixXd& A, std::vector<SamplingTimes> times) {
  const Eigen::Index n = A.rows();
  CertificateSubject subject =
      test::linear_subject(A, Eigen::MatrixXd::Identity(n, n).topRows(2), 0.0, 0.0);
  subject.plant.sampled = {{"gps", 0, 0, 1}, {"wheel", 1, 1, 1}};
  if (!times.empty()) set_sensor_times(subject, std::move(times));
  return subject;
}

TEST(Explanation, SaysWhatEachSensorContributes) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3, 3);
  A(0, 1) = A(1, 2) = 1.0;
  const CertificateSubject subject = two_sensors(A, {{0.2, 1.0}, {0.05, 0.2}});
  for (const char* part :
       {"gps in [T1, T2] = [0.2, 1] s, wheel in [T1, T2] = [0.05, 0.2] s",
        "gps alone shows all states. Without it, the others leave unseen the mode 0, which moves "
        "x1.",
        "wheel alone shows x2, x3; it leaves unseen the mode 0, which moves x1. The others show as "
        "much without it.",
        "There are no pathological intervals: no two eigenvalues"}) {
    EXPECT_TRUE(says(subject, part)) << part << "\n" << explain(subject);
  }
  EXPECT_FALSE(says(subject, "NO OBSERVER"));
}

TEST(Explanation, TellsThatSensorsShowNothingAtTimesThatEachAllows) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2, 2);
  A(0, 1) = 1.0;
  A(1, 0) = -4.0;
  const CertificateSubject subject = two_sensors(A, {{0.5, 2.0}, {1.0, 3.5}});
  EXPECT_TRUE(says(subject,
                   "gps every 1.571 s and wheel every 1.571 s: nothing is seen of a "
                   "combination of all states, which does not decay"))
      << explain(subject);
  EXPECT_TRUE(says(subject, "NO OBSERVER CAN CONVERGE"));
  const CertificateSubject apart = two_sensors(A, {{0.5, 2.0}, {0.1, 1.5}});
  EXPECT_FALSE(says(apart, "NO OBSERVER"));
  EXPECT_TRUE(says(apart, "There are no pathological intervals inside of their times"));
  EXPECT_TRUE(says(two_sensors(A, {}), "Pathological intervals at all"));
}

TEST(Explanation, TellsThatNothingSeesAnUnstableModeAtJumps) {
  CertificateSubject subject = unobserved_impulsive();
  subject.plant.modes.front().C_d = Eigen::RowVector3d(0, 1, 0);  // the velocity only
  EXPECT_TRUE(says(subject, "NOT detectable at 101 of 101"));
  EXPECT_TRUE(says(subject, "NO OBSERVER CAN CONVERGE"));
}

TEST(Explanation, ComparesTheDecayInFlowWithTheGrowthAtJumps) {
  // dx/dt = (-0.1 x1, x2), jumps double x1, which y_c does not see.
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2, 2);
  A.diagonal() << -0.1, 1.0;
  CertificateSubject subject = plant(A);
  subject.plant.modes.front().C_c = Eigen::RowVector2d(0, 1);
  subject.plant.modes.front().A_d = 2.0 * Eigen::MatrixXd::Identity(2, 2);
  subject.T1 = 1.0;
  subject.T2 = 2.0;
  EXPECT_TRUE(says(subject, "that takes a rate of decay of more than 0.6931 1/s"))
      << explain(subject);
  EXPECT_TRUE(says(subject, "what y_c does not show decays at 0.1 1/s only"));
  subject.T1 = subject.T2 = 7.0;  // exp(-0.7) < 1 / 2
  EXPECT_FALSE(says(subject, "what y_c does not show decays"));
}

TEST(Explanation, SaysOfEveryMethodWhetherItApplies) {
  CertificateSubject subject = unobserved_impulsive();
  subject.plant.modes.front().C_d = Eigen::MatrixXd::Identity(3, 3);
  const std::string text = words(explain(subject));
  const std::size_t others = text.find("The others do not: ");
  ASSERT_NE(std::string::npos, others) << text;
  std::size_t applicable = 0;
  for (const DesignMethod* method : design_methods()) {
    const std::size_t applies = text.find(method->name() + " applies: ");
    if (applies == std::string::npos) {
      EXPECT_NE(std::string::npos, text.find(method->name(), others)) << method->name();
    } else {
      EXPECT_LT(applies, others) << method->name();
      ++applicable;
    }
  }
  EXPECT_LT(0u, applicable);
  EXPECT_TRUE(says(subject, "- it is about switched plants: plant/modes with two or more: "));
}

/// An oscillator of period pi, of which samples pi/2 apart show nothing; in [1, 4] that dip lies
/// between all equidistant times.
TEST(Explanation, TakesPathologicalTimesIntoTheLeastSingularValue) {
  Eigen::MatrixXd A(2, 2);
  A << -0.1, 2, -2, -0.1;
  const CertificateSubject subject = test::linear_subject(A, Eigen::RowVector2d(1, 0), 1.0, 4.0);
  const std::string text = words(explain(subject));
  const std::size_t at = text.find("over [T1, T2] = [1, 4] s: ");
  ASSERT_NE(at, std::string::npos) << text;
  EXPECT_LT(std::stod(text.substr(at + 26)), 1e-12) << text;
  EXPECT_NE(text.find("at tau = 1.571 s."), std::string::npos) << text;
  EXPECT_EQ(text.find("NO OBSERVER"), std::string::npos) << text;  // all decays
}

/// The aircraft: pathological at 8.541 s; designs for [4, 8] s exist.
TEST(Explanation, WarnsOfAPathologicalIntervalOnlyWhereT2IsClose) {
  EXPECT_TRUE(says(test::aircraft(4.0, 8.0), "T2 is close to the pathological interval 8.541 s"));
  EXPECT_FALSE(says(test::aircraft(1.0, 3.0), "T2 is close"));
}

TEST(Explanation, RecommendsOneMethod) {
  EXPECT_TRUE(says(unobserved_impulsive(), "or with --method bernard2022_equation36"));
  EXPECT_TRUE(says(test::aircraft(1.0, 3.0), "or with --method sferlazza2019_algorithm1"));
  EXPECT_TRUE(says(test::oscillator(0.2), "or with --method ferrante2019_alternating"));
}

/// x2' = -x2 + w, which y = x1 does not show at all, has the gain 1 from w to x2, for any observer.
TEST(Explanation, TellsTheGainThatNoT2CanDoWithout) {
  Eigen::MatrixXd A(2, 2);
  A << 0, 0, 0, -1;
  CertificateSubject subject = test::linear_subject(A, Eigen::RowVector2d(1, 0), 0.1, 0.2);
  subject.plant.N = Eigen::Vector2d(0, 1);
  subject.plant.C_p = Eigen::RowVector2d(0, 1);
  EXPECT_TRUE(says(subject, "less than about 1 by these methods")) << explain(subject);
  EXPECT_TRUE(says(subject, "(31) of ferrante2019 has a solution"));
  EXPECT_FALSE(says(test::aircraft(1.0, 3.0), "less than about"));
}

TEST(Explanation, SpeaksWithoutTimes) {
  CertificateSubject subject = unobserved_impulsive();
  subject.T1 = subject.T2 = 0.0;
  EXPECT_TRUE(says(subject, "times between events: not given"));
  EXPECT_FALSE(says(subject, "nan"));
}

TEST(ObservabilityCurves, ReachZeroAtPathologicalIntervals) {
  Eigen::MatrixXd A(2, 2);
  A << 0, 1, -4, 0;
  CertificateSubject subject = plant(A);
  subject.plant.modes.front().C = Eigen::RowVector2d(1, 0);
  subject.T1 = 0.2;
  subject.T2 = 0.4;
  const std::vector<double> times = pathological_times(subject);
  ASSERT_EQ(times.size(), 1u);
  EXPECT_NEAR(times[0], std::acos(-1.0) / 2.0, 1e-12);
  const std::vector<ObservabilityCurve> curves = observability_curves(subject);
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_LT(*std::min_element(curves[0].value.begin(), curves[0].value.end()), 1e-12);
  EXPECT_GT(curves[0].tau.back(), times[0]);
}

TEST(Explanation, ALongestTimeMayBeMissing) {
  CertificateSubject subject = unobserved_impulsive();
  subject.T2 = std::numeric_limits<double>::infinity();
  subject.plant.modes.front().C_c = Eigen::RowVector3d(1, 0, 0);
  EXPECT_TRUE(says(subject, "[T1, T2] = [2, inf] s (looked at up to 20 s)"));
  EXPECT_TRUE(says(subject, "bernard2022_equation22 applies"));
  EXPECT_FALSE(says(subject, "bernard2022_equation26 applies"));
  EXPECT_EQ(std::string::npos, explain(subject).find("nan"));
  const std::vector<ObservabilityCurve> curves = observability_curves(subject);
  ASSERT_FALSE(curves.empty());
  EXPECT_NEAR(30.0, curves.front().tau.back(), 1e-9);
  // Nor a shortest one.
  subject.T1 = 0.0;
  subject.dwell_time = DwellTime{DwellTime::Kind::kAverage, 0.5, 2.0};
  *subject.plant.modes.front().A_d *= 2.0;
  EXPECT_TRUE(says(subject, "there must be a shortest time T1, or an average dwell time"));
  EXPECT_TRUE(says(subject, "bernard2022_equation22_average_dwell_time applies"));
}

}  // namespace
}  // namespace sampled_data_observers
