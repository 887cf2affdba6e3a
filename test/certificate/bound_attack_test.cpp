// Guaranteed bounds under attack, those on the norm, on each state and the ellipsoid: for each
// theorem that gives one, on stiff, fast, ill-scaled and multi-output plants, a search for the
// times between events, initial error, noise and disturbance with which the error comes to most of
// its bound; in one of four, some events come later than T2 or sooner than T1. The environment
// variable SDO_COMPARISONS says how many comparisons it takes for each claim.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "certificate/attack/beam_search.h"
#include "certificate/certified_gains.h"

namespace sampled_data_observers::test {
namespace {

constexpr double kComparisons = 1e5;

/// A gain file, and what is assumed.
struct Claim {
  const char* gains;
  ErrorAssumptions assumptions;
};

#define ATTACK(file) "test/certificate/attack/" file ".yaml"

const Claim kClaims[] = {
    {"config/examples/ferrante2016_scalar/gains.yaml", {1.0, 0.1, 0.0}},
    {"config/examples/ferrante2016_mass_spring/gains.yaml", {1.0, 0.1, 0.0}},
    {ATTACK("stiff/ferrante2016_theorem1"), {1.0, 0.01, 0.0}},
    {ATTACK("fast/ferrante2016_theorem1"), {1.0, 0.1, 0.0}},
    {ATTACK("scaled/ferrante2016_theorem1"), {1.0, 0.01, 0.0}},
    {ATTACK("multi_output/ferrante2016_theorem1"), {1.0, 0.0, 0.0}},
    {ATTACK("multi_output/ferrante2016_theorem1"), {1.0, 0.1, 0.0}},
    {"test/certificate/ferrante2019_oscillator_0.41.yaml", {1.0, 0.05, 0.5}},
    // By their run-time certificates.
    {"config/examples/ferrante2019_oscillator/gains.yaml", {1.0, 0.05, 0.5}},
    {"config/examples/ferrante2019_unicycle/gains.yaml", {1.0, 0.05, 0.1}},
    {ATTACK("stiff/ferrante2019_theorem2"), {0.001, 0.01, 0.1}},
    {ATTACK("stiff/ferrante2019_corollary1"), {1.0, 0.01, 0.0}},
    {ATTACK("stiff/ferrante2019_corollary2"), {0.001, 0.01, 0.1}},
    {ATTACK("fast/ferrante2019_theorem2"), {1.0, 0.0, 0.0}},
    {ATTACK("scaled/ferrante2019_theorem2"), {1.0, 0.01, 0.0}},
    {ATTACK("multi_output/ferrante2019_theorem2"), {1.0, 0.1, 0.1}},
    {"config/examples/sferlazza2019_aircraft_1_3/gains.yaml", {1.0, 0.1, 0.0}},
    {"config/examples/sferlazza2019_aircraft_4_8/gains.yaml", {1.0, 0.0, 0.0}},
    {ATTACK("turning/sferlazza2019_theorem2"), {1.0, 0.0, 0.0}},
    {ATTACK("turning/sferlazza2019_theorem2"), {1.0, 0.1, 0.0}},
    {ATTACK("fast/sferlazza2019_theorem2"), {1.0, 0.1, 0.0}},
    {ATTACK("scaled/sferlazza2019_theorem2"), {1.0, 0.01, 0.0}},
    {ATTACK("multi_output/sferlazza2019_theorem2"), {1.0, 0.1, 0.0}},
    {ATTACK("multi_output/sferlazza2019_theorem2_lambda"), {1.0, 0.0, 0.0}},
    {ATTACK("multi_output/sferlazza2019_theorem2_lambda"), {1.0, 0.1, 0.0}},
    {ATTACK("multi_output/sferlazza2019_theorem2_rate"), {1.0, 0.1, 0.0}},
    {ATTACK("all_outputs/sferlazza2019_equation17"), {1.0, 0.1, 0.0}},
    {ATTACK("multi_output/etienne2019_proposition2_channels"), {1.0, 0.1, 0.1}},
    {"config/examples/etienne2019_dc_drive/gains.yaml", {1.0, 0.1, 0.0}},
    {ATTACK("stiff/etienne2019_proposition1"), {1.0, 0.0, 0.0}},
    {ATTACK("stiff/etienne2019_proposition2"), {1.0, 0.01, 0.1}},
    {ATTACK("fast/etienne2019_proposition2"), {1.0, 0.1, 0.0}},
    {ATTACK("multi_output/etienne2019_proposition2"), {1.0, 0.1, 0.1}},
    {"config/examples/bernard2022_impulsive/gains.yaml", {1.0, 0.0, 0.0}},
    {"config/examples/bernard2022_bouncing_ball/gains.yaml", {1.0, 0.1, 0.0}},
    {"test/certificate/bernard2022_bouncing_ball_equation26.yaml", {1.0, 0.1, 0.0}},
    {ATTACK("impulsive/bernard2022_corollary5_2"), {1.0, 0.1, 0.0}},
    {ATTACK("impulsive/bernard2022_equation26"), {1.0, 0.1, 0.0}},
};

std::size_t comparisons_asked_for() {
  const char* text = std::getenv("SDO_COMPARISONS");
  return static_cast<std::size_t>(text == nullptr ? kComparisons : std::strtod(text, nullptr));
}

std::string assumptions_text(const ErrorAssumptions& assumptions) {
  return "{initial_error: " + std::to_string(assumptions.initial_error) +
         ", noise: " + std::to_string(assumptions.noise) +
         ", disturbance: " + std::to_string(assumptions.disturbance) + "}";
}

class BoundAttackTest : public ::testing::TestWithParam<Claim> {};

TEST_P(BoundAttackTest, FindsNoErrorAboveItsBound) {
  const Claim& claim = GetParam();
  CertifiedGains gains(claim.gains);
  const CertificateSubject subject = gains.certificate().subject;
  const ObserverConfig config = gains.assuming(assumptions_text(claim.assumptions)).config();
  AttackedObserver observer(config, subject.plant.N);
  BeamSearch search(observer, subject, claim.assumptions);
  const std::size_t wanted = comparisons_asked_for();
  for (std::uint64_t seed = 0; observer.comparisons() < wanted; ++seed) {
    const bool strays = seed % 4 == 3;
    const std::size_t without_bound = observer.without_bound();
    observer.attack_states(seed % 2 == 1);
    search.run(seed, strays);
    ASSERT_LE(observer.largest_share(), 1.0 + 1e-9) << claim.gains << ", seed " << seed;
    ASSERT_LE(observer.largest_state_share(), 1.0 + 1e-9) << claim.gains << ", seed " << seed;
    ASSERT_LE(observer.largest_ellipsoid_share(), 1.0 + 1e-6) << claim.gains << ", seed " << seed;
    if (strays) continue;
    ASSERT_EQ(without_bound, observer.without_bound()) << claim.gains << ", seed " << seed;
  }
  // Otherwise the attack would not notice a bound of another size.
  EXPECT_GT(observer.largest_share(), 0.01);
  EXPECT_GT(observer.largest_state_share(), 0.01);
  EXPECT_GT(observer.largest_ellipsoid_share(), 0.01);
  std::printf(
      "%s: %zu comparisons, the error came to %.3g of its bound, a state to %.3g of its own, "
      "%.3g of the ellipsoid\n",
      claim.gains, observer.comparisons(), observer.largest_share(), observer.largest_state_share(),
      observer.largest_ellipsoid_share());
}

INSTANTIATE_TEST_SUITE_P(EveryClaim, BoundAttackTest, ::testing::ValuesIn(kClaims));

}  // namespace
}  // namespace sampled_data_observers::test
