// What is rejected after gains were exchanged, of the time before: bounds of either law.
#include <gtest/gtest.h>

#include <cmath>

#include "certificate/certified_gains.h"
#include "sampled_data_observers/runtime/estimator.h"
#include "support/random_events.h"
#include "support/stamps.h"

namespace sampled_data_observers::test {
namespace {

constexpr char kReloadedGains[] = "test/certificate/ferrante2019_oscillator_0.2.yaml";
constexpr Stamp kReload = kStart + kSecond / 10;

class BoundAfterReloadTest : public ::testing::Test {
 protected:
  BoundAfterReloadTest() : before_(make(bounded_)) {
    before_.submit(OwnedEvent{kStart, EventKind::kSample, 0, {1.0}}.view(), kStart);
  }

  Estimator make(const ObserverConfig& config) const { return {config.law, bounded_.options}; }

  static bool has_bound(Estimator& estimator, Stamp stamp) {
    const Estimate* estimate = nullptr;
    EXPECT_EQ(Timeline::Query::kOk, estimator.estimate_at(stamp, estimate));
    return std::isfinite(estimator.bound(*estimate, stamp + kSecond).value);
  }

  static void reject_jump(Estimator& estimator, Stamp stamp) {
    Event jump;
    jump.stamp = stamp;
    jump.kind = EventKind::kJump;
    estimator.note_rejected(jump, kReload + kSecond / 100);
  }

  const ObserverConfig bounded_ = CertifiedGains(kReloadedGains)
                                      .assuming("{initial_error: 1, noise: 0.1, disturbance: 0.5}")
                                      .config();
  const ObserverConfig unbounded_ = CertifiedGains(kReloadedGains).config();
  Estimator before_;
};

TEST_F(BoundAfterReloadTest, TheLawOfBeforeMindsEvenWhereTheNewOneDoesNot) {
  Estimator after = make(unbounded_);
  after.take_over(before_, kReload);
  const Stamp published_late = kReload - kSecond / 50;
  EXPECT_TRUE(has_bound(after, published_late));
  reject_jump(after, published_late - 1);
  EXPECT_FALSE(has_bound(after, published_late));
}

TEST_F(BoundAfterReloadTest, WhatTheLawOfBeforeCanNotMarkIsMarkedAfterIt) {
  before_.resume(kReload);
  Estimator after = make(bounded_);
  after.take_over(before_, kReload);
  EXPECT_TRUE(has_bound(after, kReload + kSecond / 100));
  reject_jump(after, kReload - kSecond / 50);
  EXPECT_FALSE(has_bound(after, kReload + kSecond / 100));
}

/// Certified gains that are exchanged for themselves right after a sample, from which on their
/// Lyapunov function is εᵀ P ε.
struct SelfReload {
  const char* gains;
  const char* assumptions;
  Duration interval;
};

const SelfReload kSelfReloads[] = {
    {"config/examples/sferlazza2019_aircraft_1_3/gains.yaml", "{initial_error: 1, noise: 0.1}",
     2 * kSecond},
    {"config/examples/etienne2019_dc_drive/gains.yaml", "{initial_error: 1, noise: 0.1}",
     kSecond / 4},
    {"config/examples/ferrante2016_mass_spring/gains_timer_dependent.yaml",
     "{initial_error: 1, noise: 0.1, disturbance: 0}", kSecond},
};

TEST(BoundAfterSelfReloadTest, StartsFromTheEllipsoidAndNotFromTheNorm) {
  for (const SelfReload& reload : kSelfReloads) {
    const ObserverConfig config =
        CertifiedGains(reload.gains).assuming(reload.assumptions).config();
    Estimator before(config.law, config.options);
    Stamp stamp = kStart;
    for (int i = 0; i < 20; ++i, stamp += reload.interval) {
      const std::vector<double> y(static_cast<std::size_t>(config.plant->sensors()[0].outputs()));
      before.submit(OwnedEvent{stamp, EventKind::kSample, 0, y}.view(), stamp);
    }
    stamp -= reload.interval;
    Estimate estimate = before.make_estimate();
    const Eigen::Index n = config.law->estimate_size();
    Eigen::VectorXd known(n);
    Eigen::VectorXd kept(n);
    ASSERT_EQ(Timeline::Query::kOk, before.estimate_at(stamp, estimate));
    before.state_bounds(estimate, stamp, known);
    const double norm = before.bound(estimate, stamp).value;
    Estimator after(config.law, config.options);
    after.take_over(before, stamp);
    ASSERT_EQ(Timeline::Query::kOk, after.estimate_at(stamp, estimate));
    after.state_bounds(estimate, stamp, kept);
    // √tr(P W P⁻¹ P W P⁻¹) = √n W.
    const double factor = std::pow(static_cast<double>(n), 0.25);
    for (Eigen::Index j = 0; j < n; ++j) {
      EXPECT_GE(kept(j), known(j)) << reload.gains;
      EXPECT_LE(kept(j), std::min(norm, known(j)) * factor * (1.0 + 1e-6)) << reload.gains;
    }
  }
}

TEST(BoundAfterSelfReloadTest, OfAConstantGainFallsFromTheEllipsoidAtTheNextSample) {
  const ObserverConfig config =
      CertifiedGains("config/examples/ferrante2016_mass_spring/gains.yaml")
          .assuming("{initial_error: 1, noise: 0, disturbance: 0}")
          .config();
  const ObserverLaw& law = *config.law;
  const Eigen::Index n = law.estimate_size();
  Eigen::VectorXd workspace(law.workspace_size());
  Eigen::VectorXd state(law.state_size());
  law.initialize(state.data());
  const double y = 0.0;
  const auto sample = [&](Eigen::VectorXd& at) {
    law.flow(kSecond, at.data(), workspace.data());
    law.reset({0, EventKind::kSample, 0, &y, 1}, at.data(), workspace.data());
  };
  for (int i = 0; i < 10; ++i) sample(state);
  Eigen::VectorXd by_norm(law.state_size());
  law.initialize(by_norm.data());
  law.keep_bound(law.known_bound(state.data()), by_norm.data());
  Eigen::VectorXd by_ellipsoid = by_norm;
  Eigen::MatrixXd Q(n, n);
  law.known_ellipsoid(state.data(), workspace.data(), Q);
  law.narrow_bound(Q, by_ellipsoid.data());
  const auto bound = [&law](const Eigen::VectorXd& at) { return law.error_bound(at.data()); };
  for (int i = 0; i < 3; ++i) {
    EXPECT_LE(bound(state), bound(by_ellipsoid) * (1.0 + 1e-9)) << i;
    EXPECT_LE(bound(by_ellipsoid), bound(by_norm)) << i;
    for (Eigen::VectorXd* each : {&state, &by_norm, &by_ellipsoid}) sample(*each);
  }
  EXPECT_LT(bound(by_ellipsoid), 0.8 * bound(by_norm));
}

}  // namespace
}  // namespace sampled_data_observers::test
