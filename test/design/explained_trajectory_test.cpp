#include "design/explained_trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "design/linearized_trajectory.h"
#include "observer/original_high_gain_observer.h"
#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/config/yaml_file.h"

namespace sampled_data_observers {
namespace {

/// x1 turns with x2 at the rate w; d adds to x2 at jumps. Only x1 is measured, all the time.
std::shared_ptr<const Plant> turning() {
  return read_observer_config(read_yaml_text(R"(
observer: SynchronizedObserver
plant:
  states: [x1, x2, d]
  parameters: {w: 2}
  flow: {x1: w*x2, x2: -w*x1, d: 0}
  jump_map: {formulas: {x1: x1, x2: x2 + d, d: d}}
sensors: {y: {h: [x1], measured: continuous, source: {topic: y}}}
sampling: {T1: 1, T2: 1}
gains: {L_c: [[1], [0], [0]]}
)",
                                             "test.yaml"),
                              no_plant_plugins)
      .plant;
}

/// From (1, 0, d) on, with a jump every second.
std::vector<TrajectoryStep> steps_of_turning(double d, std::size_t jumps) {
  constexpr int kPerSecond = 50;
  std::vector<TrajectoryStep> steps;
  Eigen::Vector3d x(1.0, 0.0, d);
  const double angle = 2.0 / kPerSecond;
  for (std::size_t k = 0; k < jumps * kPerSecond; ++k) {
    const Eigen::Vector3d end(x(0) * std::cos(angle) + x(1) * std::sin(angle),
                              x(1) * std::cos(angle) - x(0) * std::sin(angle), d);
    const bool is_jump = k % kPerSecond == kPerSecond - 1;
    steps.push_back({static_cast<double>(k) / kPerSecond, 1.0 / kPerSecond, x, end,
                     Eigen::VectorXd(0), 0, is_jump});
    x = end;
    if (is_jump) x(1) += d;
  }
  return steps;
}

TEST(LinearizedTrajectory, HasTheTransitionAndTheJumpInUnitsOfTheTrajectory) {
  const auto steps = steps_of_turning(4.0, 1);
  const auto linear = linearize(*turning(), steps);
  // x1 and x2 are 1 at most, or a little less as the steps see them; d is 4.
  const double c = std::cos(2.0 / 50.0);
  EXPECT_NEAR(c, linear[0].transition(0, 0), 1e-6);
  EXPECT_NEAR(1.0, linear[0].C(0, 0), 1e-6);
  const LinearizedStep& last = linear.back();
  ASSERT_EQ(3, last.G.rows());
  EXPECT_NEAR(4.0, last.G(1, 2), 0.02);
  EXPECT_EQ(0u, linear[0].G.size());
}

TEST(ExplainedTrajectory, TellsWhatJumpsAddToFlow) {
  const auto plant = turning();
  const auto steps = steps_of_turning(0.5, 3);
  const auto linear = linearize(*plant, steps);
  const Visibility flow = visibility(steps, linear, 0, 50, true);
  EXPECT_LT(flow.least, 1e-12);
  EXPECT_NEAR(1.0, std::abs(flow.direction(2)), 1e-9);
  // d moves x2 at the first jump, which turns into x1.
  EXPECT_GT(visibility(steps, linear, 0, 100, true).least, 0.05);
  const std::string text = explain_trajectory(*plant, steps, nullptr);
  const auto says = [&](const char* part) { return text.find(part) != std::string::npos; };
  EXPECT_TRUE(says("with 3 jumps, 1 to 1 s apart")) << text;
  EXPECT_TRUE(says("- NOT ALL in 3 of 3 stretches")) << text;
  EXPECT_TRUE(says("over 1 jump: NOT ALL in 3 of 3")) << text;
  EXPECT_TRUE(says("over 2 jumps: all of the state")) << text;
}

TEST(ExplainedTrajectory, FindsWhereCoordinatesAreSingular) {
  const auto plant = turning();
  const auto steps = steps_of_turning(0.5, 3);
  // det dT/dx = 2 x1, which is 0 at pi/4 first.
  const ObserverConfig original = read_observer_config(read_yaml_text(R"(
observer: HighGainObserver
plant: {states: [x1, x2, d], flow: {x1: x2, x2: -x1, d: 0}}
sensors: {y: {h: [x1], measured: continuous, source: {topic: y}}}
sampling: {T1: 1, T2: 1}
gains: {form: original, ell: 1, damping: 1, K: [3, 3, 1], T: [x1^2, x2, d]}
)",
                                                                      "test.yaml"),
                                                       no_plant_plugins);
  const auto& law = dynamic_cast<const OriginalHighGainObserver&>(original.law->observer());
  const TrajectoryCoordinates coordinates{
      law.T(), Eigen::Vector3d(1.0, 0.5, 0.25), Eigen::Vector3d::Ones(), {0}};
  const std::string text = explain_trajectory(*plant, steps, &coordinates);
  EXPECT_NE(std::string::npos, text.find("SINGULAR on the trajectory")) << text;
  EXPECT_NE(std::string::npos, text.find("first at t = 0.8")) << text;
}

}  // namespace
}  // namespace sampled_data_observers
