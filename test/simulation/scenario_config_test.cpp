#include "simulation/scenario_config.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "simulation/simulation_support.h"
#include "support/config_faults.h"

namespace sampled_data_observers {
namespace {

const char kGood[] = R"yaml(
plant:
  states: [p, v]
  inputs: [u]
  parameters: {g: 9.81}
  modes:
    1: {A: [[0, 1], [0, 0]], B: [[0], [1]], jump_map: {A_d: [[1, 0], [0, -0.8]]}}
    2: {A: [[0, 1], [-1, 0]], B: [[0], [1]]}
sensors:
  impact: {C: [[0, 1]], measured: at_jumps}
  radar: {C: [[1, 0]], measured: continuous, source: {topic: radar}}
  wheel: {C: [[0, 1]], source: {topic: wheel}}
input: {topic: force}
jumps: {topic: bumps, late: rewind, gate: {read: by the observer}, missing: {}, rest: {}, dwell_time: [0, 1], average_dwell_time: {}, reverse_average_dwell_time: {}}
gains: {read: by the observer}
scenario:
  duration: 20
  start: 500
  seed: 7
  initial_state: {p: 1, v: 2}
  initial_mode: 2
  truth: {topic: real, rate: 50}
  input: {rate: 10, formulas: {u: "sin(t) - p * g"}}
  disturbance: {N: [[0], [1]], formulas: ["t <= 5 ? -1 : 1"]}
  sensors:
    impact: {noise: {gaussian: 0.5}}
    radar: {schedule: {period: 0.01}, noise: {formulas: ["0.2*sin(1000*t)"]}}
    wheel:
      schedule: {uniform: [0.1, 0.2]}
      noise: {uniform: 0.1}
      latency: [0.01, 0.05]
      loss: 0.1
      duplication: 0.2
      reordering: 0.3
  jumps:
    when: "p - 30"
    modes: [1, 2]
    min_separation: 0.001
    rest: {v: "p - g"}
    stamp_error: 0.002
    missed: 0.1
    duplicate: 0.2
    false_rate: 0.5
    latency: [0, 0.02]
)yaml";

std::string fault(const std::string& text) {
  return test::fault_of([&] { test::parse_scenario(text); });
}

TEST(ScenarioConfigTest, ReadsEveryKey) {
  const Scenario scenario = test::parse_scenario(kGood);
  EXPECT_EQ(20 * kNanosecondsPerSecond, scenario.duration);
  EXPECT_EQ(500 * kNanosecondsPerSecond, scenario.start);
  EXPECT_EQ(7u, scenario.seed);
  EXPECT_EQ(Eigen::Vector2d(1.0, 2.0), scenario.initial_state);
  EXPECT_EQ(1u, scenario.initial_mode);
  EXPECT_EQ("real", scenario.truth_topic);
  EXPECT_EQ(20000000, scenario.truth_period);
  ASSERT_TRUE(scenario.input);
  ASSERT_EQ(1u, scenario.input->sources.size());
  EXPECT_EQ("force", scenario.input->sources[0].topic);
  EXPECT_EQ(100000000, scenario.input->period);
  const double arguments[] = {0.0, 2.0, 0.0};  // t, p, v
  double u = 0.0;
  scenario.input->formulas->evaluate(arguments, nullptr, &u);
  EXPECT_EQ(-2.0 * 9.81, u);
  ASSERT_TRUE(scenario.disturbance);
  EXPECT_EQ(1.0, scenario.disturbance->N(1, 0));
  ASSERT_EQ(3u, scenario.sensors.size());
  EXPECT_FALSE(scenario.sensors[0].source);
  EXPECT_FALSE(scenario.sensors[0].schedule);
  EXPECT_EQ(Noise::Kind::kGaussian, scenario.sensors[0].noise.kind);
  EXPECT_EQ(Schedule::Kind::kPeriodic, scenario.sensors[1].schedule->kind);
  EXPECT_EQ(Noise::Kind::kFormulas, scenario.sensors[1].noise.kind);
  const SensorScenario& wheel = scenario.sensors[2];
  ASSERT_TRUE(wheel.source);
  EXPECT_EQ("wheel", wheel.source->topic);
  EXPECT_EQ(100000000, wheel.schedule->T1);
  EXPECT_EQ(200000000, wheel.schedule->T2);
  EXPECT_EQ(Eigen::VectorXd::Constant(1, 0.1), wheel.noise.size);
  EXPECT_EQ(10000000, wheel.delivery.shortest);
  EXPECT_EQ(50000000, wheel.delivery.longest);
  EXPECT_EQ(0.1, wheel.delivery.loss);
  EXPECT_EQ(0.2, wheel.delivery.duplication);
  EXPECT_EQ(0.3, wheel.delivery.reordering);
  ASSERT_TRUE(scenario.jumps);
  EXPECT_EQ("bumps", scenario.jumps_source.topic);
  EXPECT_NE(nullptr, scenario.jumps->guard);
  EXPECT_EQ((std::vector<int>{1, 2}), scenario.jumps->modes);
  EXPECT_EQ(1000000, scenario.jumps->min_separation);
  EXPECT_EQ(20000000, scenario.jumps->delivery.longest);
  EXPECT_EQ(2000000, scenario.jumps->faults.stamp_error);
  EXPECT_EQ(0.1, scenario.jumps->faults.missed);
  EXPECT_EQ(0.2, scenario.jumps->faults.duplicate);
  EXPECT_EQ(0.5, scenario.jumps->faults.false_rate);
  EXPECT_EQ((std::vector<bool>{false, true}), scenario.jumps->rest->held);
  const Eigen::Vector2d state(10.0, 3.0);
  Eigen::Vector2d rest;
  scenario.jumps->rest->state->evaluate(state.data(), nullptr, rest.data());
  EXPECT_EQ(Eigen::Vector2d(10.0, 10.0 - 9.81), rest);
}

TEST(ScenarioConfigTest, OptionalKeysHaveDefaults) {
  const Scenario scenario = test::parse_scenario(R"yaml(
plant: {states: [x], A: [[0]]}
sensors: {s: {C: [[1]], source: {topic: s}}}
scenario: {duration: 1, initial_state: {x: 0}, sensors: {s: {schedule: {sine: [0.1, 0.2]}}}}
)yaml");
  EXPECT_EQ(1000 * kNanosecondsPerSecond, scenario.start);
  EXPECT_EQ(1u, scenario.seed);
  EXPECT_EQ("truth", scenario.truth_topic);
  EXPECT_EQ(10000000, scenario.truth_period);
  EXPECT_FALSE(scenario.input || scenario.disturbance || scenario.jumps);
  EXPECT_EQ(Noise::Kind::kNone, scenario.sensors[0].noise.kind);
  EXPECT_EQ(0, scenario.sensors[0].delivery.longest);
}

/// All keys at the top of an observer's configuration, as its refusal of another one lists them.
std::vector<std::string> keys_of_an_observer() {
  const std::string text = R"yaml(
observer: ConstantGainObserver
plant: {states: [x], A: [[0]]}
sensors: {s: {C: [[1]], source: {topic: s}}}
sampling: {T1: 0.1, T2: 0.2}
gains: {L: [[1]]}
unknown: 1
)yaml";
  const std::string refusal = test::fault(text);
  const std::string before = "one of the keys ";
  const std::size_t begin = refusal.find(before) + before.size();
  std::istringstream list(refusal.substr(begin, refusal.find(", found") - begin));
  std::vector<std::string> keys;
  for (std::string key; std::getline(list >> std::ws, key, ',');) keys.push_back(key);
  return keys;
}

TEST(ScenarioConfigTest, LeavesAloneAllThatOnlyAnObserverReads) {
  const std::vector<std::string> keys = keys_of_an_observer();
  EXPECT_LT(20U, keys.size());
  EXPECT_EQ(1, std::count(keys.begin(), keys.end(), "outputs"));
  for (const std::string& key : keys) {
    if (key == "plant" || key == "sensors" || key == "scenario") continue;
    const std::string text = R"yaml(
plant: {states: [x], A: [[0]]}
sensors: {s: {C: [[1]], source: {topic: s}}}
scenario: {duration: 1, initial_state: {x: 0}, sensors: {s: {schedule: {sine: [0.1, 0.2]}}}}
)yaml";
    EXPECT_EQ(std::string::npos, fault(text + key + ": {}\n").find("one of the keys")) << key;
  }
}

TEST(ScenarioConfigTest, FaultsAreNamedWithPathExpectedAndFound) {
  const std::vector<test::Fault> faults = {
      {"  duration: 20\n", "", {"scenario/duration", "a finite number", "missing"}},
      {"duration: 20", "duration: 0", {"test.yaml:17: scenario/duration", "from 1e-09"}},
      {"start: 500", "start: 5e9", {"scenario/start", "4e+09", "5e+09"}},
      {"seed: 7", "seed: 1.5", {"scenario/seed", "a whole number", "1.5"}},
      {"initial_state: {p: 1, v: 2}",
       "initial_state: {p: 1}",
       {"scenario/initial_state/v", "missing"}},
      {"initial_state: {p: 1, v: 2}",
       "initial_state: {p: 1, v: 2, w: 3}",
       {"scenario/initial_state/w", "unknown key 'w'"}},
      {"initial_mode: 2", "initial_mode: 3", {"scenario/initial_mode", "1, 2", "'3'"}},
      {"rate: 50", "rate: 0", {"scenario/truth/rate", "from 0.001"}},
      {"  input: {rate: 10, formulas: {u: \"sin(t) - p * g\"}}\n",
       "",
       {"scenario/input", "a map of keys", "missing"}},
      {"sin(t) - p * g", "sin(t) - z", {"scenario/input/formulas", "z", "it may use t p v"}},
      {"parameters: {g: 9.81}",
       "parameters: {g: 9.81, t: 1}",
       {"scenario/input/formulas", "t is the time", "called t"}},
      {"N: [[0], [1]]", "N: [[0]]", {"scenario/disturbance/N", "2 x n", "1 x 1"}},
      {"[\"t <= 5 ? -1 : 1\"]", "[\"p\"]", {"scenario/disturbance/formulas", "p"}},
      {"  jumps:\n    when",
       "  signals: {tilt: {formulas: [q], schedule: {period: 1}}}\n  jumps:\n    when",
       {"scenario/signals/tilt/formulas", "q"}},
      {"  jumps:\n    when",
       "  signals: {tilt: {formulas: [p]}}\n  jumps:\n    when",
       {"scenario/signals/tilt/schedule", "missing"}},
      {"schedule: {period: 0.01}, ", "", {"scenario/sensors/radar/schedule", "missing"}},
      {"{period: 0.01}", "{}", {"scenario/sensors/radar/schedule", "uniform, sine", "none"}},
      {"{period: 0.01}",
       "{period: 0.01, sine: [1, 2]}",
       {"scenario/sensors/radar/schedule", "one of the keys", "period, sine"}},
      {"uniform: [0.1, 0.2]",
       "uniform: [0.2, 0.1]",
       {"scenario/sensors/wheel/schedule/uniform", "T1 <= T2"}},
      {"uniform: [0.1, 0.2]",
       "file: none.txt",
       {"scenario/sensors/wheel/schedule/file", "readable", "none.txt"}},
      {"impact: {noise",
       "impact: {schedule: {period: 1}, noise",
       {"scenario/sensors/impact/schedule", "none for a sensor that measures at jumps"}},
      {"impact: {noise",
       "impact: {loss: 0.5, noise",
       {"scenario/sensors/impact/loss", "unknown key 'loss'"}},
      {"noise: {uniform: 0.1}",
       "noise: {uniform: -0.1}",
       {"scenario/sensors/wheel/noise/uniform", "from 0"}},
      {"noise: {uniform: 0.1}",
       "noise: {uniform: [0.1, 0.1]}",
       {"scenario/sensors/wheel/noise/uniform", "1", "2"}},
      {"noise: {uniform: 0.1}",
       "noise: {uniform: [-0.1]}",
       {"scenario/sensors/wheel/noise/uniform", "from 0", "units of the outputs"}},
      {"noise: {uniform: 0.1}",
       "noise: {pink: 0.1}",
       {"scenario/sensors/wheel/noise", "uniform, gaussian, formulas", "pink"}},
      {"[\"0.2*sin(1000*t)\"]", "[\"t\", \"t\"]", {"scenario/sensors/radar/noise/formulas", "1"}},
      {"latency: [0.01, 0.05]",
       "latency: [0.05, 0.01]",
       {"scenario/sensors/wheel/latency", "shortest <= longest"}},
      {"latency: [0.01, 0.05]",
       "latency: [0, 0]",
       {"scenario/sensors/wheel/reordering", "latency above 0"}},
      {"loss: 0.1", "loss: 1.1", {"scenario/sensors/wheel/loss", "from 0 to 1", "1.1"}},
      {"    wheel:\n      schedule",
       "    whel:\n      schedule",
       {"scenario/sensors/wheel", "missing"}},
      {"when: \"p - 30\"", "when: \"p - u\"", {"scenario/jumps/when", "formula of the states"}},
      {"when: \"p - 30\"",
       "when: p\n    schedule: {period: 1}",
       {"scenario/jumps", "one of the keys when and schedule", "both"}},
      {"    when: \"p - 30\"\n", "", {"scenario/jumps", "when and schedule", "none"}},
      {"    modes: [1, 2]\n", "", {"scenario/jumps/modes", "missing"}},
      {"modes: [1, 2]", "modes: [1, 3]", {"scenario/jumps/modes", "1, 2", "'3'"}},
      {"min_separation: 0.001",
       "min_separation: 0",
       {"scenario/jumps/min_separation", "from 1e-09"}},
      {"rest: {v: \"p - g\"}", "rest: {}", {"scenario/jumps/rest", "one state"}},
      {"rest: {v: \"p - g\"}", "rest: {w: 0}", {"scenario/jumps/rest/w", "unknown key 'w'"}},
      {"rest: {v: \"p - g\"}", "rest: {v: u}", {"scenario/jumps/rest/v", "formula", "u"}},
      {"when: \"p - 30\"", "schedule: {period: 1}", {"scenario/jumps/rest", "when beside it"}},
      {"stamp_error: 0.002", "stamp_error: -1", {"scenario/jumps/stamp_error", "from 0"}},
      {"missed: 0.1", "missed: 2", {"scenario/jumps/missed", "from 0 to 1"}},
      {"duplicate: 0.2", "duplicate: 2", {"scenario/jumps/duplicate", "from 0 to 1"}},
      {"false_rate: 0.5", "false_rate: -1", {"scenario/jumps/false_rate", "from 0"}},
      {"source: {topic: wheel}",
       "source: {topic: force, type: geometry_msgs/PointStamped, fields: [point.x]}",
       {"input/topic", "a topic of its own", "sensors/wheel/source", "'force'"}},
      {"source: {topic: wheel}",
       "source: {topic: w, type: nav_msgs/Odometry, fields: [twist.twist.linear.x], body_frame: b}",
       {"sensors/wheel/source/body_frame", "no transforms are simulated", "'b'"}},
      {"gains: {read", "gain: {read", {"gain", "unknown key 'gain'"}},
      {"  seed: 7", "  sed: 7", {"scenario/sed", "unknown key 'sed'"}},
  };
  EXPECT_EQ("no fault", fault(kGood));
  for (const test::Fault& changed : faults) {
    const std::string message = fault(test::replaced(kGood, changed.from, changed.to));
    EXPECT_EQ("", test::missing_parts(changed, message)) << changed.to << "\n" << message;
  }
}

TEST(ScenarioConfigTest, SchedulesOutsideOfSamplingAreToldOf) {
  const std::string scenario = R"yaml(
plant: {states: [x], A: [[0]]}
sensors:
  a: {C: [[1]], sampling: {T1: 0.2, T2: 1}, source: {topic: a}}
  b: {C: [[1]], source: {topic: b}}
sampling: {a: {T1: 0, T2: 2}, b: {T1: 0.05, T2: 0.2}}
scenario:
  duration: 1
  initial_state: {x: 0}
  sensors: {a: {schedule: {uniform: [0.2, 1]}}, b: {schedule: {period: 0.05}}}
)yaml";
  EXPECT_TRUE(test::parse_scenario(scenario).warnings.empty());
  const auto warnings =
      test::parse_scenario(test::replaced(scenario, "[0.2, 1]", "[0.1, 1]")).warnings;
  ASSERT_EQ(1u, warnings.size());
  EXPECT_EQ(
      "scenario/sensors/a/schedule has times in [0.1, 1] s, not all inside [0.2, 1] s, those of "
      "'sampling'",
      warnings.front());
  EXPECT_EQ(1u, test::parse_scenario(test::replaced(scenario, "period: 0.05", "period: 0.3"))
                    .warnings.size());
}

TEST(ScenarioConfigTest, ReadsTimesFromAFileBesideTheScenario) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "times_test";
  std::filesystem::create_directories(folder);
  const auto read = [&](const std::string& times) {
    std::ofstream(folder / "times.txt") << times;
    std::ofstream(folder / "scenario.yaml") << R"yaml(
plant: {states: [x], A: [[0]]}
sensors: {s: {C: [[1]], source: {topic: s}}}
scenario: {duration: 1, initial_state: {x: 0}, sensors: {s: {schedule: {file: times.txt}}}}
)yaml";
    return read_scenario({(folder / "scenario.yaml").string()}, no_plant_plugins);
  };
  EXPECT_EQ((std::vector<Duration>{0, 250000000, 1500000000}),
            read("0\n0.25\n\n 1.5 \n").sensors[0].schedule->times);
  for (const char* wrong : {"", "1\nx\n", "1 2\n", "1\n1\n", "2\n1\n", "-1\n", "nan\n"}) {
    EXPECT_THROW(read(wrong), ConfigError) << wrong;
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace sampled_data_observers
