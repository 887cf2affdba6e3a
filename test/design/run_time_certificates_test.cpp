// Designs for another objective bound the error at run time by the best proof of their gains.
#include <gtest/gtest.h>

#include <limits>
#include <ostream>
#include <string>

#include "certificate/certified_gains.h"
#include "design/analysis.h"
#include "design/run_time_figures.h"
#include "design/run_time_proof.h"

namespace sampled_data_observers::test {
namespace {

struct ShippedExample {
  const char* folder;
  /// By how much the design's own proof lets noise and disturbance count more, at least.
  double times;
  /// What noise alone leaves in the end, over its size: as the design's own proof has it, and by
  /// the best proof for noise alone.
  double of_design;
  double best;
};
void PrintTo(const ShippedExample& example, std::ostream* out) { *out << example.folder; }

class RunTimeCertificateTest : public ::testing::TestWithParam<ShippedExample> {
 protected:
  const CertifiedGains gains_{std::string("config/examples/") + GetParam().folder + "/gains.yaml"};
};

double figure(const Certificate& certificate, const ErrorAssumptions& assumptions) {
  return final_error(*certificate.theorem, certificate.subject, certificate.values, assumptions);
}

ErrorAssumptions noise_and(double disturbance) {
  ErrorAssumptions assumptions;
  assumptions.noise = 1.0;
  assumptions.disturbance = disturbance;
  return assumptions;
}

TEST_P(RunTimeCertificateTest, BoundsTheErrorBetterThanThatOfTheDesign) {
  const CertificateConfig claim = *gains_.claim(kRunTimeCertificate);
  const ErrorAssumptions assumptions = noise_and(claim.disturbance.value());
  EXPECT_LT(GetParam().times * figure(claim.certificate, assumptions),
            figure(gains_.certificate(), assumptions));
}

TEST_P(RunTimeCertificateTest, AnalysisFindsTheBestForNoiseAlone) {
  const Certificate certificate = gains_.certificate();
  EXPECT_NEAR(figure(certificate, noise_and(0.0)), GetParam().of_design,
              0.01 * GetParam().of_design);
  Design design;
  design.certificate = certificate;
  const auto found = prove_for_run_time(design, noise_and(0.0), {});
  ASSERT_NE(found, nullptr);
  EXPECT_LE(figure(found->certificate, noise_and(0.0)), GetParam().best);
}

INSTANTIATE_TEST_SUITE_P(
    All, RunTimeCertificateTest,
    ::testing::Values(ShippedExample{"ferrante2019_oscillator", 1.5, 114.0, 45.0},
                      ShippedExample{"ferrante2019_unicycle", 1.5, 57.7, 31.5},
                      ShippedExample{"ferrante2019_flexible_link", 10.0, 1108.0, 79.0}),
    [](const auto& info) { return std::string(info.param.folder); });

}  // namespace
}  // namespace sampled_data_observers::test
