// ferrante2019: designs against the numbers computed independently for its examples.
#include <gtest/gtest.h>

#include "sampled_data_observers/certificate/matrix_functions.h"
#include "sampled_data_observers/design/synthesis.h"

namespace sampled_data_observers {
namespace {

CertificateSubject oscillator(double T2) {
  CertificateSubject subject;
  ModeMatrices mode;
  mode.A.resize(2, 2);
  mode.A << 0, 1, -4, 0;
  mode.C.resize(1, 2);
  mode.C << 1, 0;
  subject.plant.modes = {mode};
  subject.plant.state_names = {"z1", "z2"};
  subject.plant.G.resize(2, 0);
  subject.plant.S.resize(0, 2);
  subject.plant.N.resize(2, 1);
  subject.plant.N << 1, 0;
  subject.plant.C_p = Eigen::MatrixXd::Identity(2, 2);
  subject.T1 = T2 / 2.0;
  subject.T2 = T2;
  return subject;
}

double best_gamma(const std::string& method, double T2, double gain_bound) {
  DesignProblem problem;
  problem.subject = oscillator(T2);
  problem.given = {{"lambda_t", 0.05}, {"gain_bound", gain_bound}};
  problem.objective = Objective::kMinGamma;
  SynthesisOptions options;
  options.jobs = 2;
  const Design design = synthesize(*find_design_method(method), problem, options);
  EXPECT_TRUE(all_hold(check(design.certificate)));
  EXPECT_LE(norm2(design.certificate.values.at("L")), gain_bound * 1.000001);
  return scalar_value(design.certificate.values, "gamma");
}

TEST(Ferrante2019Example1, Proposition2ReachesTheGammaOfTheErrata) {
  const char* method = "ferrante2019_proposition2";
  EXPECT_NEAR(best_gamma(method, 0.41, 1000), 32.22, 0.01 * 32.22);
  EXPECT_NEAR(best_gamma(method, 0.41, 10), 37.0, 0.01 * 37.0);
  EXPECT_NEAR(best_gamma(method, 0.3, 1000), 3.85, 0.01 * 3.85);
}

TEST(Ferrante2019Example1, TellsThatAGainOfNorm2IsTooSmall) {
  EXPECT_THROW(best_gamma("ferrante2019_proposition2", 0.41, 2), DesignError);
}

}  // namespace
}  // namespace sampled_data_observers
