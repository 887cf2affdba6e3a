// Designs for any number of sensors, by Lyapunov functions that are sums of functions of one timer.
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "certificate/certificate.h"
#include "certificate/timer_grid.h"
#include "design/certificate_proof.h"
#include "design/design_method.h"
#include "design/rigorous_check.h"
#include "paper_plants.h"

namespace sampled_data_observers::test {
namespace {

/// States that grow, each with a sensor of its own, and coupled to its neighbours.
CertificateSubject chain(Eigen::Index n) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  A.diagonal().setConstant(0.1);
  A.diagonal(1).setConstant(0.2);
  A.diagonal(-1).setConstant(0.2);
  CertificateSubject subject = linear_subject(A, Eigen::MatrixXd::Identity(n, n), 0.0, 0.0);
  subject.plant.sampled.clear();
  std::vector<SamplingTimes> times;
  for (Eigen::Index i = 0; i < n; ++i) {
    subject.plant.sampled.push_back({"s" + std::to_string(i), static_cast<std::size_t>(i), i, 1});
    times.push_back({0.05, 0.3 + 0.05 * static_cast<double>(i)});
  }
  subject.plant.N = Eigen::MatrixXd::Ones(n, 1);
  subject.plant.C_p = Eigen::MatrixXd::Identity(n, n);
  set_sensor_times(subject, times);
  return with_cells(subject, 2);
}

DesignCandidate designed_for_gamma(const std::string& method, const CertificateSubject& subject) {
  return find_design_method(method)->attempt(subject, {{"lambda_t", 0.05}}, Objective::kMinGamma);
}

TEST(TimerDependentSum, DesignsNearlyWhatAGridDoes) {
  const CertificateSubject subject = chain(2);
  const DesignCandidate sum = designed_for_gamma("timer_dependent_sum_gain", subject);
  const DesignCandidate grid = designed_for_gamma("timer_dependent_alternating_gain", subject);
  ASSERT_TRUE(sum.is_verified()) << sum.message;
  ASSERT_TRUE(grid.is_verified()) << grid.message;
  EXPECT_LE(sum.cost, 0.9);
  EXPECT_LE(sum.cost, 1.5 * grid.cost);
  const Theorem& theorem = *find_theorem("timer_dependent_sum_constant_gain");
  const std::vector<Condition> conditions = theorem.conditions(subject);
  EXPECT_EQ(first_unproved(prove(conditions, sum.values)), "");
  // Each part counts.
  for (const std::string& name : std::vector<std::string>{
           "flow_part/s0", "jump_part/s1/s0", "P_most/s0", "P_after/s1", "jump_parts/s0"}) {
    for (const double sign : {1.0, -1.0}) {
      NamedMatrices broken = sum.values;
      Eigen::MatrixXd& value = broken.at(name);
      value.diagonal().array() += sign * 2.0 * value.norm();
      if (name[0] == 'P' && sign > 0.0) continue;  // that may do
      EXPECT_NE(first_unproved(prove(conditions, broken)), "") << name << sign;
    }
  }
}

TEST(TimerDependentSum, IsAboutMoreSensorsThanAGrid) {
  CertificateSubject subject = chain(6);
  const Theorem& sum = *find_theorem("timer_dependent_sum_constant_gain");
  EXPECT_NO_THROW(require_subject(sum, subject));
  try {
    require_subject(*find_theorem("timer_dependent_constant_gain"), subject);
    FAIL();
  } catch (const std::invalid_argument& fault) {
    EXPECT_NE(std::string(fault.what()).find("timer_dependent_sum_"), std::string::npos);
  }
  subject.sensor_times.front().T1 = 0.0;
  EXPECT_THROW(require_subject(sum, subject), std::invalid_argument);
  EXPECT_THROW(require_subject(sum, chain(1)), std::invalid_argument);
}

}  // namespace
}  // namespace sampled_data_observers::test
