#include "config/gain_replacement.h"

#include <gtest/gtest.h>

#include "sampled_data_observers/config/yaml_file.h"
#include "sampled_data_observers/observer/plant_observer.h"
#include "sampled_data_observers/runtime/estimator.h"
#include "support/law_runner.h"
#include "support/stamps.h"
#include "support/type_examples.h"

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

const char kOnAGrid[] = R"(
observer: TimeVaryingGainObserver
gains:
  timers: {r: [0, 1], s: [0, 0.5]}
  P:
    0: [[2, 0, 0], [0, 2, 0], [0, 0, 1]]
    1: [[1, 0, 0], [0, 2, 0.1], [0, 0.1, 1]]
    2: [[1, 0.2, 0], [0.2, 2, 0], [0, 0, 1]]
    3: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
  K:
    r: {0: [[0.1, 0], [0, 0.1], [0, 0]], 1: [[0.2, 0], [0, 0.1], [0, 0]],
        2: [[0.3, 0], [0, 0.3], [0, 0.1]], 3: [[0.4, 0.1], [0, 0.5], [0, 0.1]]}
    s: {0: [[0.1], [0], [0]], 1: [[0.2], [0], [0]], 2: [[0.3], [0], [0.1]], 3: [[0.4], [0], [0.1]]}
)";

TEST(GainReplacementTest, GainsOfAnotherFormGoOnFromTheEstimateWithTimersOfZero) {
  using test::kSecond;
  using test::kStart;
  const ConfigNode base =
      read_yaml_file(std::string(SDO_SOURCE_DIR) + "/test/types/time_varying_gain.yaml");
  const ObserverConfig before = read_observer_config(base, no_plant_plugins);
  const ObserverConfig after = read_observer_config(
      replace_gains(base, read_yaml_text(kOnAGrid, "gains.yaml")), no_plant_plugins);
  EXPECT_EQ(2, after.law->observer().gains().find("timers/r")->value.cols());
  Estimator old_one(before.law, before.options);
  Estimator new_one(after.law, after.options);
  const auto sample = [](Estimator& estimator, Stamp stamp, const std::vector<double>& y) {
    const test::OwnedEvent event{stamp, EventKind::kSample, 0, y};
    EXPECT_TRUE(estimator.submit(event.view(), kStart + 9 * kSecond).used());
  };
  sample(old_one, kStart, {0.3, 0.4});
  sample(old_one, kStart + kSecond / 2, {0.7, -0.2});
  new_one.take_over(old_one, kStart + kSecond);
  sample(new_one, kStart + 5 * kSecond / 4, {0.1, 0.9});
  Estimate estimate = new_one.make_estimate();
  ASSERT_EQ(Timeline::Query::kOk, new_one.estimate_at(kStart + kSecond, estimate));
  test::LawRunner alone(after.law);
  alone.start_from(estimate.state.head(3));
  alone.flow(kSecond / 4);
  alone.sample(0, {0.1, 0.9});
  ASSERT_EQ(Timeline::Query::kOk, new_one.estimate_at(kStart + 5 * kSecond / 4, estimate));
  EXPECT_EQ(alone.estimate(), estimate.state.head(3));
}

}  // namespace
}  // namespace sampled_data_observers
