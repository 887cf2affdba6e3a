#include "config/gain_replacement.h"

#include <gtest/gtest.h>

#include "sampled_data_observers/config/yaml_file.h"

namespace sampled_data_observers {
namespace {

ConfigNode replaced(const std::string& gain_file) {
  return replace_gains(
      read_yaml_text("{rate: 50, gains: {L: [[1]]}, certificate: {theorem: t}, sampling: {T1: 1}}",
                     "base.yaml"),
      read_yaml_text(gain_file, "gains.yaml"));
}

TEST(GainReplacementTest, TakesGainsAndCertificateOfTheFileAloneAndTheRestOfTheBase) {
  const ConfigNode tree = replaced("{observer: Type, gains: {K: [[2]]}}");
  EXPECT_EQ("50", tree.find("rate")->scalar);
  EXPECT_EQ("Type", tree.find("observer")->scalar);
  EXPECT_EQ(nullptr, tree.find("gains")->find("L"));
  EXPECT_NE(nullptr, tree.find("gains")->find("K"));
  EXPECT_EQ(nullptr, tree.find("certificate"));
  EXPECT_NE(nullptr, tree.find("sampling")->find("T1"));
}

TEST(GainReplacementTest, KeepsTheOutputInjectionWhereTheFileSaysNothingOfIt) {
  const ConfigNode base =
      read_yaml_text("{gains: {L_d: [[1]], output_injection: {x: level}}}", "base.yaml");
  const ConfigNode kept = replace_gains(base, read_yaml_text("{gains: {L_d: [[2]]}}", "a.yaml"));
  ASSERT_NE(nullptr, kept.find("gains")->find("output_injection"));
  EXPECT_EQ("level", kept.find("gains")->find("output_injection")->find("x")->scalar);
  EXPECT_EQ("2", kept.find("gains")->find("L_d")->items[0].items[0].scalar);
  const ConfigNode own = replace_gains(
      base, read_yaml_text("{gains: {L_d: [[2]], output_injection: {x: other}}}", "a.yaml"));
  EXPECT_EQ("other", own.find("gains")->find("output_injection")->find("x")->scalar);
}

TEST(GainReplacementTest, RefusesAFileThatSaysMoreOrNothing) {
  EXPECT_THROW(replaced("{gains: {}, rate: 10}"), ConfigError);
  EXPECT_THROW(replaced("{gains: {}, sensors: {}}"), ConfigError);
  EXPECT_THROW(replaced("{sampling: {T1: 2}}"), ConfigError);
}

}  // namespace
}  // namespace sampled_data_observers
