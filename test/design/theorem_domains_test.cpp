// The domain of every number that a theorem speaks of is one of its conditions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "design/rigorous_check.h"
#include "paper_plants.h"

namespace sampled_data_observers::test {
namespace {

Eigen::MatrixXd two_by_two(double a, double b, double c, double d) {
  Eigen::MatrixXd result(2, 2);
  result << a, b, c, d;
  return result;
}

/// The same with other times, of each sensor where there are several.
CertificateSubject with_times(CertificateSubject subject, double T1, double T2) {
  subject.T1 = T1;
  subject.T2 = T2;
  for (SamplingTimes& times : subject.sensor_times) times = {T1, T2};
  return subject;
}

/// A plant with outputs of all timings, jumps, modes, a disturbance and a Lipschitz flow, so far as
/// the theorem allows.
CertificateSubject subject_of(const Theorem& theorem) {
  const Eigen::MatrixXd row = Eigen::MatrixXd::Identity(1, 2);
  CertificateSubject subject = linear_subject(two_by_two(0, 1, -4, 0), row, 0.2, 0.4);
  const auto is_of = [&](const char* name) { return theorem.name().rfind(name, 0) == 0; };
  PlantMatrices& plant = subject.plant;
  if (is_of("ferrante2019") || is_of("etienne2019") || is_of("timer_dependent")) {
    plant.G = Eigen::MatrixXd::Identity(2, 1);
    plant.S = row;
    plant.lipschitz_constant = 0.1;
    if (is_of("timer_dependent_switched")) {
      plant.G.resize(2, 0);
      plant.S.resize(0, 2);
    }
    if (is_of("etienne2019")) plant.vertices.emplace_back(Eigen::MatrixXd::Zero(2, 2));
    plant.N = Eigen::MatrixXd::Identity(2, 1);
    plant.C_p = row;
  }
  if (is_of("sferlazza2019_equation17")) plant.modes.front().C = Eigen::MatrixXd::Identity(2, 2);
  if (is_of("bernard2022") || is_of("timer_dependent_synchronized") ||
      is_of("timer_dependent_switched")) {
    ModeMatrices& mode = plant.modes.front();
    mode.label = 1;
    mode.C.resize(0, 2);
    plant.sampled.clear();
    mode.C_c = row;
    mode.C_d = row;
    mode.A_d = Eigen::MatrixXd::Identity(2, 2);
    plant.lipschitz_jump = LipschitzJump{1.0, Eigen::MatrixXd::Identity(2, 2)};
    if (is_of("bernard2022_example7_1") || is_of("bernard2022_equation49") ||
        is_of("bernard2022_section7_3") || is_of("timer_dependent_switched")) {
      plant.modes.push_back(mode);
      plant.modes.back().label = 2;
    }
  }
  const bool is_average = theorem.times() == TheoremTimes::kAverageDwellTime;
  if (is_average || theorem.times() == TheoremTimes::kReverseAverageDwellTime) {
    const auto kind = is_average ? DwellTime::Kind::kAverage : DwellTime::Kind::kReverseAverage;
    subject.dwell_time = DwellTime{kind, 0.3, 2.0};
  }
  if (theorem.sums_over_timers()) {
    plant.modes.front().C = Eigen::MatrixXd::Identity(2, 2);
    plant.sampled = {{"first", 0, 0, 1}, {"second", 1, 1, 1}};
    set_sensor_times(subject, {{0.2, 0.4}, {0.2, 0.4}});
  }
  subject.falls_at_events = theorem.takes_fall_at_events();
  require_subject(theorem, subject);
  return subject;
}

std::vector<Condition> domains(const Theorem& theorem, const CertificateSubject& subject) {
  std::vector<Condition> all = theorem.conditions(subject);
  all.erase(std::remove_if(all.begin(), all.end(),
                           [](const Condition& condition) { return !condition.is_domain(); }),
            all.end());
  return all;
}

bool has(const std::vector<ConditionProof>& proofs, ProofStatus status) {
  return std::any_of(proofs.begin(), proofs.end(),
                     [status](const ConditionProof& proof) { return proof.status == status; });
}

class TheoremDomainsTest : public ::testing::TestWithParam<const Theorem*> {
 protected:
  const Theorem& theorem_ = *GetParam();
  const CertificateSubject subject_ = subject_of(theorem_);

  std::vector<std::string> scalars() const {
    std::vector<std::string> names;
    for (const auto& shapes : {theorem_.gains(subject_), theorem_.multipliers(subject_),
                               theorem_.parameters(subject_)}) {
      for (const NamedShape& shape : shapes) {
        if (shape.form == NamedShape::Form::kScalar) names.push_back(shape.name);
      }
    }
    return names;
  }

  /// A value for each of them with which all is in its domain.
  NamedMatrices inside() const {
    NamedMatrices values;
    for (const std::string& name : scalars()) values[name] = scalar_matrix(0.5);
    if (subject_.dwell_time) values["decay"] = scalar_matrix(0.1);
    return values;
  }
};

class DwellTimeDomainsTest : public TheoremDomainsTest {};

TEST_P(DwellTimeDomainsTest, AreConditionsForTheDwellTime) {
  const NamedMatrices values = inside();
  for (const auto& [tau, N0] : {std::pair(0.0, 2.0), std::pair(-0.3, 2.0), std::pair(0.3, 0.0)}) {
    CertificateSubject broken = subject_;
    broken.dwell_time->tau = tau;
    broken.dwell_time->N0 = N0;
    const std::vector<Condition> conditions = domains(theorem_, broken);
    EXPECT_FALSE(all_hold(check(conditions, values)));
    EXPECT_TRUE(has(prove(conditions, values), ProofStatus::kDisproved));
  }
}

std::vector<const Theorem*> dwell_time_theorems() {
  std::vector<const Theorem*> all;
  for (const Theorem* theorem : theorems()) {
    if (theorem->times() == TheoremTimes::kAverageDwellTime ||
        theorem->times() == TheoremTimes::kReverseAverageDwellTime) {
      all.push_back(theorem);
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(All, DwellTimeDomainsTest, ::testing::ValuesIn(dwell_time_theorems()),
                         [](const auto& info) { return info.param->name(); });

TEST(TheoremTimes, EachTheoremRefusesTimesThatItDoesNotSpeakOf) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Theorem* theorem : theorems()) {
    SCOPED_TRACE(theorem->name());
    CertificateSubject other = subject_of(*theorem);
    if (other.dwell_time) {
      other.dwell_time.reset();
    } else {
      other.dwell_time = DwellTime{DwellTime::Kind::kAverage, 0.3, 2.0};
    }
    EXPECT_THROW(require_subject(*theorem, other), std::invalid_argument);
    if (theorem->times() == TheoremTimes::kUpToT2) {
      EXPECT_THROW(require_subject(*theorem, with_times(subject_of(*theorem), 0.2, infinity)),
                   std::invalid_argument);
    }
  }
}

/// With fewer jumps than an average dwell time allows, V falls by flow_decay alone.
TEST(TheoremTimes, NoAverageDwellTimeProvesARateThatFlowDoesNotHave) {
  const Theorem& theorem = *find_theorem("bernard2022_equation22_average_dwell_time");
  const NamedMatrices values = {{"flow_decay", scalar_matrix(0.5)}, {"decay", scalar_matrix(0.3)}};
  const std::vector<Condition> conditions = domains(theorem, subject_of(theorem));
  EXPECT_FALSE(all_hold(check(conditions, values)));
  EXPECT_TRUE(has(prove(conditions, values), ProofStatus::kDisproved));
}

TEST_P(TheoremDomainsTest, AreConditionsForEachNumber) {
  const std::vector<Condition> conditions = domains(theorem_, subject_);
  const NamedMatrices values = inside();
  EXPECT_TRUE(all_hold(check(conditions, values)))
      << describe_violations(check(conditions, values));
  EXPECT_EQ(first_unproved(prove(conditions, values)), "");
  for (const std::string& name : scalars()) {
    SCOPED_TRACE(name);
    NamedMatrices negative = values;
    negative[name] = scalar_matrix(-0.5);
    EXPECT_FALSE(all_hold(check(conditions, negative)));
    EXPECT_TRUE(has(prove(conditions, negative), ProofStatus::kDisproved));
    negative[name] = scalar_matrix(std::nan(""));
    EXPECT_FALSE(all_hold(check(conditions, negative)));
    EXPECT_NE(first_unproved(prove(conditions, negative)), "");
  }
}

TEST_P(TheoremDomainsTest, AreConditionsForTheTimes) {
  const NamedMatrices values = inside();
  for (const auto& [T1, T2] : {std::pair(-0.1, 0.4), std::pair(0.4, 0.2), std::pair(-0.4, -0.2)}) {
    const std::vector<Condition> conditions = domains(theorem_, with_times(subject_, T1, T2));
    EXPECT_FALSE(all_hold(check(conditions, values)));
    EXPECT_TRUE(has(prove(conditions, values), ProofStatus::kDisproved));
  }
}

INSTANTIATE_TEST_SUITE_P(All, TheoremDomainsTest, ::testing::ValuesIn(theorems()),
                         [](const auto& info) { return info.param->name(); });

TEST(TheoremDomains, LetNoFunctionFallAtEventsThatMayCoincide) {
  const Theorem& theorem = *find_theorem("timer_dependent_constant_gain");
  CertificateSubject subject = subject_of(theorem);
  subject.T1 = 0.0;
  EXPECT_THROW(require_subject(theorem, subject), std::invalid_argument);
  subject.falls_at_events = false;
  EXPECT_NO_THROW(require_subject(theorem, subject));
}

TEST(TheoremDomains, LetNoFunctionThatGrowsAtEventsPassForOneThatFalls) {
  const Theorem& theorem = *find_theorem("timer_dependent_constant_gain");
  const CertificateSubject subject = subject_of(theorem);
  NamedMatrices values;
  for (const auto& shapes : {theorem.parameters(subject), theorem.multipliers(subject)}) {
    for (const NamedShape& shape : shapes) {
      if (shape.form == NamedShape::Form::kScalar) values[shape.name] = scalar_matrix(0.5);
    }
  }
  values["mu"] = scalar_matrix(1.0);
  EXPECT_FALSE(all_hold(check(domains(theorem, subject), values)));
  EXPECT_NE(first_unproved(prove(domains(theorem, subject), values)), "");
}

/// With a rate of −2 the conditions are about an error that is let grow by e^{2 t}, and hold
/// without any correction.
TEST(TheoremDomains, LetNoNegativeRateProveAnUnstableObserver) {
  const Eigen::MatrixXd A = two_by_two(1, 0, 0, -1);
  const CertificateSubject subject = linear_subject(A, Eigen::MatrixXd::Identity(1, 2), 0.1, 0.5);
  const NamedMatrices values = {{"L", Eigen::MatrixXd::Zero(2, 1)},
                                {"P", Eigen::MatrixXd::Identity(2, 2)},
                                {"decay", scalar_matrix(-2.0)}};
  const std::vector<Condition> conditions =
      find_theorem("ferrante2016_theorem1")->conditions(subject);
  EXPECT_EQ(describe_violations(check(conditions, values)), "decay >= 0 is violated by 2");
  const std::vector<ConditionProof> proofs = prove(conditions, values);
  EXPECT_TRUE(has(proofs, ProofStatus::kDisproved));
  EXPECT_EQ(first_unproved(proofs), "decay >= 0: disproved, -2");
}

}  // namespace
}  // namespace sampled_data_observers::test
