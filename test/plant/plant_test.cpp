#include "sampled_data_observers/plant/plant.h"

#include <gtest/gtest.h>

#include <cmath>

#include "plant/bias_states.h"
#include "plant/linear_plant.h"

namespace sampled_data_observers {
namespace {

constexpr double kPi = 3.14159265358979323846;

std::shared_ptr<const VectorMap> matrix_map(const Eigen::MatrixXd& M) {
  return std::make_shared<const AffineMap>(M);
}

/// A cart with an input, two outputs of which one is an angle, and an affine jump map.
PlantDescription cart() {
  PlantDescription plant;
  plant.state_names = {"p", "v"};
  plant.input_names = {"u"};
  plant.sensors = {{"s", SensorTiming::kSampled, {false, true}}};
  PlantMode mode;
  Eigen::Matrix2d A;
  A << 0.0, 1.0, 0.0, 0.0;
  mode.flow =
      std::make_shared<const AffineMap>(A, Eigen::Vector2d(0.0, 1.0), Eigen::Vector2d::Zero());
  Eigen::Matrix2d A_d;
  A_d << 1.0, 0.0, 0.0, -0.5;
  mode.jump = std::make_shared<const AffineMap>(A_d, Eigen::MatrixXd::Zero(2, 0),
                                                Eigen::Vector2d(0.0, 0.25));
  mode.outputs = {matrix_map(Eigen::Vector2d(1.0, 2.0).asDiagonal())};
  plant.modes = {mode};
  return plant;
}

std::string fault(const PlantDescription& description) {
  try {
    const Plant plant(description);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(PlantTest, NamesThePartThatDoesNotFit) {
  EXPECT_EQ("", fault(cart()));
  PlantDescription plant = cart();
  plant.modes[0].outputs[0] = matrix_map(Eigen::MatrixXd::Zero(2, 3));
  EXPECT_NE(std::string::npos, fault(plant).find("the output map of sensor 's'"));
  plant = cart();
  plant.modes[0].jump = matrix_map(Eigen::MatrixXd::Zero(3, 2));
  EXPECT_NE(std::string::npos, fault(plant).find("the jump map"));
  plant = cart();
  plant.state_names.pop_back();
  EXPECT_NE(std::string::npos, fault(plant).find("the flow map"));
  plant = cart();
  plant.modes.push_back(plant.modes[0]);
  EXPECT_NE(std::string::npos, fault(plant).find("label"));
  plant = cart();
  plant.integration.step = 0;
  EXPECT_NE(std::string::npos, fault(plant).find("step"));
}

TEST(PlantTest, FindsModesByTheirLabels) {
  PlantDescription description = cart();
  description.modes.push_back(description.modes[0]);
  description.modes[0].label = 3;
  description.modes[1].label = 7;
  const Plant plant(description);
  EXPECT_TRUE(plant.switches());
  EXPECT_EQ(1u, *plant.find_mode(7.0));
  EXPECT_FALSE(plant.find_mode(4.0));
  EXPECT_FALSE(plant.find_mode(3.5));
}

TEST(PlantTest, OnlyAngularOutputsOfTheInnovationAreWrapped) {
  const Plant plant(cart());
  const double y[] = {10.0, 3.0};
  const double x[] = {1.0, -1.5};
  const double u[] = {0.0};
  double innovation[2];
  compute_innovation(plant, 0, 0, y, x, u, innovation);
  EXPECT_EQ(9.0, innovation[0]);
  EXPECT_NEAR(6.0 - 2.0 * kPi, innovation[1], 1e-15);
}

TEST(BiasStatesTest, AreConstantAddedToTheOutputAndLeftByJumps) {
  const Plant plant(with_bias_states(cart(), {{"b", 0, 1}}));
  ASSERT_EQ(3, plant.states());
  EXPECT_EQ("b", plant.state_names().back());
  const double x[] = {1.0, 2.0, 0.5};
  const double u[] = {3.0};
  double out[3];
  plant.modes()[0].flow->evaluate(x, u, out);
  EXPECT_EQ(Eigen::Vector3d(2.0, 3.0, 0.0), Eigen::Map<Eigen::Vector3d>(out));
  plant.modes()[0].jump->evaluate(x, u, out);
  EXPECT_EQ(Eigen::Vector3d(1.0, -0.75, 0.5), Eigen::Map<Eigen::Vector3d>(out));
  plant.modes()[0].outputs[0]->evaluate(x, u, out);
  EXPECT_EQ(Eigen::Vector2d(1.0, 4.5), Eigen::Map<Eigen::Vector2d>(out));
}

TEST(BiasStatesTest, ExtendAPlantThatIsNotAffineAsWell) {
  class Square : public VectorMap {
   public:
    Eigen::Index size() const override { return 2; }
    void evaluate(const double* x, const double*, double* out) const override {
      out[0] = x[0] * x[0];
      out[1] = x[1];
    }
  };
  PlantDescription description = cart();
  description.modes[0].flow = std::make_shared<const Square>();
  const Plant plant(with_bias_states(description, {{"b", 0, 0}}));
  EXPECT_FALSE(plant.is_affine());
  const double x[] = {3.0, 2.0, 0.5};
  const double u[] = {0.0};
  double out[3];
  plant.modes()[0].flow->evaluate(x, u, out);
  EXPECT_EQ(Eigen::Vector3d(9.0, 2.0, 0.0), Eigen::Map<Eigen::Vector3d>(out));
}

TEST(LinearPlantTest, IsAPlantOfOneModeWithSampledSensors) {
  LinearPlantDescription description;
  description.state_names = {"x"};
  description.A = Eigen::MatrixXd::Constant(1, 1, -2.0);
  description.B = Eigen::MatrixXd::Zero(1, 0);
  description.sensors = {{"s", Eigen::MatrixXd::Constant(1, 1, 3.0), {false}}};
  const auto plant = make_linear_plant(description);
  EXPECT_TRUE(plant->is_affine());
  EXPECT_FALSE(plant->jumps());
  const double x = 0.5;
  double out = 0.0;
  plant->modes()[0].flow->evaluate(&x, nullptr, &out);
  EXPECT_EQ(-1.0, out);
  plant->modes()[0].outputs[0]->evaluate(&x, nullptr, &out);
  EXPECT_EQ(1.5, out);
}

TEST(SensorTest, WrapsAnglesIntoTheHalfOpenTurn) {
  EXPECT_EQ(kPi, wrap_angle(kPi));
  EXPECT_EQ(kPi, wrap_angle(-kPi));
  EXPECT_NEAR(-kPi + 0.1, wrap_angle(kPi + 0.1), 1e-15);
  EXPECT_NEAR(0.25, wrap_angle(0.25 - 12 * kPi), 1e-14);
  EXPECT_EQ(0.0, wrap_angle(0.0));
}

}  // namespace
}  // namespace sampled_data_observers
