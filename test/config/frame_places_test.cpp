#include "sampled_data_observers/config/frame_places.h"

#include <gtest/gtest.h>

#include "sampled_data_observers/config/yaml_file.h"

namespace sampled_data_observers {
namespace {

ConfigNode tree(const std::string& parameters) {
  return read_yaml_text("plant: {states: [x], parameters: " + parameters + "}\n", "robot.yaml");
}

std::string fault_of(const std::string& parameters, const PlaceFinder& find) {
  try {
    with_places(tree(parameters), find);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

std::optional<Eigen::Vector3d> on_the_mast(const FramePlace&) {
  return Eigen::Vector3d(0.1, -2.0, 1e-17 + 3.0);
}

TEST(FramePlacesTest, EachStandsForThreeNumbers) {
  const ConfigNode read = tree("{a: 1, arm: {frame: base, child_frame: tip}}");
  const std::vector<FramePlace> places = frame_places(read);
  ASSERT_EQ(1u, places.size());
  EXPECT_EQ("arm", places[0].name);
  EXPECT_EQ("base", places[0].frame);
  EXPECT_EQ("tip", places[0].child_frame);
  EXPECT_EQ(10'000'000'000, places[0].timeout);
  const ConfigNode numbers = with_places(read, on_the_mast);
  const ConfigNode& parameters = *numbers.find("plant")->find("parameters");
  ASSERT_EQ(4u, parameters.entries.size());
  EXPECT_EQ(0.1, std::stod(parameters.find("arm_x")->scalar));
  EXPECT_EQ(-2.0, std::stod(parameters.find("arm_y")->scalar));
  EXPECT_EQ(3.0, std::stod(parameters.find("arm_z")->scalar));
  EXPECT_EQ("1", parameters.find("a")->scalar);
  EXPECT_TRUE(frame_places(read_yaml_text("observer: X\n", "none.yaml")).empty());
}

TEST(FramePlacesTest, WhatIsNotKnownOrNoneIsRefused) {
  const auto nowhere = [](const FramePlace&) { return std::optional<Eigen::Vector3d>(); };
  EXPECT_EQ(
      "robot.yaml:1: plant/parameters/arm: expected the place of tip in base, from "
      "static_transforms "
      "or /tf_static, found none in 2.5 s",
      fault_of("{arm: {frame: base, child_frame: tip, tf_timeout: 2.5}}", nowhere));
  const auto names = [](const std::string& fault, const std::string& part) {
    EXPECT_NE(std::string::npos, fault.find(part)) << fault;
  };
  names(fault_of("{arm: {frame: base}}", on_the_mast), "plant/parameters/arm/child_frame");
  names(fault_of("{arm: {frame: base, child_frame: tip, x: 1}}", on_the_mast),
        "plant/parameters/arm/x");
  names(fault_of("{arm: {frame: base, child_frame: tip}, arm_y: 1}", on_the_mast),
        "plant/parameters/arm_y");
}

}  // namespace
}  // namespace sampled_data_observers
