#include "sampled_data_observers/plant/linear_plant.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sampled_data_observers {
namespace {

constexpr double kPi = 3.14159265358979323846;

LinearPlantDescription cart() {
  LinearPlantDescription plant;
  plant.state_names = {"p", "v"};
  plant.input_names = {"u"};
  plant.A.resize(2, 2);
  plant.A << 0.0, 1.0, 0.0, 0.0;
  plant.B = Eigen::Vector2d(0.0, 1.0);
  Eigen::MatrixXd C(2, 2);
  C << 1.0, 0.0, 0.0, 2.0;
  plant.sensors = {{"s", C, {false, true}}};
  Eigen::MatrixXd A_d(2, 2);
  A_d << 1.0, 0.0, 0.0, -0.5;
  plant.jump_map = AffineJumpMap{A_d, Eigen::Vector2d(0.0, 0.25)};
  return plant;
}

TEST(LinearPlantTest, JumpsByTheAffineMap) {
  const LinearPlant plant(cart());
  Eigen::Vector2d x(3.0, -2.0);
  Eigen::Vector2d scratch;
  plant.jump(x.data(), scratch.data());
  EXPECT_EQ(Eigen::Vector2d(3.0, 1.25), x);
}

TEST(LinearPlantTest, BiasStatesAreConstantAddedToTheOutputAndLeftByJumps) {
  const LinearPlant plant(with_bias_states(cart(), {{"b", 0, 1}}));
  ASSERT_EQ(3, plant.states());
  EXPECT_EQ("b", plant.description().state_names.back());
  EXPECT_EQ(1.0, plant.sensors()[0].C(1, 2));
  EXPECT_EQ(0.0, plant.sensors()[0].C(0, 2));
  Eigen::Vector3d x(1.0, 2.0, 0.5);
  Eigen::Vector3d scratch;
  const double u = 1.0;
  plant.flow().apply(kNanosecondsPerSecond, x.data(), &u, scratch.data());
  EXPECT_NEAR(3.5, x(0), 1e-15);
  EXPECT_EQ(0.5, x(2));
  plant.jump(x.data(), scratch.data());
  EXPECT_EQ(0.5, x(2));
}

TEST(LinearPlantTest, NamesTheMatrixThatDoesNotFit) {
  const auto fault = [](LinearPlantDescription plant) -> std::string {
    try {
      LinearPlant checked(std::move(plant));
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  LinearPlantDescription plant = cart();
  plant.sensors[0].C.resize(1, 3);
  EXPECT_NE(std::string::npos, fault(plant).find("C of sensor 's'"));
  plant = cart();
  plant.jump_map->b_d.resize(3);
  EXPECT_NE(std::string::npos, fault(plant).find("b_d"));
  plant = cart();
  plant.state_names.pop_back();
  EXPECT_NE(std::string::npos, fault(plant).find("state name"));
  EXPECT_EQ("", fault(cart()));
}

TEST(SensorTest, WrapsAnglesIntoTheHalfOpenTurn) {
  EXPECT_EQ(kPi, wrap_angle(kPi));
  EXPECT_EQ(kPi, wrap_angle(-kPi));
  EXPECT_NEAR(-kPi + 0.1, wrap_angle(kPi + 0.1), 1e-15);
  EXPECT_NEAR(0.25, wrap_angle(0.25 - 12 * kPi), 1e-14);
  EXPECT_EQ(0.0, wrap_angle(0.0));
}

TEST(SensorTest, OnlyAngularOutputsAreWrapped) {
  const LinearPlant plant(cart());
  const double y[] = {10.0, 3.0};
  const double x[] = {1.0, -1.5};
  double innovation[2];
  compute_innovation(plant.sensors()[0], y, x, innovation);
  EXPECT_EQ(9.0, innovation[0]);
  EXPECT_NEAR(6.0 - 2.0 * kPi, innovation[1], 1e-15);
}

}  // namespace
}  // namespace sampled_data_observers
