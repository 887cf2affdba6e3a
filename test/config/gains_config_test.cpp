// Faults in the gains of the observer types.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/config/yaml_file.h"
#include "sampled_data_observers/observer/plant_observer.h"
#include "support/config_faults.h"
#include "support/law_runner.h"

namespace sampled_data_observers {
namespace {

/// A configuration of test/types with one thing changed.
struct BadGains {
  const char* example;
  test::Fault fault;
};

std::string read_example(const std::string& name) {
  std::ifstream file(std::string(SDO_SOURCE_DIR) + "/test/types/" + name + ".yaml");
  std::ostringstream text;
  text << file.rdbuf();
  EXPECT_TRUE(file.good()) << name;
  return text.str();
}

class BadGainsTest : public ::testing::TestWithParam<BadGains> {};

TEST_P(BadGainsTest, AreRefusedWithAMessageThatHelps) {
  const test::Fault& change = GetParam().fault;
  const std::string found =
      test::fault(test::replaced(read_example(GetParam().example), change.from, change.to));
  EXPECT_EQ("", test::missing_parts(change, found)) << found;
}

const char kKalman[] = "hybrid_kalman_filter";
const char kTimeVarying[] = "time_varying_gain";
const char kScheduled[] = "time_varying_gain_scheduled";
const char kInjection[] = "intersample_injection";
const char kPredictor[] = "intersample_injection_lipschitz";

INSTANTIATE_TEST_SUITE_P(
    Faults, BadGainsTest,
    ::testing::Values(
        BadGains{kInjection, {"a: [[-0.9]]", "a: [[-0.9, 0]]", {"gains/H/a", "1 x 1", "1 x 2"}}},
        BadGains{kInjection, {", b: [[-0.5, 0.1], [0, -0.3]]", "", {"gains/H/b", "missing"}}},
        BadGains{kInjection,
                 {"theta0: {a: [0.3]}", "theta0: {a: [1, 2]}", {"gains/theta0/a", "1"}}},
        BadGains{kInjection, {"theta0: {a: [0.3]}", "theta0: {z: [1]}", {"gains/theta0/z"}}},
        BadGains{kInjection, {"theta0: {a: [0.3]}", "variant: predictor", {"gains/H", "unknown"}}},
        BadGains{kPredictor,
                 {"variant: predictor", "variant: magic", {"zero_order_hold", "'magic'"}}},
        BadGains{kPredictor, {", variant: predictor", "", {"gains/H", "missing"}}},
        BadGains{kPredictor, {"C: [[1, 0]]", "h: [\"p^2\"]", {"gains/variant", "'s'"}}},
        BadGains{kKalman,
                 {"P0: [[1, 0.1], [0.1, 2]]", "P0: [[1, 0.1], [0.2, 2]]", {"gains", "P0"}}},
        BadGains{kKalman, {"P0: [[1, 0.1], [0.1, 2]]", "P0: [[0, 0], [0, 2]]", {"gains", "P0"}}},
        BadGains{kKalman, {"s: [[0.3]]", "s: [[0]]", {"gains", "R of sensor 's'"}}},
        BadGains{kKalman, {", s: [[0.3]]", "", {"gains/R/s", "missing"}}},
        BadGains{kKalman, {"Q: [[0, 0], [0, 0.5]]", "Q: [[0, 0], [0, -1]]", {"gains", "Q"}}},
        BadGains{kKalman,
                 {"Q: [[0, 0], [0, 0.5]]",
                  "Q: {diagonal: [1]}",
                  {"gains/Q/diagonal", "2 finite numbers"}}},
        BadGains{kKalman,
                 {"Q: [[0, 0], [0, 0.5]]", "Q: {diag: [0, 0.5]}", {"gains/Q/diagonal", "missing"}}},
        BadGains{"hybrid_kalman_filter_formulas",
                 {"iterations: 3", "iterations: 0", {"gains/iterations", "1", "20", "0"}}},
        BadGains{"hybrid_kalman_filter_formulas",
                 {"iterations: 3", "iterations: 2.5", {"gains/iterations", "whole number"}}},
        BadGains{
            "hybrid_kalman_filter_formulas",
            {"iterations: 3", "variant: cubature", {"gains/variant", "unscented", "cubature"}}},
        BadGains{"hybrid_kalman_filter_formulas",
                 {"iterations: 3",
                  "iterations: 3\n  variant: unscented",
                  {"gains/iterations", "no such key beside variant: unscented"}}},
        BadGains{kTimeVarying, {"lambda: 0.4", "lambda: 1", {"gains/lambda", "[0, 1)"}}},
        BadGains{kTimeVarying, {"lambda: 0.4", "lambda: -0.1", {"gains/lambda", "found -0.1"}}},
        BadGains{kTimeVarying, {"P: [[2,", "P: [[-2,", {"gains", "P"}}},
        BadGains{kTimeVarying, {"{C: [[1, 0, 0.5]]", "{C: [[0, 0, 0]]", {"gains", "'s'"}}},
        BadGains{kTimeVarying, {"{C: [[1, 0, 0.5]]", "{h: [\"p^2\"]", {"gains", "'s'", "linear"}}},
        BadGains{kTimeVarying, {"lambda: 0.4", "K: {}", {"gains/timers", "missing"}}},
        BadGains{
            kScheduled,
            {"[0, 0.25, 1]", "[0.1, 0.25, 1]", {"gains/timers/a", "0 first", "[0.1, 0.25, 1]"}}},
        BadGains{kScheduled, {"[0, 0.5]", "[0, 0]", {"gains/timers/b", "greater", "[0, 0]"}}},
        BadGains{kScheduled, {"[0, 0.5]", "[0]", {"gains/timers/b", "two times", "[0]"}}},
        BadGains{kScheduled, {"[0, 0.5]", "[[0, 0.5]]", {"gains/timers/b", "a list of lists"}}},
        BadGains{kScheduled, {", b: [0, 0.5]}", "}", {"gains/timers/b", "missing"}}},
        BadGains{kScheduled, {"b: [0, 0.5]}", "b: [0, 0.5], c: [0, 1]}", {"gains/timers/c"}}},
        BadGains{kScheduled, {"[0, 0.25, 1]", "[0, 0.25, 1, 2]", {"gains/P/6", "missing"}}},
        BadGains{kScheduled, {"[0, 0.25, 1]", "[0, 1]", {"gains/P/4", "unknown"}}},
        BadGains{kScheduled, {"5: [[0.5, 0.1]", "5: [[-0.5, 0.1]", {"gains", "P/5", "definite"}}},
        BadGains{kScheduled, {"3: [[1.2, 0.1]", "3: [[1.2, 0.2]", {"gains", "P/3", "symmetric"}}},
        BadGains{kScheduled, {"4: [[0.7, 0], [0, 0.4]]", "4: [[0.7]]", {"gains/P/4", "2 x 2"}}},
        BadGains{kScheduled, {"3: [[0.4], [0.5]]", "3: [[0.4, 0.5]]", {"gains/K/a/3", "2 x 1"}}},
        BadGains{kScheduled, {"  b:\n      0:", "  c:\n      0:", {"gains/K/b", "missing"}}},
        BadGains{kScheduled, {"P:\n", "Z: {a: {0: [[1]]}}\n  P:\n", {"gains/K/a/0", "unknown"}}},
        BadGains{kScheduled, {"P:\n", "Z: {a: {0: [1]}}\n  P:\n", {"gains/Z/a/0", "1 x 1"}}},
        BadGains{kScheduled, {"P:\n", "Z: {c: {0: [[1]]}}\n  P:\n", {"gains/Z/c", "unknown"}}},
        BadGains{kScheduled, {"P:\n", "lambda: 0.4\n  P:\n", {"gains/lambda", "unknown"}}},
        BadGains{"sample_and_hold",
                 {"[[-1.5], [-0.4]]", "[[-1.5]]", {"gains/L", "2 x 1", "1 x 1"}}},
        BadGains{"synchronized",
                 {"e: [[0.2, 0], [0, -0.2]]", "e: [[1]]", {"gains/L_d/e", "2 x 2"}}},
        BadGains{"synchronized_nonlinear_delayed",
                 {"{angle: c}", "{angle: z}", {"gains/output_injection/angle", "'z'"}}},
        BadGains{"synchronized_nonlinear_delayed",
                 {"{angle: c}", "{angel: c}", {"gains/output_injection/angel", "unknown"}}},
        BadGains{"synchronized_nonlinear_delayed",
                 {"{angle: c}", "{angle: d}", {"gains", "'d'", "continuously"}}}));

const char kFallingBall[] = R"(
observer: HybridKalmanFilter
plant: {states: [v], A: [[0]], b: [-9], jump_map: {A_d: [[-1]]}}
sensors: {s: {C: [[1]], source: {topic: s}}}
sampling: {T1: 1, T2: 1}
gains: {P0: [[1]], R: [[1]]}
jumps: {stamp_error: 0.1}
)";

TEST(KalmanGainsTest, ADiagonalStandsForItsMatrix) {
  const std::string text = read_example(kKalman);
  const auto gains = [](const std::string& yaml) {
    return test::parse(yaml).law->observer().gains();
  };
  const std::string short_text =
      test::replaced(test::replaced(text, "Q: [[0, 0], [0, 0.5]]", "Q: {diagonal: [0, 0.5]}"),
                     "s: [[0.3]]", "s: {diagonal: [0.3]}");
  EXPECT_EQ(gains(text).find("Q")->value, gains(short_text).find("Q")->value);
  EXPECT_EQ(gains(text).find("R/s")->value, gains(short_text).find("R/s")->value);
}

TEST(KalmanGainsTest, TheNoiseOfTheOnlySensorNeedsNoName) {
  const auto noise = [](const std::string& R) {
    const ObserverConfig config = read_observer_config(
        read_yaml_text(test::replaced(kFallingBall, "R: [[1]]", "R: " + R), "test.yaml"),
        no_plant_plugins);
    return config.law->observer().gains().find("R/s")->value;
  };
  EXPECT_EQ(noise("[[4]]"), noise("{s: {diagonal: [4]}}"));
  EXPECT_EQ(noise("[[4]]"), noise("{diagonal: [4]}"));
  try {
    noise("{t: {diagonal: [4]}}");
    FAIL() << "a sensor that is none";
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string::npos, std::string(error.what()).find("gains/R/s")) << error.what();
  }
}

TEST(KalmanGainsTest, TheStampErrorOfJumpsIsThatOfAUniformDistribution) {
  const ObserverConfig config =
      read_observer_config(read_yaml_text(kFallingBall, "test.yaml"), no_plant_plugins);
  test::LawRunner runner(config.law);
  runner.jump();
  // The saltation is -9 - 9.
  EXPECT_NEAR(1.0 + 0.1 * 0.1 / 3.0 * 18.0 * 18.0,
              *config.law->observer().covariance(runner.state().data()), 1e-12);
}

}  // namespace
}  // namespace sampled_data_observers
