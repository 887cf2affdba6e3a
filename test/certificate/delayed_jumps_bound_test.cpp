// Guaranteed bounds where the resets of jumps wait for a release (jumps/late: delayed), and where
// the flow takes an output in place of a state: what is refused, and single cases beside true
// plants. followed_law_bound_test.cpp attacks them.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "certificate/certified_gains.h"
#include "certificate/true_run.h"
#include "support/config_faults.h"

namespace sampled_data_observers::test {
namespace {

const char kWaitingImpulsive[] = "config/examples/bernard2022_impulsive/gains.yaml";
const char kWaitingHeld[] = "test/certificate/attack/held/bernard2022_equation14.yaml";
const char kInjectedAngle[] = "test/certificate/attack/injected/bernard2022_equation36.yaml";
const char kLateDelayed[] = "jumps: {late: delayed}";

CertifiedGains waiting_impulsive() {
  return CertifiedGains(kWaitingImpulsive)
      .with(kLateDelayed)
      .with("initial_estimate: {x1: 0, x2: 50, x3: 0}")
      .with("history: {duration: 100, max_events: 1000}")
      .assuming("{initial_error: 0.01, noise: 0}");
}

/// Of all estimates from `begin` to `end`, at the end of the run.
std::vector<TrueRun::Comparison> compare_from(TrueRun& run, double begin, double end) {
  std::vector<TrueRun::Comparison> all;
  for (int i = 0; begin + 0.01 * i < end; ++i) all.push_back(run.compare(begin + 0.01 * i, 90.0));
  return all;
}

double largest_bound(const std::vector<TrueRun::Comparison>& all) {
  double largest = 0.0;
  for (const TrueRun::Comparison& each : all) {
    EXPECT_TRUE(each.holds());
    largest = std::max(largest, each.bound.value);
  }
  return largest;
}

TEST(DelayedJumpsBoundTest, IsOfTheSizeOfTheJumpUntilItsReleaseAndThenOfWhatThePlantMoved) {
  const ObserverConfig config = waiting_impulsive().config();
  EXPECT_NE(std::string::npos, config.warning.find("until its release")) << config.warning;
  for (const bool is_measured : {true, false}) {
    TrueRun run(config, Eigen::Vector3d(0.006, 0.0, 0.008));
    if (is_measured) {
      run.jump(3.0, 0.2);
    } else {
      run.unmeasured_jump(3.0, 0.2, 0.0);
    }
    run.tell(10.0);
    EXPECT_LT(largest_bound(compare_from(run, 0.0, 3.0)), 1.0);
    const std::vector<TrueRun::Comparison> waiting = compare_from(run, 3.0, 3.2);
    EXPECT_GT(waiting.front().error, 10.0);
    EXPECT_LT(largest_bound(waiting), 1e3);
    // At 50 per second.
    const std::vector<TrueRun::Comparison> behind = compare_from(run, 3.2, 5.0);
    EXPECT_GT(behind.front().error, 5.0);
    EXPECT_LT(largest_bound(behind), 5.0 * behind.front().error);
  }
}

TEST(DelayedJumpsBoundTest, KnowsOfInputsThatChangeWhileAJumpWaits) {
  const ObserverConfig config = waiting_impulsive()
                                    .with("plant: {inputs: [u], B: [[0], [1], [0]]}")
                                    .with("initial_estimate: {x1: 0, x2: 0, x3: 0}")
                                    .with_own_hash()
                                    .config();
  TrueRun run(config, Eigen::Vector3d(0.006, 0.0, 0.008));
  run.jump(3.0, 1.0);
  run.input(3.2, 100.0, 0.0);
  run.input(4.0, 0.0, 0.0);
  run.tell(10.0);
  EXPECT_LT(largest_bound(compare_from(run, 3.0, 3.2)), 1.0);
  const std::vector<TrueRun::Comparison> behind = compare_from(run, 4.0, 5.0);
  EXPECT_GT(behind.front().error, 10.0);
  EXPECT_TRUE(std::isfinite(largest_bound(behind)));
}

TEST(DelayedJumpsBoundTest, AJumpThatComesWhileAnotherWaitsReleasesThatFirst) {
  const ObserverConfig config = waiting_impulsive().config();
  TrueRun run(config, Eigen::Vector3d(0.006, 0.0, 0.008));
  run.jump(3.0, 1.0);
  run.jump(3.5, 1.0);
  run.tell(10.0);
  EXPECT_TRUE(std::isfinite(largest_bound(compare_from(run, 0.0, 9.0))));
}

/// A plant that stands still between jumps, and gains that are right, if odd.
const char kStill[] = R"(
plant: {states: [x], A: [[0]], jump_map: {A_d: [[0.1]]}}
sensors: {position: {C: [[1]], measured: at_jumps}}
jumps: {topic: jumps, late: delayed}
observer: SynchronizedObserver
sampling: {T1: 0.5, T2: 5}
gains: {L_d: [[-0.8]]}
initial_estimate: {x: 100}
history: {duration: 100, max_events: 1000}
certificate: {theorem: bernard2022_corollary5_2, T1: 0.5, T2: 5, jump_decay: 0.05, P: [[1]], plant: {file: none.yaml, hash: x}}
error_assumptions: {initial_error: 0.01, noise: 0}
)";

/// They are those of the jump that waits, not of the one that it released.
TEST(DelayedJumpsBoundTest, OutputsComeBehindAJumpThatReleasedAnother) {
  const ObserverConfig config =
      read_observer_config(with_own_hash(read_yaml_text(kStill, "test.yaml")), no_plant_plugins);
  TrueRun run(config, Eigen::VectorXd::Zero(1));
  run.jump_in_parts(1.0, 4.0, {0});
  run.jump_in_parts(2.0, 4.0, {0});
  run.tell(10.0);
  EXPECT_LT(largest_bound(compare_from(run, 2.0, 3.0)), 20.0);
  EXPECT_LT(largest_bound(compare_from(run, 6.0, 9.9)), 1.0);
}

TEST(DelayedJumpsBoundTest, AJumpThatIsRefusedWhileAnotherWaitsLosesIt) {
  const ObserverConfig config =
      waiting_impulsive().with("jumps: {late: delayed, min_separation: 1}").config();
  TrueRun run(config, Eigen::Vector3d(0.006, 0.0, 0.008));
  run.jump(3.0, 1.0);
  run.jump(3.5, 1.0);
  run.tell(10.0);
  EXPECT_EQ(BoundLoss::kNone, run.compare(3.4, 90.0).bound.loss);
  EXPECT_EQ(BoundLoss::kUnknownJump, run.compare(3.5, 90.0).bound.loss);
  EXPECT_EQ(BoundLoss::kUnknownJump, run.compare(6.0, 90.0).bound.loss);
}

TEST(DelayedJumpsBoundTest, OtherGainsGoOnFromAJumpThatIsReleasedWhereTheyBegin) {
  const ObserverConfig config = waiting_impulsive().config();
  TrueRun run(config, Eigen::Vector3d(0.006, 0.0, 0.008));
  run.jump(3.0, 0.5);
  run.tell(3.2);
  Estimator next(config.law, config.options);
  next.take_over(run.estimator(), TrueRun::stamp_of(3.2));
  run.estimator() = std::move(next);
  run.tell(10.0);
  EXPECT_TRUE(run.reports().back().used());
  EXPECT_GT(run.compare(3.1, 90.0).error, 10.0);
  EXPECT_LT(largest_bound(compare_from(run, 3.2, 6.0)), 100.0);
  EXPECT_TRUE(run.compare(3.1, 90.0).holds());
}

/// The norm of the error just after a release, and its bound: of an observer that knew all before.
TEST(DelayedJumpsBoundTest, OfHeldOutputsTakesInWhatThePlantMovedUntilTheRelease) {
  const ObserverConfig config =
      CertifiedGains(kWaitingHeld)
          .with(kLateDelayed)
          .assuming("{initial_error: 1e-6, noise: 0, disturbance: 0, output_rate: 1e-6}")
          .config();
  const ObserverLaw& law = *config.law;
  Eigen::VectorXd state(law.state_size());
  Eigen::VectorXd workspace(law.workspace_size());
  law.initialize(state.data());
  const double y = 0.0;
  const int held = 0;  // the position
  const auto take = [&](const Event& event) {
    EXPECT_TRUE(took_effect(law.reset(event, state.data(), workspace.data())));
  };
  // At (0, 0), to which the plant returns by x⁺ = (0, 1).
  take({1, EventKind::kOutput, held, &y, 1});
  take({1, EventKind::kJump, 0, &y, 1});
  law.flow(from_seconds(0.2), state.data(), workspace.data());
  Event release;
  release.kind = EventKind::kRelease;
  release.delay = from_seconds(0.2);
  take(release);
  Eigen::VectorXd x = Eigen::Vector2d(0.0, 1.0);
  Eigen::VectorXd scratch(2);
  const AffineMap& flow = *config.plant->modes().front().flow->affine();
  LinearFlow(flow.M(), Eigen::MatrixXd::Zero(2, 1))
      .apply(from_seconds(0.2), x.data(), &y, scratch.data());
  const double error = (x - state.head(2)).norm();
  EXPECT_GT(error, 0.1);
  EXPECT_LE(error, law.error_bound(state.data()));
  EXPECT_LT(law.error_bound(state.data()), 20.0 * error);
}

std::string delayed_fault(const std::string& file, const std::string& assumptions,
                          const std::string& with = "{}") {
  return fault_of(
      [&] { CertifiedGains(file).with(kLateDelayed).with(with).assuming(assumptions).config(); });
}

void expect_parts_of(const std::string& message, const std::vector<const char*>& parts) {
  for (const char* part : parts) EXPECT_NE(std::string::npos, message.find(part)) << message;
}

TEST(DelayedJumpsBoundTest, IsRefusedWhereNothingIsProved) {
  const std::vector<const char*> refused = {"error_assumptions", "late: rewind", "delayed"};
  expect_parts_of(delayed_fault("config/examples/bernard2022_switched/gains.yaml",
                                "{initial_error: 1, noise: 0}"),
                  refused);
  expect_parts_of(delayed_fault("test/certificate/attack/switched/bernard2022_example7_1.yaml",
                                "{initial_error: 1, noise: 0, disturbance: 0, output_rate: 1}"),
                  refused);
  expect_parts_of(delayed_fault(kWaitingImpulsive, "{initial_error: 1, noise: 0}",
                                "jumps: {stamp_error: 0.01}"),
                  refused);
  expect_parts_of(delayed_fault(kInjectedAngle,
                                "{initial_error: 1, noise: 0, disturbance: 0, output_rate: 1, "
                                "injection_lipschitz: {x1: 3, x2: 0.5}}",
                                "gains: {output_injection: {x1: angle}}"),
                  refused);
}

/// The message with which a configuration with an injected output is refused.
std::string injected_fault(const std::string& assumptions, const std::string& with = "{}") {
  return fault_of([&] {
    CertifiedGains(kInjectedAngle)
        .with("gains: {output_injection: {x1: angle}}")
        .with(with)
        .assuming("{initial_error: 1, noise: 0, disturbance: 0, output_rate: 1" + assumptions + "}")
        .config();
  });
}

TEST(InjectedOutputBoundTest, NeedsWhatTheFlowMakesOfTheOutput) {
  const std::string right = ", injection_lipschitz: {x1: 3, x2: 0.5}";
  EXPECT_EQ("no fault", injected_fault(right));
  expect_parts_of(injected_fault(""), {"error_assumptions/injection_lipschitz", "none"});
  expect_parts_of(injected_fault(", injection_lipschitz: {x1: 2.9, x2: 0.5}"),
                  {"error_assumptions/injection_lipschitz", "for x1 at least", "found 2.9"});
  expect_parts_of(injected_fault(", injection_lipschitz: {x1: 3}"),
                  {"error_assumptions/injection_lipschitz", "for x2 at least", "found 0"});
  expect_parts_of(injected_fault(", injection_lipschitz: {x1: 3, y: 1}"),
                  {"error_assumptions/injection_lipschitz/y", "unknown key"});
  expect_parts_of(injected_fault(", injection_lipschitz: {x1: -3, x2: 0.5}"),
                  {"error_assumptions/injection_lipschitz/x1", "found -3"});
  expect_parts_of(injected_fault(right, "jumps: {stamp_error: 0.01}"),
                  {"error_assumptions", "jumps/stamp_error"});
  expect_parts_of(fault_of([] {
                    CertifiedGains(kWaitingImpulsive)
                        .assuming("{initial_error: 1, noise: 0, injection_lipschitz: {x1: 1}}")
                        .config();
                  }),
                  {"error_assumptions/injection_lipschitz", "output_injection", "none"});
}

TEST(InjectedOutputBoundTest, StatedMapsWithoutInjectionNeedNothingMore) {
  const ObserverConfig config = CertifiedGains(kWaitingImpulsive)
                                    .with("certificate: {A: [[0, 1, 0], [0, 0, 0], [0, 0, 0]]}")
                                    .assuming("{initial_error: 1, noise: 0}")
                                    .config();
  EXPECT_NE("", config.guarantee);
}

}  // namespace
}  // namespace sampled_data_observers::test
