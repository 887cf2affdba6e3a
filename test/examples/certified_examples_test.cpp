// Guaranteed bounds in the simulated examples: the error never exceeds them, and none is lost.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/example_run.h"

namespace sampled_data_observers::test {
namespace {

/// An example, its scenario, settings and gains, what is assumed where the estimate begins (at the
/// first sample), and the largest bound at the end.
struct CertifiedExample {
  const char* name;
  const char* scenario;
  const char* observer;
  const char* gains;
  const char* assumptions;
  double final_bound;
};

/// Of the estimate, whose states grow to 1e4 in some examples.
constexpr double kRounding = 1e-9;

const CertifiedExample kExamples[] = {
    {"ferrante2019_oscillator", "scenario.yaml", "observer.yaml", "gains.yaml",
     "{initial_error: 0.6, noise: 0, disturbance: 1}", 150.0},
    {"ferrante2019_oscillator", "scenario_undisturbed.yaml", "observer_undisturbed.yaml",
     "gains.yaml", "{initial_error: 4.2427, noise: 0, disturbance: 0}", 5.0},
    {"ferrante2019_unicycle", "scenario.yaml", "observer.yaml", "gains.yaml",
     "{initial_error: 1, noise: 0, disturbance: 1}", 1e3},
    {"ferrante2019_flexible_link", "scenario.yaml", "observer.yaml", "gains.yaml",
     "{initial_error: 1, noise: 0, disturbance: 1}", 1e3},
    {"ferrante2016_scalar", "scenario.yaml", "observer.yaml", "gains.yaml",
     "{initial_error: 3, noise: 0.1, disturbance: 0}", 1e3},
    {"ferrante2016_mass_spring", "scenario.yaml", "observer.yaml", "gains.yaml",
     "{initial_error: 3, noise: 0, disturbance: 0}", 1e3},
    {"sferlazza2019_aircraft_1_3", "scenario.yaml", "observer.yaml", "gains.yaml",
     "{initial_error: 2, noise: 0, disturbance: 0}", 1e3},
    {"sferlazza2019_aircraft_4_8", "scenario.yaml", "observer.yaml", "gains.yaml",
     "{initial_error: 2, noise: 0, disturbance: 0}", 1e3},
    {"etienne2019_dc_drive", "scenario.yaml", "observer.yaml", "gains.yaml",
     "{initial_error: 2, noise: 0.2, disturbance: 0}", 1e3},
    {"bernard2022_impulsive", "scenario.yaml", "observer.yaml", "gains.yaml",
     "{initial_error: 10, noise: 0, disturbance: 0}", 1e3},
    {"bernard2022_bouncing_ball", "scenario.yaml", "observer.yaml", "gains.yaml",
     "{initial_error: 20, noise: 0, disturbance: 0}", 1e3},
};

class CertifiedExampleTest : public ::testing::TestWithParam<CertifiedExample> {};

TEST_P(CertifiedExampleTest, NeverExceedsItsBound) {
  const CertifiedExample& example = GetParam();
  const ExampleRun run =
      Example(example.name, example.gains)
          .override_observer("error_assumptions: " + std::string(example.assumptions))
          .run(example.scenario, example.observer);
  ASSERT_GT(run.error.size(), 500u);
  for (std::size_t k = 0; k < run.error.size(); ++k) {
    const double bound = run.error_bound.value(k)(0);
    ASSERT_TRUE(std::isfinite(bound)) << run.error.time(k);
    ASSERT_LE(run.error.value(k).norm(), bound + kRounding) << run.error.time(k);
    const Eigen::VectorXd& bounds = run.state_bounds.value(k);
    ASSERT_TRUE((run.error.value(k).cwiseAbs().array() <= bounds.array() + kRounding).all())
        << run.error.time(k);
    ASSERT_LE(bounds.maxCoeff(), bound * (1.0 + 1e-9) + kRounding);
  }
  EXPECT_LT(run.error_bound.value(run.error_bound.size() - 1)(0), example.final_bound);
}

INSTANTIATE_TEST_SUITE_P(EveryExample, CertifiedExampleTest, ::testing::ValuesIn(kExamples));

}  // namespace
}  // namespace sampled_data_observers::test
