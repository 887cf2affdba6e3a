#include "sampled_data_observers/config/observer_config.h"

#include <gtest/gtest.h>

#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/config/yaml_file.h"
#include "support/config_faults.h"

namespace sampled_data_observers {
namespace {

const char kGood[] = R"(
observer: ConstantGainObserver
plant:
  states: [p, v]
  inputs: [u]
  A: [[0, 1], [0, -0.5]]
  B: [[0], [1.5e0]]
  jump_map: {A_d: [[1, 0], [0, -0.8]], b_d: [0, 0.1]}
sensors:
  wheel: {C: [[0, 1]], source: {topic: wheel}}
  camera:
    C: [[1, 0], [0, 1]]
    angular: [true, false]
    bias: [c, ""]
    source: {topic: /camera, type: geometry_msgs/PointStamped, fields: [point.x, point.y]}
sampling: {T1: 0.05, T2: 0.2}
gains:
  L: {wheel: [[0], [0.5], [0]], camera: [[1, 0], [2, 0], [0.1, 0]]}
initial_estimate: {p: 1, v: -2, c: 3}
rate: 50
publish_delay: 0.01
history: {duration: 3, max_events: 70}
future_tolerance: 0.25
frame_id: map
real_time: {priority: 50, lock_memory: true}
reset_on_time_jump_back: true
jump_back_tolerance: 0.2
gains_directory: /gains
)";

using test::Fault;
using test::fault;
using test::parse;
using test::replaced;

TEST(ObserverConfigTest, ReadsEveryKey) {
  const ObserverConfig config = parse(kGood);
  const Plant& plant = *config.plant;
  const PlantMode& mode = plant.modes().front();
  EXPECT_EQ("ConstantGainObserver", config.type);
  EXPECT_EQ((std::vector<std::string>{"p", "v", "c"}), plant.state_names());
  EXPECT_EQ(-0.5, mode.flow->affine()->M()(1, 1));
  EXPECT_EQ(1.5, mode.flow->affine()->N()(1, 0));
  EXPECT_EQ(-0.8, mode.jump->affine()->M()(1, 1));
  EXPECT_EQ(0.1, mode.jump->affine()->c()(1));
  ASSERT_EQ(2u, plant.sensors().size());
  EXPECT_EQ("camera", plant.sensors()[0].name);  // sensors are in the order of their names
  EXPECT_EQ((std::vector<bool>{true, false}), plant.sensors()[0].angular);
  EXPECT_EQ(1.0, mode.outputs[0]->affine()->M()(0, 2));
  EXPECT_EQ("geometry_msgs/PointStamped", config.sensors[0]->type);
  EXPECT_EQ("sampled_data_observers/Measurement", config.sensors[1]->type);
  EXPECT_EQ("input", config.inputs[0].topic);
  EXPECT_EQ("jumps", config.jumps->topic);
  EXPECT_EQ(20000000, config.period);
  EXPECT_EQ(10000000, config.publish_delay);
  EXPECT_EQ(3 * kNanosecondsPerSecond, config.options.history.history);
  EXPECT_EQ(70u, config.options.history.max_events);
  EXPECT_EQ(50000000, config.options.sampling.of_sensor(1).T1);
  EXPECT_EQ(250000000, config.options.future_tolerance);
  EXPECT_EQ("map", config.frame_id);
  EXPECT_EQ(50, config.real_time.priority);
  EXPECT_TRUE(config.real_time.lock_memory);
  EXPECT_TRUE(config.reset_on_time_jump_back);
  EXPECT_EQ(200000000, config.jump_back_tolerance);
  EXPECT_EQ("/gains", config.gains_directory);
  Eigen::VectorXd state(config.law->state_size());
  config.law->initialize(state.data());
  EXPECT_EQ(Eigen::Vector3d(1.0, -2.0, 3.0), state.head(3));
}

TEST(ObserverConfigTest, TakesTimesBetweenSamplesWithoutBounds) {
  const ObserverConfig config = parse(replaced(kGood, "{T1: 0.05, T2: 0.2}", "{T1: 0, T2: .inf}"));
  EXPECT_EQ(0, config.options.sampling.of_sensor(1).T1);
  EXPECT_EQ(kNoLongestTime, config.options.sampling.of_sensor(1).T2);
}

TEST(ObserverConfigTest, FaultsThatHaveNothingToDoWithEachOtherAreToldAtOnce) {
  const std::string text = fault(R"(
observer: ConstantGainObserver
plant: {states: [x], inputs: [u], A: [[0]], B: [[1]]}
sensors:
  a: {C: [[1]], source: {topc: a}}
  b: {C: [[1]], source: {topic: b, stamp: never, min_interval: -1}}
input: {fields: [a, b]}
sampling: {T1: 1, T2: 0.1}
gains: {L: [[0.5]]}
rate: never
history: {duration: 0, maxevents: 3}
)");
  for (const char* part :
       {"test.yaml:5: sensors/a/source/topic: expected", "is 'topc' a misspelling of it?",
        "test.yaml:6: sensors/b/source/stamp", "input/fields: expected", "sampling/T2: expected",
        "gains/L", "rate: expected", "history/duration: expected"}) {
    EXPECT_NE(std::string::npos, text.find(part)) << part << " | " << text;
  }
  const std::string plant = fault(R"(
observer: ConstantGainObserver
plant: {states: [x], inputs: [u], A: [[0, 1]], B: [[1]], integration: {step: never}}
sensors:
  a: {C: [[1, 2]], source: {topic: a}}
  b: {h: [y], source: {topic: b}}
inputs: {w: {topic: b}}
)");
  for (const char* part : {"plant/A: expected", "plant/integration/step: expected",
                           "sensors/a/C: expected", "sensors/b/h", "inputs"}) {
    EXPECT_NE(std::string::npos, plant.find(part)) << part << " | " << plant;
  }
  const std::string ends = fault(replaced(
      replaced(kGood, "wheel: {C: [[0, 1]],", "wheel: {C: [[0, 1]], gate: {innovation: [-1]},"),
      "frame_id: map", "frame_id: map\noutputs: {position: {x: nowhere}}"));
  for (const char* part : {"sensors/wheel/gate", "outputs/"}) {
    EXPECT_NE(std::string::npos, ends.find(part)) << part << " | " << ends;
  }
  const std::string keys = fault(replaced(kGood, "frame_id: map", "frameid: map\nstrt: 1\nrat: 2"));
  for (const char* part :
       {"the unknown key 'frameid'; is it a misspelling of 'frame_id'?",
        "the unknown key 'strt'; is it a misspelling of 'start'?", "the unknown key 'rat'"}) {
    EXPECT_NE(std::string::npos, keys.find(part)) << part << " | " << keys;
  }
}

TEST(ObserverConfigTest, OptionalKeysHaveDefaults) {
  const ObserverConfig config = parse(R"(
observer: ConstantGainObserver
plant: {states: [x], A: [[0]]}
sensors: {s: {C: [[1]], source: {topic: s}}}
sampling: {T1: 0.1, T2: 0.1}
gains: {L: [[0.5]]}
)");
  EXPECT_EQ(10000000, config.period);
  EXPECT_EQ(0, config.publish_delay);
  EXPECT_EQ(2 * kNanosecondsPerSecond, config.options.history.history);
  EXPECT_EQ(2000u, config.options.history.max_events);
  EXPECT_EQ(500000000, config.options.future_tolerance);
  EXPECT_FALSE(config.publish_on_event);
  EXPECT_FALSE(config.real_time.priority);
  EXPECT_FALSE(config.real_time.lock_memory);
  EXPECT_FALSE(config.reset_on_time_jump_back);
  EXPECT_EQ(kNanosecondsPerSecond, config.jump_back_tolerance);
  EXPECT_EQ("", config.gains_directory);
  EXPECT_TRUE(config.inputs.empty());
  EXPECT_FALSE(config.jumps);
}

TEST(ObserverConfigTest, EstimatesBeginWhereTheyAreToBegin) {
  const std::string at = "start: {at: ";
  EXPECT_EQ(from_seconds(12.5), parse(kGood + (at + "12.5}")).options.start);
  EXPECT_EQ(std::nullopt, parse(kGood + (at + "first_event}")).options.start);
  EXPECT_EQ(std::nullopt, parse(kGood).options.start);
  for (const char* bad : {"0", "-1", "5e9", "now", "[1]"}) {
    const std::string found = fault(kGood + (at + bad + "}"));
    EXPECT_NE(std::string::npos, found.find("start/at")) << found;
  }
}

class BadConfigTest : public ::testing::TestWithParam<Fault> {};

TEST_P(BadConfigTest, IsRefusedWithAMessageThatHelps) {
  const std::string found = fault(replaced(kGood, GetParam().from, GetParam().to));
  EXPECT_EQ("", test::missing_parts(GetParam(), found)) << found;
}

INSTANTIATE_TEST_SUITE_P(
    Faults, BadConfigTest,
    ::testing::Values(
        Fault{"rate: 50", "rat: 50", {"test.yaml:20", "rat", "unknown key 'rat'", "rate"}},
        Fault{"inputs: [u]", "input: [u]", {"plant/inputs", "missing"}},
        Fault{"A: [[0, 1], [0, -0.5]]", "A: [[0, 1]]", {"plant/A", "2 x 2", "1 x 2"}},
        Fault{"A: [[0, 1], [0, -0.5]]", "A: [[0, 1], [0]]", {"plant/A", "row 2"}},
        Fault{"A: [[0, 1], [0, -0.5]]", "A: [0, 1]", {"plant/A", "list of rows"}},
        Fault{"A: [[0, 1], [0, -0.5]]", "A: [[0, 1], [0, .nan]]", {"plant/A", "'.nan'", "finite"}},
        Fault{"A: [[0, 1], [0, -0.5]]", "A: [[0, 1], [0, 1e999]]", {"plant/A", "'1e999'"}},
        Fault{"A: [[0, 1], [0, -0.5]]", "A: [[0, 1], [0, 010]]", {"plant/A", "'010'"}},
        Fault{"B: [[0], [1.5e0]]", "B: [[0, 0], [1, 0]]", {"plant/B", "2 x 1", "2 x 2"}},
        Fault{"states: [p, v]", "states: [p, p]", {"plant/states", "'p' twice"}},
        Fault{"states: [p, v]", "states: []", {"plant/states", "at least one"}},
        Fault{"b_d: [0, 0.1]", "b_d: [0]", {"plant/jump_map/b_d", "list of 2"}},
        Fault{"{C: [[0, 1]]", "{C: [[0, 1, 2]]", {"sensors/wheel/C", "m x 2"}},
        Fault{"source: {topic: wheel}", "surce: {topic: wheel}", {"sensors/wheel/source"}},
        Fault{"{topic: wheel}", "{topic: wheel, hz: 3}", {"sensors/wheel/source/hz", "unknown"}},
        Fault{"angular: [true, false]", "angular: [true]", {"sensors/camera/angular", "list of 2"}},
        Fault{"angular: [true, false]", "angular: [1, 0]", {"sensors/camera/angular", "'1'"}},
        Fault{"bias: [c, \"\"]", "bias: [v, \"\"]", {"sensors/camera/bias", "'v'"}},
        Fault{"fields: [point.x, point.y]", "fields: [point.x]", {"camera/source/fields", "2"}},
        Fault{"T1: 0.05", "T1: -1", {"sampling/T1", "found -1"}},
        Fault{"T1: 0.05", "T1: 0.3", {"sampling/T2", "not less than T1"}},
        Fault{"T1: 0.05", "T1: fast", {"sampling/T1", "a finite number", "'fast'"}},
        Fault{
            "wheel: [[0], [0.5], [0]]", "wheel: [[0], [0.5]]", {"gains/L/wheel", "3 x 1", "2 x 1"}},
        Fault{"wheel: [[0], [0.5], [0]], ", "", {"gains/L/wheel", "missing"}},
        Fault{"wheel: [[0], [0.5], [0]]",
              "wheel: [[0], [0.5], [0]], gps: [[1]]",
              {"gains/L/gps", "unknown"}},
        Fault{"ConstantGainObserver", "ConstantGain", {"observer", "ConstantGainObserver"}},
        Fault{"v: -2, ", "", {"initial_estimate/v", "missing"}},
        Fault{"rate: 50", "rate: 0", {"rate", "found 0"}},
        Fault{"max_events: 70", "max_events: 7.5", {"history/max_events", "whole number"}},
        Fault{"duration: 3", "duration: 0", {"history/duration"}},
        Fault{"publish_delay: 0.01", "publish_delay: -0.01", {"publish_delay", "-0.01"}},
        Fault{"future_tolerance: 0.25", "future_tolerance: .inf", {"future_tolerance", "'.inf'"}},
        Fault{"rate: 50", "rate: 50\nrate: 60", {"test.yaml:21", "rate", "each key once"}},
        Fault{"rate: 50", "rate: 50\npublish_on_event: true", {"publish_on_event", "delay"}},
        Fault{"publish_delay: 0.01", "publish_delay: 3", {"publish_delay", "history/duration"}},
        Fault{"future_tolerance: 0.25", "future_tolerance: 3", {"future_tolerance", "history"}},
        Fault{"{topic: wheel}",
              "{topic: wheel, type: sampled_data_observers/JumpEvent}",
              {"sensors/wheel/source/type", "JumpEvent"}},
        Fault{"rate: 50", "rate: [50", {"test.yaml:", "valid YAML"}}));

TEST(ConfigNumberTest, AreDecimalAndNothingElse) {
  const auto value = [](const std::string& text) {
    const ConfigNode node = read_yaml_text("number: " + text, "x");
    return ConfigSection(node, "").number("number");
  };
  EXPECT_EQ(-1.0, value("-1"));
  EXPECT_EQ(0.5, value("+.5"));
  EXPECT_EQ(2.0, value("2."));
  EXPECT_EQ(1e-3, value("1e-3"));
  EXPECT_EQ(0.25, value("0.25"));
  EXPECT_EQ(0.1 + 0.2, value("0.30000000000000004"));
  EXPECT_EQ(0.0, value("1e-999"));
  for (const char* text : {"1e", "e1", ".", "-", "1 2", "0x10", "1_000", "007", "-01", "nan",
                           ".inf", "1e999", "true", "~", "1.0.0", "1,5"}) {
    EXPECT_THROW(value(text), ConfigError) << text;
  }
}

TEST(ConfigFilesTest, AreMergedKeyByKey) {
  const ConfigNode plant = read_yaml_text("plant: {states: [x]}\ngains: {H: 1}", "plant.yaml");
  const ConfigNode gains = read_yaml_text("gains: {L: 2}", "gains.yaml");
  const ConfigNode merged = merge({plant, gains});
  EXPECT_EQ("2", merged.find("gains")->find("L")->scalar);
  EXPECT_EQ("1", merged.find("gains")->find("H")->scalar);
  EXPECT_EQ("gains.yaml:1", merged.find("gains")->find("L")->origin);
}

TEST(ConfigFilesTest, AKeyInTwoOfThemIsAFault) {
  const ConfigNode one = read_yaml_text("gains:\n  L: 1", "one.yaml");
  const ConfigNode two = read_yaml_text("gains: {L: 1}", "two.yaml");
  try {
    merge({one, two});
    FAIL();
  } catch (const ConfigError& error) {
    const std::string message = error.what();
    for (const char* part : {"two.yaml:1", "gains/L", "one.yaml:2"}) {
      EXPECT_NE(std::string::npos, message.find(part)) << message;
    }
  }
}

TEST(ConfigFilesTest, TogetherHaveNoMoreKeysThanOne) {
  const auto numbered = [](char prefix, int count) {
    std::string text = "plant: {";
    for (int i = 0; i < count; ++i) text += prefix + std::to_string(i) + ": 1, ";
    return read_yaml_text(text + "}", std::string(1, prefix));
  };
  EXPECT_NO_THROW(merge({numbered('a', 500), numbered('b', 500)}));
  try {
    merge({numbered('a', 500), numbered('b', 501)});
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ("b:1: plant: expected at most 1000 keys in a map, found more", error.what());
  }
}

TEST(ConfigFilesTest, OverridesReplaceSingleKeys) {
  const ConfigNode base = read_yaml_text("rate: 1\nhistory: {duration: 2, max_events: 3}", "a");
  const ConfigNode over = read_yaml_text("rate: 7\nhistory: {duration: 8}", "b");
  const ConfigNode result = override_with(base, over);
  EXPECT_EQ("7", result.find("rate")->scalar);
  EXPECT_EQ("8", result.find("history")->find("duration")->scalar);
  EXPECT_EQ("3", result.find("history")->find("max_events")->scalar);
}

TEST(ConfigFilesTest, UnreadableFilesAreFaults) {
  for (const char* path : {"/nonexistent/a.yaml", "/"}) {
    EXPECT_THROW(read_yaml_file(path), ConfigError) << path;
  }
  for (const char* text : {"", "[1, 2]", "a: 1\n---\nb: 2", "{[1]: 2}"}) {
    EXPECT_THROW(read_yaml_text(text, "x"), ConfigError) << text;
  }
  std::string deep;
  for (int i = 0; i < 100; ++i) deep += "[";
  EXPECT_THROW(read_yaml_text("a: " + deep + std::string(100, ']'), "x"), ConfigError);
}

TEST(ShippedConfigTest, TheShippedConfigurationsAreValid) {
  const std::string folder = std::string(SDO_SOURCE_DIR) + "/config/";
  for (const char* name : {"crazyflie_position", "crazyflie_inertial", "husky_gps", "husky_pose",
                           "planar_robot", "spatial_robot"}) {
    EXPECT_NO_THROW(
        read_observer_config(std::vector<std::string>{folder + name + ".yaml"}, no_plant_plugins))
        << name;
  }
}

TEST(ShippedConfigTest, TheUnicyclesTwistIsItsInput) {
  const std::string file = std::string(SDO_SOURCE_DIR) + "/config/husky_unicycle.yaml";
  const ObserverConfig config =
      read_observer_config(std::vector<std::string>{file}, no_plant_plugins);
  ASSERT_TRUE(config.outputs);
  EXPECT_EQ(0, *config.outputs->body.linear_velocity[0].input);
  EXPECT_EQ(1, *config.outputs->body.angular_velocity[2].input);
}

}  // namespace
}  // namespace sampled_data_observers
