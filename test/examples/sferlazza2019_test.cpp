// The aircraft of sferlazza2019, (66), as shipped, with samples every 1 to 3 s and every 4 to 8 s.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "linear_algebra/matrix_functions.h"
#include "sampled_data_observers/config/config_section.h"
#include "support/example_run.h"
#include "support/matrix_functions.h"

namespace sampled_data_observers::test {
namespace {

struct Aircraft {
  std::string name;
  const char* gains;
  double largest_ratio;   ///< of V at a sample, for lambda = 0
  double smallest_ratio;  ///< over the time between samples, for the worst error
  double peak;            ///< of the error
  double small;           ///< time from which it is below 0.01
  double tiny;            ///< time from which it is below 1e-5
};

const Aircraft kFast = {"sferlazza2019_aircraft_1_3", kPrinted, 0.4430, 0.132, 80.0, 35.0, 60.0};
const Aircraft kSlow = {
    "sferlazza2019_aircraft_4_8", "gains.yaml", 0.5464, 0.0076, 150.0, 65.0, 110.0};

Eigen::MatrixXd flow_matrix(const Scenario& scenario) {
  return scenario.plant->modes().front().flow->affine()->M();
}

Eigen::MatrixXd certificate(const Example& example) {
  const ConfigNode tree = example.observer_tree("scenario.yaml", "observer.yaml");
  return ConfigSection(tree, "").section("gains").matrix("P", 3, 3);
}

/// V(e, τ) of (9), at the times of the truth between two samples.
struct Flow {
  std::vector<double> values;
  /// What rounding may do to each: x reaches 6000, which leaves about 1e-11 in e, and e^{-Aτ} makes
  /// that larger.
  std::vector<double> rounding;
};

/// The flows after the first sample, with which τ begins, while |e| >= 1e-5.
std::vector<Flow> lyapunov_function(const Example& example, const ExampleRun& run) {
  const Eigen::MatrixXd A = flow_matrix(example.scenario("scenario.yaml"));
  const Eigen::MatrixXd P = certificate(example);
  std::vector<Flow> flows;
  for (std::size_t j = 0; j + 1 < run.sample_times.size(); ++j) {
    const double sample = run.sample_times[j];
    // (A stamp on the grid of the truth counts as after the sample, as it does for the observer.)
    const Trajectory errors =
        run.error.where([&](double t) { return sample <= t && t < run.sample_times[j + 1]; });
    if (errors.size() == 0 || errors.value(0).norm() < 1e-5) break;
    Flow flow;
    for (std::size_t k = 0; k < errors.size() && errors.value(k).norm() >= 1e-5; ++k) {
      const Eigen::MatrixXd back = exponential(-A * (errors.time(k) - sample));
      const Eigen::VectorXd e = back * errors.value(k);
      flow.values.push_back(e.dot(P * e));
      flow.rounding.push_back(2.0 * (P * e).norm() * back.norm() * 1e-11);
    }
    flows.push_back(flow);
  }
  return flows;
}

class Sferlazza2019 : public ::testing::TestWithParam<Aircraft> {};

// Figures 1 and 2 show such runs.
TEST_P(Sferlazza2019, TheErrorVanishes) {
  const Aircraft& aircraft = GetParam();
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const ExampleRun run = Example(aircraft.name, aircraft.gains).seed(seed).run();
    EXPECT_EQ(0u, run.refused);
    EXPECT_NEAR(std::sqrt(3.0), run.error.at(0.0), 1e-12);
    EXPECT_LT(run.error.max(), aircraft.peak) << seed;
    EXPECT_LT(run.error.from(aircraft.small).max(), 0.01) << seed;
    EXPECT_LT(run.error.from(aircraft.tiny).max(), 1e-5) << seed;
  }
}

TEST_P(Sferlazza2019, TheLyapunovFunctionIsConstantInFlowAndFallsAtSamples) {
  const Aircraft& aircraft = GetParam();
  for (const double lambda : {0.0, 0.3, 0.7, 0.95}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      Example example(aircraft.name, aircraft.gains);
      example.seed(seed).override_observer("gains: {lambda: " + std::to_string(lambda) + "}");
      const ExampleRun run = example.run();
      EXPECT_LT(run.error.from(aircraft.tiny).max(), 1e-5) << lambda;
      const std::vector<Flow> flows = lyapunov_function(example, run);
      ASSERT_GE(flows.size(), 5u);
      for (std::size_t j = 0; j < flows.size(); ++j) {
        const double V = flows[j].values.front();
        for (std::size_t k = 0; k < flows[j].values.size(); ++k) {
          ASSERT_NEAR(V, flows[j].values[k], 1e-6 * V + flows[j].rounding[k]) << lambda << " " << j;
        }
        ASSERT_LT(flows[j].rounding.back(), 0.01 * V);
        if (j == 0) continue;
        const double before = flows[j - 1].values.front();
        EXPECT_LT(V, (lambda == 0.0 ? aircraft.largest_ratio + 6e-4 : 1.0) * before)
            << lambda << " " << j;
      }
    }
  }
}

// For lambda = 0 a sample projects e onto the kernel of C, orthogonally in the metric of V, so that
// V is multiplied by at most the largest eigenvalue of Ψ(τ)⁻¹ P there.
TEST_P(Sferlazza2019, TheCertificateGivesTheRatio) {
  const Aircraft& aircraft = GetParam();
  const Example example(aircraft.name, aircraft.gains);
  const Scenario scenario = example.scenario("scenario.yaml");
  const Eigen::MatrixXd A = flow_matrix(scenario);
  const Eigen::MatrixXd P = certificate(example);
  const Eigen::MatrixXd C = scenario.plant->modes().front().outputs.front()->affine()->M();
  const Eigen::MatrixXd kernel = test::kernel(C);
  ASSERT_EQ(2, kernel.cols());
  const SamplingBounds bounds =
      example.observer("scenario.yaml", "observer.yaml").options.sampling.of_sensor(0);
  double largest = 0.0;
  double smallest = 1.0;
  for (int i = 0; i <= 1000; ++i) {
    const double tau = to_seconds(bounds.T1) + 1e-3 * i * to_seconds(bounds.T2 - bounds.T1);
    const Eigen::MatrixXd back = exponential(-A * tau) * kernel;
    const Eigen::MatrixXd before = back.transpose() * P * back;
    const Eigen::MatrixXd after = kernel.transpose() * P * kernel;
    const double ratio = largest_generalized_eigenvalue(after, before);
    largest = std::max(largest, ratio);
    smallest = std::min(smallest, ratio);
  }
  EXPECT_NEAR(aircraft.largest_ratio, largest, 5e-4);
  EXPECT_NEAR(aircraft.smallest_ratio, smallest, 5e-4);
}

TEST_P(Sferlazza2019, TheInputPlacesThePapersEigenvalues) {
  const Scenario scenario = Example(GetParam().name).scenario("scenario.yaml");
  const VectorMap& input = *scenario.input->formulas;
  Eigen::RowVectorXd K(3);
  for (int i = 0; i < 3; ++i) {
    Eigen::VectorXd arguments = Eigen::VectorXd::Zero(4);  // t, x
    arguments(1 + i) = 1.0;
    input.evaluate(arguments.data(), nullptr, &K(i));
  }
  const Eigen::MatrixXd B = scenario.plant->modes().front().flow->affine()->N();
  const Eigen::VectorXcd eigenvalues = eigenvalues_of(flow_matrix(scenario) + B * K);
  std::vector<double> real;
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(0.0, eigenvalues(i).imag(), 1e-6);
    real.push_back(eigenvalues(i).real());
  }
  std::sort(real.begin(), real.end());
  EXPECT_NEAR(-0.03, real[0], 1e-6);
  EXPECT_NEAR(-0.02, real[1], 1e-6);
  EXPECT_NEAR(-0.01, real[2], 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Aircraft, Sferlazza2019, ::testing::Values(kFast, kSlow),
                         [](const auto& info) { return info.param.name.substr(23); });

}  // namespace
}  // namespace sampled_data_observers::test
