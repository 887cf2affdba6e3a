#include "replay/jump_neighbourhood.h"

#include <gtest/gtest.h>

#include <cmath>

#include "plant/linear_plant.h"
#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

using test::kMillisecond;
using test::kStart;

constexpr Duration kAround = 5 * kMillisecond;

/// A ball of which the height is measured: (p, v)+ = (-p, -0.5 v).
std::shared_ptr<const Plant> ball() {
  LinearPlantDescription description;
  description.state_names = {"p", "v"};
  description.A = Eigen::MatrixXd::Zero(2, 2);
  description.B = Eigen::MatrixXd::Zero(2, 0);
  description.jump_map = AffineJumpMap{Eigen::Vector2d(-1.0, -0.5).asDiagonal().toDenseMatrix(),
                                       Eigen::Vector2d::Zero()};
  description.sensors = {{"height", Eigen::RowVector2d(1.0, 0.0), {false}}};
  return make_linear_plant(description);
}

JumpNeighbourhood of_states(const std::vector<std::string>& states, Duration around = kAround) {
  std::vector<Quantity> quantities;
  for (const std::string& state : states) quantities.push_back(*state_quantity(*ball(), state));
  return {quantities, ball(), around};
}

void add(JumpNeighbourhood& neighbourhood, Duration at, const std::vector<double>& truth,
         const Eigen::Vector2d& x) {
  neighbourhood.add_truth(kStart + at, truth, x.data(), nullptr);
}

TEST(JumpNeighbourhoodTest, TellsErrorsAroundJumpsApart) {
  JumpNeighbourhood neighbourhood = of_states({"v", "p"});
  add(neighbourhood, -6 * kMillisecond, {-3.0, 1.0}, {1.5, -3.0});
  add(neighbourhood, -5 * kMillisecond, {-4.0, 0.0}, {0.0, 2.1});  // has jumped already
  add(neighbourhood, 5 * kMillisecond, {2.0, 0.0}, {0.25, -4.0});  // has yet to
  add(neighbourhood, 6 * kMillisecond, {2.0, 1.0}, {1.0, 2.75});
  // What is known of jumps may come later.
  neighbourhood.add_jump(kStart, kStart);
  const ErrorsApart errors = neighbourhood.errors();
  EXPECT_EQ(0.005, errors.around);
  EXPECT_EQ(1u, errors.jumps);
  EXPECT_EQ(2u, errors.stamps);
  EXPECT_DOUBLE_EQ(std::sqrt(0.75 * 0.75 / 2.0), *errors.rmse[0]);
  EXPECT_DOUBLE_EQ(std::sqrt(0.5 * 0.5 / 2.0), *errors.rmse[1]);
  EXPECT_DOUBLE_EQ(std::hypot(*errors.rmse[0], *errors.rmse[1]), *errors.rmse_norm);
  EXPECT_DOUBLE_EQ(0.75, *errors.largest);
  EXPECT_DOUBLE_EQ(6.1, *errors.peak);
  EXPECT_DOUBLE_EQ(0.25, *errors.peak_free);
}

TEST(JumpNeighbourhoodTest, JoinsOverlappingIntervalsAndReachesToReleases) {
  JumpNeighbourhood neighbourhood = of_states({"p"}, 0);
  neighbourhood.add_jump(kStart + 30, kStart + 31);
  neighbourhood.add_jump(kStart, kStart + 20);
  neighbourhood.add_jump(kStart + 10, kStart + 12);
  for (Duration at = -2; at <= 40; ++at) add(neighbourhood, at, {0.0}, {1.0, 0.0});
  const ErrorsApart errors = neighbourhood.errors();
  EXPECT_EQ(3u, errors.jumps);
  EXPECT_EQ(43u - 21u - 2u, errors.stamps);
}

TEST(JumpNeighbourhoodTest, SaysNothingOfPeaksWhereTheStateIsNotKnown) {
  JumpNeighbourhood neighbourhood = of_states({"v"});
  EXPECT_FALSE(neighbourhood.errors().rmse_norm);
  EXPECT_FALSE(neighbourhood.errors().largest);
  neighbourhood.add_jump(kStart, kStart);
  add(neighbourhood, 0, {1.0}, {0.0, 3.0});
  const ErrorsApart errors = neighbourhood.errors();
  EXPECT_DOUBLE_EQ(2.0, *errors.peak);
  EXPECT_FALSE(errors.peak_free);
  EXPECT_FALSE(errors.largest);
}

}  // namespace
}  // namespace sampled_data_observers
