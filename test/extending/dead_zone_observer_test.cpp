#include "extending/dead_zone_observer.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sampled_data_observers/config/law_registry.h"
#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/config/yaml_file.h"
#include "support/law_runner.h"

namespace my_observers {
namespace {

using namespace sampled_data_observers;

ObserverConfig parse(const std::string& width) {
  return read_observer_config(read_yaml_text(R"(
observer: DeadZoneObserver
plant: {states: [x], A: [[0]]}
sensors: {s: {C: [[1]], source: {topic: s}}}
sampling: {T1: 0.1, T2: 1}
gains: {L: [[0.5]], width: )" + width + "}\n",
                                             "test.yaml"),
                              no_plant_plugins);
}

TEST(DeadZoneObserverTest, IsAnObserverTypeLikeTheOthers) {
  const std::vector<std::string> types = observer_types();
  EXPECT_NE(types.end(), std::find(types.begin(), types.end(), "DeadZoneObserver"));
  EXPECT_THROW(register_observer_type("DeadZoneObserver", nullptr), std::logic_error);
  EXPECT_THROW(parse("-1"), ConfigError);
  EXPECT_EQ(0.25, parse("0.25").law->observer().gains().find("width")->value(0, 0));
}

TEST(DeadZoneObserverTest, LeavesSmallInnovationsAloneAndShrinksLargeOnes) {
  test::LawRunner runner(parse("0.25").law);
  runner.sample(0, {0.25});
  EXPECT_EQ(0.0, runner.estimate()(0));
  runner.sample(0, {1.25});
  EXPECT_EQ(0.5, runner.estimate()(0));
  runner.sample(0, {-1.75});
  EXPECT_EQ(-0.5, runner.estimate()(0));
}

}  // namespace
}  // namespace my_observers
