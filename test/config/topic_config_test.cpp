// Where events come from, as configurations say it.
#include "sampled_data_observers/config/topic_config.h"

#include <gtest/gtest.h>

#include "support/config_faults.h"

namespace sampled_data_observers {
namespace {

const char kSources[] = R"(
observer: ConstantGainObserver
plant:
  states: [p]
  inputs: [u]
  A: [[0]]
  B: [[1]]
  jump_map: {A_d: [[1]]}
sensors:
  wheel:
    C: [[1]]
    source: {topic: joints, type: sensor_msgs/JointState, fields: [position.wheel], min_interval: 0.25}
input: {topic: force, type: std_msgs/Float64, fields: [data], stamp: receipt}
jumps: {topic: contact, type: std_msgs/Header}
sampling: {T1: 0.1, T2: 0.2}
gains: {L: [[0.5]]}
)";

using test::Fault;
using test::fault;
using test::parse;
using test::replaced;

TEST(TopicConfigTest, ReadsSourcesOfStandardTypes) {
  const ObserverConfig config = parse(kSources);
  const TopicSource& sensor = *config.sensors[0];
  EXPECT_EQ("sensor_msgs/JointState", sensor.type);
  EXPECT_EQ(std::vector<std::string>{"position.wheel"}, sensor.fields);
  EXPECT_EQ(250'000'000, sensor.min_interval);
  EXPECT_FALSE(sensor.stamped_on_receipt);
  EXPECT_FALSE(sensor.of_jumps);
  ASSERT_EQ(1u, config.inputs.size());
  EXPECT_EQ("force", config.inputs[0].topic);
  EXPECT_EQ("std_msgs/Float64", config.inputs[0].type);
  EXPECT_TRUE(config.inputs[0].stamped_on_receipt);
  EXPECT_EQ("std_msgs/Header", config.jumps->type);
  EXPECT_TRUE(config.jumps->of_jumps);
  EXPECT_TRUE(config.jumps->fields.empty());
}

TEST(TopicConfigTest, SourcesHaveDefaults) {
  const std::string text =
      replaced(kSources, "type: std_msgs/Float64, fields: [data], stamp: receipt", "");
  const ObserverConfig config =
      parse(replaced(text, "jumps: {topic: contact, type: std_msgs/Header}", ""));
  EXPECT_EQ("sampled_data_observers/Input", config.inputs[0].type);
  EXPECT_FALSE(config.inputs[0].stamped_on_receipt);
  EXPECT_EQ("jumps", config.jumps->topic);
  EXPECT_EQ("sampled_data_observers/JumpEvent", config.jumps->type);
  EXPECT_EQ("test.yaml:2", config.jumps->origin);
}

TEST(TopicConfigTest, AJumpSourceReadsTheModeOfASwitchedPlantOnly) {
  EXPECT_NE(std::string::npos,
            fault(replaced(kSources, "std_msgs/Header", "std_msgs/Header, mode: x"))
                .find("jumps/mode: expected"));
}

TEST(TopicConfigTest, FaultsSayWhatIsExpected) {
  const std::vector<Fault> faults = {
      {"stamp: receipt", "stamp: now", {"input/stamp", "receipt", "'now'"}},
      {"min_interval: 0.25", "min_interval: -1", {"sensors/wheel/source/min_interval", "-1"}},
      {"std_msgs/Float64", "sampled_data_observers/Measurement", {"input/type", "Measurement"}},
      {"std_msgs/Header", "sampled_data_observers/Input", {"jumps/type", "JumpEvent or"}},
      {"sensor_msgs/JointState", "sampled_data_observers/Input", {"wheel/source/type", "Input"}},
      {"std_msgs/Header", "std_msgs/Header, fields: [x]", {"jumps/fields", "list of 0"}},
      {"std_msgs/Header", "std_msgs/Header, min_interval: 1", {"jumps/min_interval", "unknown"}},
  };
  for (const Fault& change : faults) {
    const std::string message = fault(replaced(kSources, change.from, change.to));
    EXPECT_EQ("", test::missing_parts(change, message)) << message;
  }
}

TEST(TopicConfigTest, CorrectionsAreForAllValuesOrForEach) {
  const std::string text = replaced(kSources, "min_interval: 0.25",
                                    "stamp_offset: -3.1, scale: 0.5, offset: [2], limits: [-1, 4]");
  const ObserverConfig config =
      parse(replaced(text, "type: std_msgs/Header", "type: std_msgs/Header, stamp_offset: 0.25"));
  const TopicSource& sensor = *config.sensors[0];
  EXPECT_EQ(-3'100'000'000, sensor.stamp_offset);
  EXPECT_EQ(Eigen::VectorXd::Constant(1, 0.5), sensor.correction.scale);
  EXPECT_EQ(Eigen::VectorXd::Constant(1, 2.0), sensor.correction.offset);
  ASSERT_EQ(1u, sensor.correction.limits.size());
  EXPECT_EQ(Eigen::Vector2d(-1.0, 4.0), sensor.correction.limits[0]);
  EXPECT_EQ(250'000'000, config.jumps->stamp_offset);
  const char* const own = "min_interval: 0.25";
  const std::vector<Fault> faults = {
      {own, "stamp_offset: 1e7", {"source/stamp_offset", "a number from"}},
      {own, "scale: 0", {"source/scale", "other than 0"}},
      {own, "scale: [1, 2]", {"source/scale", "a list of 1"}},
      {own, "offset: x", {"source/offset"}},
      {own, "limits: [4, -1]", {"source/limits", "lowest < highest"}},
      {own, "limits: [[0, 1], [0, 1]]", {"source/limits", "found 2 of them"}},
      {own, "limits: [1, 2, 3]", {"source/limits", "[lowest, highest]"}},
      {"type: std_msgs/Header", "type: std_msgs/Header, scale: 2", {"jumps/scale", "unknown"}},
  };
  for (const Fault& change : faults) {
    const std::string message = fault(replaced(kSources, change.from, change.to));
    EXPECT_EQ("", test::missing_parts(change, message)) << message;
  }
}

const char kInputs[] = R"(
observer: ConstantGainObserver
plant: {states: [p], inputs: [u, v, w], A: [[0]], B: [[1, 2, 3]]}
sensors: {s: {C: [[1]], source: {topic: s}}}
inputs:
  imu: {topic: imu, type: sensor_msgs/Imu, fields: {w: angular_velocity.z, u: linear_acceleration.x}}
  v: {topic: odom, type: nav_msgs/Odometry, fields: [twist.twist.linear.x], min_interval: 0.25}
sampling: {T1: 0.1, T2: 0.2}
gains: {L: [[0.5]]}
)";

TEST(TopicConfigTest, InputsMayComeFromSeveralTopics) {
  const ObserverConfig config = parse(kInputs);
  const std::vector<InputChannel>& channels = config.plant->input_channels();
  ASSERT_EQ(2u, channels.size());
  EXPECT_EQ("imu", channels[0].name);
  EXPECT_EQ((std::vector<Eigen::Index>{0, 2}), channels[0].inputs);
  EXPECT_EQ("v", channels[1].name);
  EXPECT_EQ((std::vector<Eigen::Index>{1}), channels[1].inputs);
  ASSERT_EQ(2u, config.inputs.size());
  // In the order of u, not of the map.
  EXPECT_EQ((std::vector<std::string>{"linear_acceleration.x", "angular_velocity.z"}),
            config.inputs[0].fields);
  EXPECT_EQ("odom", config.inputs[1].topic);
  EXPECT_EQ(250'000'000, config.inputs[1].min_interval);
}

TEST(TopicConfigTest, FaultsOfInputsSayWhatIsExpected) {
  const std::vector<Fault> faults = {
      {"  v: {", "  y: {", {"inputs/y", "an input of the plant (u, v, w)", "fields: {INPUT"}},
      {"w: angular", "ww: angular", {"inputs/imu/fields/ww", "(u, v, w)", "'ww'"}},
      {", u: linear_acceleration.x", "", {"inputs: expected a source of each input", "'u'"}},
      {"u: linear", "v: linear", {"inputs/v: expected each input in one", "imu has, too"}},
      {"fields: {w: angular_velocity.z, u: linear_acceleration.x}",
       "fields: {}",
       {"inputs/imu/fields: expected at least one input"}},
      {"  imu:", "  s:", {"inputs/s: expected a name that no other source"}},
      {"  imu:", "  jumps:", {"inputs/jumps: expected a name that no other source"}},
      {"inputs:\n", "input: {topic: all}\ninputs:\n", {"one of input", "both"}},
      {"inputs: [u, v, w], A: [[0]], B: [[1, 2, 3]]", "A: [[0]]", {"the plant has no inputs"}},
      {"topic: odom, ", "", {"inputs/v/topic"}},
      {"[twist.twist.linear.x]", "[a, b]", {"inputs/v/fields", "list of 1"}},
      {", min_interval", ", min_intervall", {"inputs/v/min_intervall", "unknown key"}},
  };
  for (const Fault& change : faults) {
    const std::string message = fault(replaced(kInputs, change.from, change.to));
    EXPECT_EQ("", test::missing_parts(change, message)) << message;
  }
}

const char kDetector[] = R"(
detector:
  source: {topic: imu, type: sensor_msgs/Imu, fields: {ax: linear_acceleration.x, w: angular_velocity.z}}
  signal: abs(ax) + 2*w
  threshold: 30
  hysteresis: 10
  direction: falling
  refractory: 0.5
)";

std::string detector_in_observer(const std::string& text) {
  return replaced(kSources, "{topic: contact, type: std_msgs/Header}", "\n" + text);
}

TEST(DetectorConfigTest, ReadsEveryKey) {
  const ConfigNode tree = read_yaml_text(kDetector, "test.yaml");
  const TopicSource source = read_detector_source(ConfigSection(tree, "").section("detector"));
  EXPECT_EQ("imu", source.topic);
  EXPECT_EQ("sensor_msgs/Imu", source.type);
  EXPECT_EQ((std::vector<std::string>{"linear_acceleration.x", "angular_velocity.z"}),
            source.fields);
  ASSERT_TRUE(source.detector.has_value());
  EXPECT_EQ(30.0, source.detector->options.threshold);
  EXPECT_EQ(10.0, source.detector->options.hysteresis);
  EXPECT_EQ(JumpDetector::Kind::kThreshold, source.detector->options.kind);
  EXPECT_EQ(JumpDetector::Direction::kFalling, source.detector->options.direction);
  EXPECT_EQ(500'000'000, source.detector->options.refractory);
  const double fields[] = {-3.0, 0.25};
  double signal = 0.0;
  source.detector->signal->evaluate(fields, nullptr, &signal);
  EXPECT_EQ(3.5, signal);
  EXPECT_EQ(nullptr, source.detector->outputs);
}

DetectorConfig read_kind(const std::string& keys) {
  const ConfigNode tree = read_yaml_text(
      "detector:\n  source: {topic: t, type: sensor_msgs/Imu, fields: {v: angular_velocity.z}}\n"
      "  signal: v\n" +
          keys,
      "test.yaml");
  return *read_detector_source(ConfigSection(tree, "").section("detector")).detector;
}

TEST(DetectorConfigTest, ReadsTheKeysOfEachKind) {
  using Kind = JumpDetector::Kind;
  const JumpDetector::Options threshold = read_kind("  kind: threshold\n  threshold: -1\n").options;
  EXPECT_EQ(Kind::kThreshold, threshold.kind);
  EXPECT_EQ(-1.0, threshold.threshold);
  EXPECT_EQ(0.0, threshold.noise_factor);
  const JumpDetector::Options deviation =
      read_kind("  kind: deviation\n  threshold: 2\n  noise: {factor: 8}\n  hysteresis: 1\n")
          .options;
  EXPECT_EQ(Kind::kDeviation, deviation.kind);
  EXPECT_EQ(8.0, deviation.noise_factor);
  EXPECT_EQ(500u, deviation.noise_samples);
  EXPECT_EQ(1.0, deviation.hysteresis);
  EXPECT_EQ(JumpDetector::Direction::kRising, deviation.direction);
  const JumpDetector::Options step =
      read_kind(
          "  kind: step\n  threshold: 2\n  window: 5\n  direction: either\n"
          "  noise: {factor: 7, samples: 100}\n")
          .options;
  EXPECT_EQ(Kind::kStep, step.kind);
  EXPECT_EQ(5u, step.window);
  EXPECT_EQ(7.0, step.noise_factor);
  EXPECT_EQ(100u, step.noise_samples);
  EXPECT_EQ(JumpDetector::Direction::kEither, step.direction);
  EXPECT_EQ(1u, read_kind("  kind: step\n  threshold: 2\n").options.window);
  const JumpDetector::Options guard =
      read_kind("  kind: guard\n  when: signal - 10*since\n").options;
  EXPECT_EQ(Kind::kGuard, guard.kind);
  const double arguments[] = {30.0, 2.0};
  double value = 0.0;
  guard.guard->evaluate(arguments, nullptr, &value);
  EXPECT_EQ(10.0, value);
}

TEST(DetectorConfigTest, ReadsEnergyAndMode) {
  const DetectorConfig detector = read_kind(
      "  threshold: 0\n  energy: {formula: v^2, at_least: 0.04}\n  mode: \"v > 0 ? 2 : 1\"\n");
  EXPECT_EQ(0.04, detector.options.least_energy);
  const double field = 3.0;
  double value = 0.0;
  detector.energy->evaluate(&field, nullptr, &value);
  EXPECT_EQ(9.0, value);
  detector.mode->evaluate(&field, nullptr, &value);
  EXPECT_EQ(2.0, value);
  EXPECT_EQ(nullptr, read_kind("  threshold: 0\n").energy);
  EXPECT_EQ(nullptr, read_kind("  threshold: 0\n").mode);
}

TEST(DetectorConfigTest, FaultsOfKindsSayWhatIsExpected) {
  struct {
    const char* keys;
    std::vector<const char*> message;
  } faults[] = {
      {"  kind: edge\n", {"detector/kind", "threshold, deviation, step, guard", "'edge'"}},
      {"  kind: step\n", {"detector/threshold", "missing"}},
      {"  kind: step\n  threshold: 0\n", {"detector/threshold", "above 0", "0"}},
      {"  kind: step\n  threshold: 1\n  window: 0\n", {"detector/window", "1 to 1000", "0"}},
      {"  kind: step\n  threshold: 1\n  hysteresis: 1\n", {"unknown key 'hysteresis'"}},
      {"  kind: step\n  threshold: 1\n  direction: up\n", {"detector/direction", "either"}},
      {"  kind: deviation\n  threshold: 1\n", {"detector/noise", "missing"}},
      {"  kind: deviation\n  threshold: 1\n  noise: {factor: 0}\n", {"noise/factor", "above 0"}},
      {"  kind: step\n  threshold: 1\n  noise: {factor: 1, samples: 5}\n", {"noise/samples", "20"}},
      {"  kind: step\n  threshold: 1\n  noise: {factor: 1, over: 5}\n", {"unknown key 'over'"}},
      {"  kind: guard\n  threshold: 1\n", {"detector/when", "missing"}},
      {"  kind: guard\n  when: v\n", {"detector/when", "v"}},
      {"  kind: guard\n  when: signal\n  threshold: 1\n", {"unknown key 'threshold'"}},
      {"  threshold: 1\n  noise: {factor: 7}\n", {"unknown key 'noise'"}},
      {"  threshold: 1\n  direction: either\n", {"detector/direction", "falling", "'either'"}},
      {"  threshold: 1\n  energy: {formula: w, at_least: 1}\n", {"energy/formula", "w"}},
      {"  threshold: 1\n  energy: {formula: v}\n", {"energy/at_least", "missing"}},
  };
  for (const auto& [keys, parts] : faults) {
    const std::string text = keys;
    const std::string message = test::fault_of([&] { read_kind(text); });
    EXPECT_EQ("", test::missing_parts({"", "", parts}, message)) << message;
  }
}

TEST(DetectorConfigTest, OutputsAreFormulasOfTheFields) {
  const ConfigNode tree =
      read_yaml_text(std::string(kDetector) + "  outputs: [0, ax - w]\n", "test.yaml");
  const TopicSource source = read_detector_source(ConfigSection(tree, "").section("detector"));
  const double fields[] = {-3.0, 0.25};
  double outputs[2];
  source.detector->outputs->evaluate(fields, nullptr, outputs);
  EXPECT_EQ(0.0, outputs[0]);
  EXPECT_EQ(-3.25, outputs[1]);
}

TEST(DetectorConfigTest, TheSameSectionStandsBelowTheJumpsOfAnObserver) {
  std::string text = kDetector;
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 3) {
    text.replace(at, 1, "\n  ");
  }
  const ObserverConfig config = parse(detector_in_observer(text));
  EXPECT_EQ("imu", config.jumps->topic);
  EXPECT_TRUE(config.jumps->of_jumps);
  EXPECT_EQ(30.0, config.jumps->detector->options.threshold);
  const std::string of_mode = fault(detector_in_observer(text + "  mode: 1\n"));
  for (const char* part : {"jumps/detector/mode", "one mode", "found one"}) {
    EXPECT_NE(std::string::npos, of_mode.find(part)) << of_mode;
  }
  const std::string message = fault(detector_in_observer(text + "  outputs: [1]\n"));
  for (const char* part : {"jumps/detector/outputs", "0 formulas", "found 1"}) {
    EXPECT_NE(std::string::npos, message.find(part)) << message;
  }
}

TEST(DetectorConfigTest, FaultsSayWhatIsExpected) {
  const std::vector<Fault> faults = {
      {"threshold: 30", "", {"detector/threshold", "missing"}},
      {"hysteresis: 10", "hysteresis: -1", {"detector/hysteresis", "-1"}},
      {"falling", "down", {"detector/direction", "falling", "'down'"}},
      {"2*w", "2*v", {"detector/signal", "v"}},
      {"refractory", "deadtime", {"detector/deadtime", "unknown key"}},
      {", type: sensor_msgs/Imu", "", {"detector/source/type", "missing"}},
      {"sensor_msgs/Imu", "sampled_data_observers/JumpEvent", {"source/type", "another package"}},
  };
  for (const Fault& change : faults) {
    const ConfigNode tree =
        read_yaml_text(replaced(kDetector, change.from, change.to), "test.yaml");
    const std::string message =
        test::fault_of([&] { read_detector_source(ConfigSection(tree, "").section("detector")); });
    EXPECT_EQ("", test::missing_parts(change, message)) << message;
  }
}

}  // namespace
}  // namespace sampled_data_observers
