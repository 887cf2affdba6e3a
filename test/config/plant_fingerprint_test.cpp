#include "config/plant_fingerprint.h"

#include <gtest/gtest.h>

#include "sampled_data_observers/config/yaml_file.h"

namespace sampled_data_observers {
namespace {

std::string fingerprint(const std::string& sensors) {
  return plant_fingerprint(
      read_yaml_text("plant: {A: [[-1]]}\nsensors: " + sensors + "\n", "test.yaml"));
}

TEST(PlantFingerprintTest, WaysOfWritingDoNotMatter) {
  EXPECT_EQ(fingerprint("{a: {C: [[1]]}}"), fingerprint("{'a': {C: [[1.0]], gate: {}}}"));
}

TEST(PlantFingerprintTest, WhenASensorMeasuresIsNoPartOfThePlant) {
  EXPECT_EQ(fingerprint("{a: {C: [[1]]}}"),
            fingerprint("{a: {C: [[1]], sampling: {T1: 1, T2: 2}}}"));
}

TEST(PlantFingerprintTest, WhereThePlantJumpsIsNoPartOfWhatIsProved) {
  const auto of_plant = [](const std::string& plant) {
    return plant_fingerprint(read_yaml_text("plant: " + plant + "\nsensors: {}\n", "test.yaml"));
  };
  EXPECT_EQ(of_plant("{A: [[-1]]}"), of_plant("{A: [[-1]], jump_set: [x], flow_set: [-x]}"));
  EXPECT_EQ(of_plant("{A: [[-1]]}"), of_plant("{A: [[-1]], units: {x: m}}"));
  EXPECT_EQ(of_plant("{modes: {1: {A: [[-1]]}}}"),
            of_plant("{modes: {1: {A: [[-1]], jump_set: [x], flow_set: [-x]}}}"));
}

TEST(PlantFingerprintTest, NoNameWithQuotesPassesForSeveral) {
  EXPECT_NE(fingerprint("{a: {C: [[1]]}, b: {C: [[2]]}}"),
            fingerprint("{\"a':{'C':[[1,],],}'b\": {C: [[2]]}}"));
}

}  // namespace
}  // namespace sampled_data_observers
