// The numerical example of etienne2019, section 6, as shipped: a link on a DC motor.
#include <gtest/gtest.h>

#include <cmath>

#include "support/example_run.h"

namespace sampled_data_observers::test {
namespace {

/// Without the noise of the measurements.
Example& without_noise(Example& example) {
  return example.change_scenario(
      [](Scenario& scenario) { scenario.sensors.front().noise = Noise(); });
}

TEST(Etienne2019DcDrive, TheErrorStaysSmallUnderNoise) {
  const ExampleRun run = Example("etienne2019_dc_drive", kPrinted).run();
  EXPECT_NEAR(std::sqrt(3.0), run.error.at(0.0), 1e-12);
  EXPECT_LT(run.error.from(3.0).max(), 0.3);
  EXPECT_LT(run.error.from(10.0).rms(), 0.15);
  EXPECT_GT(run.error.from(10.0).rms(), 0.03);  // the noise is there
}

// Proposition 2 with alpha = 1 1/s, c1 = 1 and gamma = 2.7: in the end |e| <= gamma |L| 0.2. (The
// bound's part that decays needs the matrix P, which is not printed.)
TEST(Etienne2019DcDrive, TheErrorObeysThePapersBound) {
  const double asymptotic = 2.7 * std::sqrt(2.2 * 2.2 + 0.16 * 0.16 + 0.45 * 0.45) * 0.2;
  EXPECT_NEAR(1.216, asymptotic, 1e-3);
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const ExampleRun run = Example("etienne2019_dc_drive", kPrinted).seed(seed).run();
    EXPECT_LT(run.error.from(10.0).max(), asymptotic) << seed;
    EXPECT_LT(run.error.from(3.0).max(), 0.3) << seed;
    EXPECT_LT(run.error.from(10.0).rms(), 0.15) << seed;
  }
}

TEST(Etienne2019DcDrive, TheErrorVanishesWithoutNoise) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Example example("etienne2019_dc_drive", kPrinted);
    const ExampleRun run = without_noise(example).seed(seed).run();
    EXPECT_GT(run.error.from(1.0, 2.0).max(), 0.1) << seed;
    EXPECT_LT(run.error.from(4.0).max(), 0.1) << seed;
    EXPECT_LT(run.error.from(10.0).max(), 1e-4) << seed;
    EXPECT_LT(run.error.from(15.0).max(), 1e-7) << seed;
  }
}

}  // namespace
}  // namespace sampled_data_observers::test
