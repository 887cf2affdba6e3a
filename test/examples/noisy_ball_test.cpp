// Bounces of the ball of bernard2022, section 7.1, found in the velocity that a radar measures at
// 1 kHz with noise of 0.05 m/s.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sampled_data_observers/runtime/jump_detector.h"
#include "simulation/simulator.h"
#include "support/example_run.h"

namespace sampled_data_observers::test {
namespace {

struct Detection {
  int fast = 0;   ///< bounces at more than 0.2 m/s
  int found = 0;  ///< of these
  int all = 0;    ///< jumps that the detector tells
  int wrong = 0;  ///< of these: where no bounce is within 1 ms
};

Detection detect(const std::string& observer_file, std::uint64_t seed) {
  Example example("bernard2022_bouncing_ball");
  const ObserverConfig config = example.observer("scenario_noisy.yaml", observer_file);
  Simulator simulator(example.seed(seed).scenario("scenario_noisy.yaml"));
  const DetectorConfig& detector_config = *config.jumps->detector;
  JumpDetector detector(detector_config.options);
  std::vector<double> bounces;
  std::vector<double> detected;
  while (const auto message = simulator.next()) {
    const std::string& topic = simulator.channels()[message->channel].topic;
    if (topic == "jumps") bounces.push_back(to_seconds(message->stamp));
    if (topic != config.jumps->topic) continue;
    double signal = 0.0;
    detector_config.signal->evaluate(message->values.data(), nullptr, &signal);
    if (detector.add(message->stamp, signal) == JumpDetector::Finding::kJump) {
      detected.push_back(to_seconds(detector.crossing()));
    }
  }
  Detection detection;
  std::vector<bool> is_found(bounces.size(), false);
  for (const double jump : detected) {
    bool is_wrong = true;
    for (std::size_t i = 0; i < bounces.size(); ++i) {
      if (is_found[i] || std::abs(jump - bounces[i]) > 1e-3) continue;
      is_found[i] = true;
      is_wrong = false;
      break;
    }
    ++detection.all;
    detection.wrong += is_wrong ? 1 : 0;
  }
  for (std::size_t i = 0; i < bounces.size(); ++i) {
    // From one bounce to the next it falls for half of the time, but for the friction.
    const bool is_fast = i == 0 || 9.81 * (bounces[i] - bounces[i - 1]) / 2.0 > 0.2;
    detection.fast += is_fast ? 1 : 0;
    detection.found += is_fast && is_found[i] ? 1 : 0;
  }
  return detection;
}

TEST(NoisyBallTest, AllFastBouncesAreFoundAndNothingElse) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const Detection detection = detect("observer_noisy.yaml", seed);
    EXPECT_EQ(17, detection.fast);
    EXPECT_GE(detection.found, 0.95 * detection.fast) << seed;
    EXPECT_EQ(0, detection.wrong) << seed;
  }
}

TEST(NoisyBallTest, AThresholdAloneTakesNoiseForBounces) {
  const Detection detection = detect("observer_detected.yaml", 1);
  EXPECT_GT(detection.wrong, 20);
}

}  // namespace
}  // namespace sampled_data_observers::test
