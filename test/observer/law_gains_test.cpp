// What a law says that it computes with is what the file says, whatever lies around it.
#include "sampled_data_observers/observer/law_gains.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/config/yaml_file.h"
#include "sampled_data_observers/observer/plant_observer.h"
#include "support/type_examples.h"

namespace sampled_data_observers::test {
namespace {

Eigen::MatrixXd value_of(const LawGains& gains, const std::string& symbol) {
  const LawGain* gain = gains.find(symbol);
  EXPECT_NE(nullptr, gain) << symbol;
  return gain == nullptr ? Eigen::MatrixXd() : gain->value;
}

TEST(LawGainsTest, AGainIsFoundByItsSymbolWhereItIsTheOnlyOne) {
  LawGains gains;
  gains.add("ell", 2.0).add("L/gps", Eigen::MatrixXd::Ones(2, 1));
  gains.add("L_d/1/gps", Eigen::MatrixXd::Zero(2, 1)).add("L_d/12/gps", Eigen::MatrixXd());
  EXPECT_EQ(2.0, value_of(gains, "ell")(0, 0));
  EXPECT_EQ(2, value_of(gains, "L").rows());
  EXPECT_EQ("L_d/1/gps", gains.find("L_d/1")->name);
  EXPECT_EQ(0, value_of(gains, "L_d/12").size());
  EXPECT_EQ(nullptr, gains.find("L_d"));
  EXPECT_EQ(nullptr, gains.find("H"));
  EXPECT_EQ(nullptr, gains.find("L_"));
}

class GainsOfTypeTest : public ::testing::TestWithParam<std::string> {};

/// A certificate that does not name one of them must object to it.
TEST_P(GainsOfTypeTest, EveryKeyOfTheFileIsAmongThem) {
  const LawGains gains = read_example(GetParam()).law->observer().gains();
  const ConfigNode tree =
      read_yaml_file(std::string(SDO_SOURCE_DIR) + "/test/types/" + GetParam() + ".yaml");
  for (const std::string& key : ConfigSection(tree, "").section("gains").keys()) {
    if (key == "form" || key == "definitions") continue;  // of T, Phi and Theta, which are listed
    if (key == "variant") {
      EXPECT_TRUE(gains.find("H") != nullptr || gains.find("variant") != nullptr);
    } else if (key == "theta0") {
      EXPECT_LT(0.0, gains.initial_injection);
    } else if (key == "output_injection") {
      EXPECT_FALSE(gains.output_injections.empty());
    } else {
      const auto is_it = [&](const LawGain& gain) { return is_named(gain.name, key); };
      EXPECT_TRUE(std::any_of(gains.all.begin(), gains.all.end(), is_it)) << key;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, GainsOfTypeTest, ::testing::ValuesIn(type_examples()));

TEST(LawGainsTest, TheyHaveTheSignsAndNumbersOfTheFile) {
  const LawGains held = read_example("sample_and_hold").law->observer().gains();
  ASSERT_EQ(1u, held.all.size());
  EXPECT_EQ("L/s", held.all.front().name);
  EXPECT_EQ(Eigen::MatrixXd(Eigen::Vector2d(-1.5, -0.4)), held.all.front().value);

  const LawGains injected = read_example("intersample_injection").law->observer().gains();
  EXPECT_EQ((Eigen::MatrixXd(2, 2) << -0.5, 0.1, 0, -0.3).finished(), value_of(injected, "H/b"));
  EXPECT_EQ(0.3, injected.initial_injection);
  EXPECT_EQ(nullptr, injected.find("L"));
}

}  // namespace
}  // namespace sampled_data_observers::test
