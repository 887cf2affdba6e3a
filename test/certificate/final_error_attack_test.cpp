// The bound that noise and disturbance leave in the end, beside the largest error that a search
// finds: for noise 1, and the disturbance that the gains were designed for. The environment
// variable SDO_RUNS says how many runs it plays for each claim.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "certificate/attack/worst_final_error.h"
#include "certificate/certified_gains.h"
#include "design/run_time_figures.h"
#include "design/worst_intervals.h"

namespace sampled_data_observers::test {
namespace {

constexpr std::size_t kRuns = 250;

/// A gain file, and how many times the largest error found its bound is at most.
struct Claim {
  const char* gains;
  double looseness;
};

#define EXAMPLE(file) "config/examples/" file ".yaml"

const Claim kClaims[] = {
    {EXAMPLE("ferrante2016_scalar/gains"), 1.01},
    {EXAMPLE("ferrante2016_scalar/gains_timer_dependent"), 1.1},
    {EXAMPLE("ferrante2016_mass_spring/gains"), 2.5},
    {EXAMPLE("ferrante2016_mass_spring/gains_timer_dependent"), 1.1},
    {EXAMPLE("ferrante2019_oscillator/gains"), 1.5},
    {EXAMPLE("ferrante2019_oscillator/gains_timer_dependent"), 1.5},
    {EXAMPLE("ferrante2019_unicycle/gains"), 1.9},
    {EXAMPLE("ferrante2019_unicycle/gains_timer_dependent"), 1.6},
    {EXAMPLE("ferrante2019_flexible_link/gains"), 2.3},
    {EXAMPLE("ferrante2019_flexible_link/gains_timer_dependent"), 1.8},
    {EXAMPLE("sferlazza2019_aircraft_1_3/gains"), 2.8},
    {EXAMPLE("sferlazza2019_aircraft_1_3/gains_timer_dependent"), 1.1},
    {EXAMPLE("sferlazza2019_aircraft_4_8/gains"), 3.0},
    {EXAMPLE("etienne2019_dc_drive/gains"), 1.4},
    {EXAMPLE("etienne2019_dc_drive/gains_timer_dependent"), 1.8},
    {EXAMPLE("bernard2022_bouncing_ball/gains"), 1.6},
    {EXAMPLE("bernard2022_bouncing_ball/gains_timer_dependent"), 1.9},
    {EXAMPLE("bernard2022_impulsive/gains"), 1.6},
    {EXAMPLE("bernard2022_impulsive/gains_timer_dependent"), 1.7},
};

std::size_t runs_asked_for() {
  const char* text = std::getenv("SDO_RUNS");
  return text == nullptr ? kRuns : static_cast<std::size_t>(std::strtod(text, nullptr));
}

class FinalErrorAttackTest : public ::testing::TestWithParam<Claim> {};

TEST_P(FinalErrorAttackTest, FindsNoErrorAboveTheBoundInTheEnd) {
  CertifiedGains gains(GetParam().gains);
  const bool has_own = gains.tree().find(kRunTimeCertificate) != nullptr;
  const CertificateConfig claim = *gains.claim(has_own ? kRunTimeCertificate : kCertificate);
  const CertificateSubject& subject = claim.certificate.subject;
  ErrorAssumptions assumptions;
  assumptions.noise = 1.0;
  assumptions.disturbance = claim.disturbance.value_or(0.0);
  const double bound =
      final_error(*claim.certificate.theorem, subject, claim.certificate.values, assumptions);
  // Irregular times may leave more than the regular ones of which the figure is.
  const double worst =
      std::max(bound, worst_intervals_final_error(*claim.certificate.theorem, subject,
                                                  claim.certificate.values, assumptions)
                          .value_or(bound));
  const ObserverConfig config = gains.config();
  const double error = WorstFinalError(config, subject, assumptions).of_runs(runs_asked_for());
  EXPECT_LE(error, worst);
  EXPECT_GE(GetParam().looseness * error, bound);
  std::printf(
      "%s: %s, T1 = %g s, T2 = %g s, |noise| <= 1, |disturbance| <= %.4g: bound %.4g, "
      "%.4g at irregular times, error %.4g, ratio %.3g\n",
      GetParam().gains, claim.certificate.theorem->name().c_str(), subject.T1, subject.T2,
      assumptions.disturbance, bound, worst, error, bound / error);
}

INSTANTIATE_TEST_SUITE_P(EveryClaim, FinalErrorAttackTest, ::testing::ValuesIn(kClaims));

}  // namespace
}  // namespace sampled_data_observers::test
