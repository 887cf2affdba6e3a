// min-T1 against closed forms, and weights of the final error.
#include <gtest/gtest.h>

#include <cmath>

#include "certificate/timer_grid.h"
#include "design/analysis.h"
#include "design/plant_scaling.h"
#include "design/run_time_figures.h"
#include "paper_plants.h"

namespace sampled_data_observers::test {
namespace {

/// x1' = -x1, x1+ = 2 x1, which nothing shows, and x2' = 0, x2+ = x2, which jumps show: the error
/// of x1 falls where jumps are more than ln 2 apart, whatever the gain.
CertificateSubject doubled_at_jumps() {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2, 2);
  A(0, 0) = -1.0;
  CertificateSubject subject = linear_subject(A, Eigen::MatrixXd(0, 2), 1.0, 2.0);
  ModeMatrices& mode = subject.plant.modes.front();
  mode.C_d = Eigen::MatrixXd::Identity(2, 2).bottomRows(1);
  Eigen::MatrixXd A_d = Eigen::MatrixXd::Identity(2, 2);
  A_d(0, 0) = 2.0;
  mode.A_d = A_d;
  return subject;
}

/// With eight cells in [0, T1] a function of x1 that is affine in each and rises by 2 V at most
/// rises by (1 + T1/4)^8, and by more than 4 it must.
TEST(ShortestT1, IsThatOfAPlantWhoseErrorDoublesAtJumps) {
  const Design design = design_by("timer_dependent_jump_gain", with_cells(doubled_at_jumps(), 16),
                                  {}, Objective::kMinT1);
  const double expected = 4.0 * (std::pow(4.0, 1.0 / 8.0) - 1.0);
  EXPECT_NEAR(expected, design.certificate.subject.T1, 0.002);
  EXPECT_GT(design.certificate.subject.T1, expected);
  EXPECT_FALSE(design.search_ended);
}

TEST(ShortestT1, IsZeroWhereSamplesMayComeAtAnyTime) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2, 2);
  A(0, 1) = 1.0;
  const CertificateSubject subject = linear_subject(A, Eigen::MatrixXd::Identity(1, 2), 0.1, 0.4);
  const Design design = design_by("timer_dependent_constant_gain", subject, {}, Objective::kMinT1);
  EXPECT_EQ(0.0, design.certificate.subject.T1);

  AnalysisProblem problem;
  problem.theorem = design.certificate.theorem;
  problem.subject = subject;
  problem.gains = {{"L", design.certificate.values.at("L")}};
  problem.objective = Objective::kMinT1;
  EXPECT_EQ(0.0, analyze(problem, {}).certificate.subject.T1);
}

class WeightedDesignTest : public testing::Test {
 protected:
  WeightedDesignTest() {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2, 2);
    A(0, 1) = 1.0;
    subject_ = linear_subject(A, Eigen::MatrixXd::Identity(1, 2), 0.05, 0.4);
    subject_.plant.N = Eigen::MatrixXd::Identity(2, 2).rightCols(1);
  }

  Design designed(const Eigen::Vector2d& weights) const {
    DesignProblem problem;
    problem.subject = with_cells(subject_, 4);
    problem.given = {{"lambda_t", 1.0}};
    problem.subject.error_weights = weights;
    problem.objective = Objective::kMinFinalError;
    problem.assumptions.noise = 0.1;
    problem.assumptions.disturbance = 0.5;
    return synthesize(*find_design_method("timer_dependent_constant_gain"), problem, {});
  }

  static double bound(const Design& design, const Eigen::VectorXd& weights) {
    ErrorAssumptions assumptions;
    assumptions.noise = 0.1;
    assumptions.disturbance = 0.5;
    CertificateSubject subject = design.certificate.subject;
    subject.error_weights = weights;
    return final_error(*design.certificate.theorem, subject, design.certificate.values,
                       assumptions);
  }

  CertificateSubject subject_;
};

TEST_F(WeightedDesignTest, TheBoundOfAStateThatCountsIsTheLesserOne) {
  const Eigen::Vector2d position(1.0, 0.0);
  const Eigen::Vector2d speed(0.0, 1.0);
  EXPECT_LT(bound(designed(position), position), bound(designed(speed), position));
}

TEST_F(WeightedDesignTest, TheBoundIsThatOfTheNormForWeightsOfOne) {
  const Design design = designed(Eigen::Vector2d(1.0, 0.1));
  EXPECT_NEAR(bound(design, Eigen::VectorXd()), bound(design, Eigen::Vector2d(1.0, 1.0)), 1e-6);
}

TEST_F(WeightedDesignTest, WeightsAreOverTheUnitsOfStates) {
  PlantScaling scaling = units_of_file(subject_);
  scaling.state = Eigen::Vector2d(0.25, 4.0);
  subject_.error_weights = Eigen::Vector2d(2.0, 3.0);
  EXPECT_EQ(Eigen::VectorXd(Eigen::Vector2d(0.5, 12.0)), scaled(subject_, scaling).error_weights);
}

}  // namespace
}  // namespace sampled_data_observers::test
