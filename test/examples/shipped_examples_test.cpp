// Every file of config/examples is valid with its companions.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/config/yaml_file.h"
#include "support/example_run.h"

namespace sampled_data_observers::test {
namespace {

std::vector<std::string> directories() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(examples_folder())) {
    if (entry.is_directory()) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// The YAML files of an example whose names begin so.
std::vector<std::string> files(const std::string& example, const std::string& beginning) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(examples_folder() + example)) {
    const std::string name = entry.path().filename().string();
    if (name.compare(0, beginning.size(), beginning) == 0 && entry.path().extension() == ".yaml") {
      names.push_back(name);
    }
  }
  return names;
}

TEST(ShippedExamples, AreAllThere) { EXPECT_GE(directories().size(), 13u); }

/// Whether a file of gains is for an observer of the type that the file of settings is about, where
/// it says more of gains.
bool fits(const std::string& example, const std::string& gains, const std::string& observer) {
  const auto read = [&example](const std::string& file) {
    return read_yaml_file(examples_folder() + example + "/" + file);
  };
  if (read(observer).find("gains") == nullptr) return true;
  const auto type = [](const ConfigNode& tree) { return ConfigSection(tree, "").text("observer"); };
  return type(read(gains)) == type(read("gains.yaml"));
}

class ShippedExampleTest : public ::testing::TestWithParam<std::string> {};

TEST_P(ShippedExampleTest, EveryObserverIsValidWithEveryScenario) {
  const Example example(GetParam());
  const std::vector<std::string> scenarios = files(GetParam(), "scenario");
  const std::vector<std::string> observers = files(GetParam(), "observer");
  ASSERT_FALSE(scenarios.empty());
  const std::vector<std::string> gains = files(GetParam(), "gains");
  ASSERT_FALSE(observers.empty());
  ASSERT_FALSE(gains.empty());
  for (const std::string& scenario : scenarios) {
    EXPECT_NO_THROW(example.scenario(scenario)) << scenario;
    for (const std::string& observer : observers) {
      for (const std::string& file : gains) {
        if (!fits(GetParam(), file, observer)) continue;
        EXPECT_NO_THROW(Example(GetParam(), file).observer(scenario, observer))
            << scenario << " " << observer << " " << file;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedExampleTest, ::testing::ValuesIn(directories()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace sampled_data_observers::test
