#include "replay/comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "plant/linear_plant.h"

namespace sampled_data_observers {
namespace {

const Comparison::Bounds kNone = {};

std::shared_ptr<const Plant> plant() {
  LinearPlantDescription description;
  description.state_names = {"p", "v", "yaw"};
  description.A = Eigen::MatrixXd::Zero(3, 3);
  description.B = Eigen::MatrixXd::Zero(3, 0);
  Eigen::MatrixXd C(3, 3);
  C << 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0;
  description.sensors = {{"s", C, {false, true, false}}};
  return make_linear_plant(description);
}

TEST(ComparisonTest, QuantitiesAreNamedAfterTheStatesTheyMeasure) {
  EXPECT_EQ("p", output_quantity(*plant(), 0, 0)->name);
  EXPECT_EQ("yaw", output_quantity(*plant(), 0, 1)->name);
  EXPECT_TRUE(output_quantity(*plant(), 0, 1)->angular);
  EXPECT_EQ("s[2]", output_quantity(*plant(), 0, 2)->name);
  EXPECT_FALSE(state_quantity(*plant(), "nothing"));
}

/// A pressure, 101325 - 12 z, is measured.
std::shared_ptr<const Plant> plant_with_offset() {
  LinearPlantDescription description;
  description.state_names = {"z"};
  description.A = Eigen::MatrixXd::Zero(1, 1);
  description.B = Eigen::MatrixXd::Zero(1, 0);
  description.sensors = {{"pressure", Eigen::MatrixXd::Ones(1, 1), {false}}};
  const std::shared_ptr<const Plant> plain = make_linear_plant(description);
  PlantDescription with_offset;
  with_offset.state_names = plain->state_names();
  with_offset.sensors = plain->sensors();
  with_offset.modes = plain->modes();
  with_offset.modes.front().outputs.front() = std::make_shared<const AffineMap>(
      Eigen::MatrixXd::Constant(1, 1, -12.0), Eigen::MatrixXd::Zero(1, 0),
      Eigen::VectorXd::Constant(1, 101325.0));
  return std::make_shared<const Plant>(with_offset);
}

TEST(ComparisonTest, AnOutputWithAnOffsetIsComparedAsItIsMeasured) {
  const std::shared_ptr<const Plant> plant = plant_with_offset();
  const Quantity quantity = *output_quantity(*plant, 0, 0);
  EXPECT_EQ("pressure[0]", quantity.name);
  EXPECT_FALSE(measures(*plant, 0, 0, *state_quantity(*plant, "z")));
  const double x[] = {10.0};
  EXPECT_EQ(101205.0, quantity.value(x));
  Comparison comparison({quantity}, plant);
  const double y[] = {101201.0};
  comparison.add_sample(0, 100, y);
  comparison.add_truth({101202.0}, x, kNone);
  EXPECT_EQ(3.0, comparison.rmse()[0]);
  EXPECT_EQ(1.0, comparison.hold_rmse()[0]);
}

TEST(ComparisonTest, TakesRootMeanSquaresOfEstimateAndHeldSample) {
  Comparison comparison({*state_quantity(*plant(), "p"), *state_quantity(*plant(), "yaw")},
                        plant());
  const double x[] = {1.0, 7.0, 3.0};
  comparison.add_truth({9.0, 9.0}, x, kNone);  // nothing sampled yet: not compared
  EXPECT_EQ(0u, comparison.size());
  EXPECT_FALSE(comparison.rmse()[0]);
  const double y[] = {2.0, -3.0, 0.0};
  comparison.add_sample(0, 100, y);
  const double older[] = {50.0, 1.0, 0.0};
  comparison.add_sample(0, 90, older);
  comparison.add_truth({4.0, -3.0}, x, kNone);
  comparison.add_truth({5.0, -3.0}, x, kNone);
  EXPECT_EQ(2u, comparison.size());
  EXPECT_EQ(0u, comparison.bound_check().stamps);
  EXPECT_DOUBLE_EQ(std::sqrt((9.0 + 16.0) / 2.0), *comparison.rmse()[0]);
  EXPECT_DOUBLE_EQ(std::sqrt((4.0 + 9.0) / 2.0), *comparison.hold_rmse()[0]);
  EXPECT_NEAR(2.0 * 3.14159265358979323846 - 6.0, *comparison.rmse()[1], 1e-14);
  EXPECT_DOUBLE_EQ(0.0, *comparison.hold_rmse()[1]);
  EXPECT_DOUBLE_EQ(std::hypot(*comparison.rmse()[0], *comparison.rmse()[1]),
                   *Comparison::norm(comparison.rmse()));
}

TEST(ComparisonTest, CountsWhereTheErrorExceedsItsBound) {
  Comparison comparison({*state_quantity(*plant(), "p"), *output_quantity(*plant(), 0, 2)},
                        plant());
  const double y[] = {2.0, -3.0, 0.0};
  comparison.add_sample(0, 100, y);
  const double x[] = {1.0, 7.0, 3.0};
  // What is compared, p and p + v, is at most 1.618 times as large as the state.
  const double weight = (1.0 + std::sqrt(5.0)) / 2.0;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  comparison.add_truth({4.0, 12.0}, x, {kInfinity, Eigen::Vector3d::Constant(kInfinity)});
  comparison.add_truth({4.0, 12.0}, x, {5.01 / weight, Eigen::Vector3d(3.01, 1.0, kInfinity)});
  EXPECT_EQ(1u, comparison.bound_check().stamps);
  EXPECT_EQ(0u, comparison.bound_check().exceeded);
  EXPECT_NEAR(5.0 / 5.01, *comparison.bound_check().share, 1e-12);
  comparison.add_truth({4.0, 12.0}, x, {4.99 / weight, Eigen::Vector3d(2.5, 1.4, 0.0)});
  EXPECT_EQ(2u, comparison.bound_check().stamps);
  EXPECT_EQ(1u, comparison.bound_check().exceeded);
  // p was off by 3 and p + v by 4.
  const Comparison::BoundCheck& of_p = comparison.bound_checks()[0];
  EXPECT_EQ(2u, of_p.stamps);
  EXPECT_EQ(1u, of_p.exceeded);
  EXPECT_DOUBLE_EQ(3.0 / 2.5, *of_p.share);
  const Comparison::BoundCheck& of_sum = comparison.bound_checks()[1];
  EXPECT_EQ(2u, of_sum.stamps);
  EXPECT_EQ(1u, of_sum.exceeded);
  EXPECT_DOUBLE_EQ(4.0 / 3.9, *of_sum.share);
}

TEST(ComparisonTest, WhatNoSensorMeasuresHasNoHeldSample) {
  Comparison comparison({*state_quantity(*plant(), "v")}, plant());
  const double x[] = {1.0, 7.0, 3.0};
  comparison.add_truth({6.0}, x, kNone);
  EXPECT_DOUBLE_EQ(1.0, *comparison.rmse()[0]);
  EXPECT_FALSE(comparison.hold_rmse()[0]);
  EXPECT_FALSE(Comparison::norm(comparison.hold_rmse()));
}

}  // namespace
}  // namespace sampled_data_observers
