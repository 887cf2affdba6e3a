// Gain files of designs by Lyapunov functions that depend on timers, written and read: their proofs
// hold, and their bounds do in adversarial runs, with several sensors, early and late samples.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "certificate/disturbed_flow.h"
#include "certificate/state_shares.h"
#include "design/rigorous_check.h"
#include "sampled_data_observers/observer/plant_observer.h"
#include "timer_dependent_plants.h"

namespace sampled_data_observers::test {
namespace {

constexpr char kOscillator[] =
    "plant: {states: [x1, x2], A: [[0, 1], [-4, 0]]}\n"
    "sensors: {position: {C: [[1, 0]], source: {topic: position}}}\n";
constexpr char kIntegrator[] =
    "plant: {states: [x1, x2, x3], A: [[0, 1, 0], [0, 0, 1], [0, 0, 0]]}\n"
    "sensors:\n"
    "  position: {C: [[1, 0, 0]], source: {topic: position}}\n"
    "  speed: {C: [[0, 1, 0]], source: {topic: speed}}\n";
constexpr char kPendulum[] =
    "plant:\n"
    "  states: [x1, x2]\n"
    "  A: [[0, 1], [-1, -0.2]]\n"
    "  G: [[0], [1]]\n"
    "  S: [[1, 0]]\n"
    "  psi: ['0.3 * sin(v1)']\n"
    "  integration: {step: 0.01}\n"
    "  lipschitz_constant: 0.3\n"
    "sensors: {angle: {C: [[1, 0]], source: {topic: angle}}}\n";
constexpr char kPolytopicPendulum[] =
    "plant:\n"
    "  states: [x1, x2]\n"
    "  A: [[0, 1], [-1, -0.2]]\n"
    "  G: [[0], [1]]\n"
    "  S: [[1, 0]]\n"
    "  psi: ['0.3 * sin(v1)']\n"
    "  integration: {step: 0.01}\n"
    "  vertices: {1: [[0, 0], [0.3, 0]], 2: [[0, 0], [-0.3, 0]]}\n"
    "sensors: {angle: {C: [[1, 0]], source: {topic: angle}}}\n";

constexpr char kCrowd[] =
    "plant: {states: [x1, x2], A: [[0, 1], [-1, 0]]}\n"
    "sensors:\n"
    "  a: {C: [[1, 0]], source: {topic: a}}\n"
    "  b: {C: [[0, 1]], source: {topic: b}}\n"
    "  c: {C: [[1, 1]], source: {topic: c}}\n"
    "  d: {C: [[1, 0]], source: {topic: d}}\n"
    "  e: {C: [[1, -1]], source: {topic: e}}\n";

constexpr char kLargerCrowd[] =
    "plant: {states: [x1, x2], A: [[0, 1], [-1, 0]]}\n"
    "sensors:\n"
    "  a: {C: [[1, 0]], source: {topic: a}}\n"
    "  b: {C: [[0, 1]], source: {topic: b}}\n"
    "  c: {C: [[1, 1]], source: {topic: c}}\n"
    "  d: {C: [[1, 0]], source: {topic: d}}\n"
    "  e: {C: [[1, -1]], source: {topic: e}}\n"
    "  f: {C: [[0, 1]], source: {topic: f}}\n";

constexpr char kFormulas[] =
    "plant:\n"
    "  states: [x1, x2]\n"
    "  flow: {x1: 'x2', x2: '0.1 * sin(x2) - x1 - 0.2 * x2 + 0.3 * sin(x1)'}\n"
    "  jacobian_vertices: {1: [[0, 1], [-0.7, -0.2]], 2: [[0, 1], [-1.3, -0.2]]}\n"
    "  G: [[0], [1]]\n"
    "  S: [[0, 1]]\n"
    "  lipschitz_constant: 0.1\n"
    "  integration: {step: 0.01}\n"
    "sensors: {angle: {C: [[1, 0]], source: {topic: angle}}}\n";

struct Scene {
  const char* name;
  const char* plant;
  const char* method;
  std::vector<SamplingTimes> times;
  int cells;
};
void PrintTo(const Scene& scene, std::ostream* out) { *out << scene.name; }

const Scene kScenes[] = {
    {"constant", kOscillator, "timer_dependent_constant_gain", {{0.0, 0.3}}, 4},
    {"constant_from_T1", kOscillator, "timer_dependent_constant_gain", {{0.1, 0.4}}, 4},
    {"injection", kOscillator, "timer_dependent_alternating_injection", {{0.0, 0.3}}, 4},
    {"held", kOscillator, "timer_dependent_alternating_hold", {{0.0, 0.2}}, 4},
    {"scheduled", kOscillator, "timer_dependent_scheduled_gain", {{0.1, 0.4}}, 4},
    // Gains found by hand.
    {"two_sensors", kIntegrator, "", {{0.2, 1.0}, {0.05, 0.2}}, 3},
    {"five_sensors", kCrowd, "", {{0.3, 1.0}, {0.2, 0.8}, {0.5, 1.0}, {0.1, 0.5}, {0.4, 0.9}}, 2},
    {"sum_of_six",
     kLargerCrowd,
     "",
     {{0.3, 1.0}, {0.2, 0.8}, {0.5, 1.0}, {0.1, 0.5}, {0.4, 0.9}, {0.2, 0.6}},
     2},
    {"two_sensors_scheduled",
     kIntegrator,
     "timer_dependent_scheduled_gain",
     {{0.2, 1.0}, {0.05, 0.2}},
     3},
    {"scheduled_densely", kOscillator, "timer_dependent_scheduled_gain", {{0.0, 0.4}}, 4},
    {"two_sensors_densely",
     kIntegrator,
     "timer_dependent_scheduled_gain",
     {{0.0, 1.0}, {0.0, 0.2}},
     3},
    {"lipschitz", kPendulum, "timer_dependent_constant_gain", {{0.0, 0.3}}, 4},
    {"jacobian", kFormulas, "timer_dependent_constant_gain", {{0.1, 0.4}}, 4},
    {"vertices", kPolytopicPendulum, "timer_dependent_constant_gain", {{0.1, 0.4}}, 4},
};

constexpr double kRate = 0.2;
const ErrorAssumptions kAssumed = {1.0, 0.05, 0.3};
constexpr char kAssumptions[] = "{initial_error: 1, noise: 0.05, disturbance: 0.3}";

DesignedObserver observer_of(const Scene& scene) {
  const Eigen::Index n = scene.plant == kIntegrator ? 3 : 2;
  DesignedObserver observer(scene.plant, scene.times, Eigen::MatrixXd::Identity(n, n).rightCols(1),
                            Eigen::MatrixXd::Identity(n, n));
  if (scene.method[0] != '\0') {
    observer.design(scene.method, kRate, scene.cells);
  } else if (scene.plant == kLargerCrowd) {
    observer.prove_gains("timer_dependent_sum_constant_gain",
                         {{"L/a", Eigen::Vector2d(0.4, 0.0)},
                          {"L/b", Eigen::Vector2d(0.0, 0.4)},
                          {"L/c", Eigen::Vector2d(0.2, 0.2)},
                          {"L/d", Eigen::Vector2d(0.4, 0.0)},
                          {"L/e", Eigen::Vector2d(0.2, -0.2)},
                          {"L/f", Eigen::Vector2d(0.0, 0.4)}},
                         kRate, scene.cells);
  } else if (scene.plant == kCrowd) {
    observer.prove_gains("timer_dependent_constant_gain",
                         {{"L/a", Eigen::Vector2d(0.4, 0.0)},
                          {"L/b", Eigen::Vector2d(0.0, 0.4)},
                          {"L/c", Eigen::Vector2d(0.2, 0.2)},
                          {"L/d", Eigen::Vector2d(0.4, 0.0)},
                          {"L/e", Eigen::Vector2d(0.2, -0.2)}},
                         kRate, scene.cells);
  } else {
    observer.prove_gains("timer_dependent_constant_gain",
                         {{"L/position", Eigen::Vector3d(0.8, 0.0, 0.0)},
                          {"L/speed", Eigen::Vector3d(0.0, 0.9, 1.5)}},
                         kRate, scene.cells);
  }
  return observer;
}

/// How samples come and what drives the error.
struct Manner {
  bool strays = false;  ///< some samples come later than T2 or sooner than T1
  bool is_worst = true;
};

/// Plays plant and sensors against a law, each sensor at times of its own.
class SensorRuns {
 public:
  SensorRuns(const ObserverConfig& config, const Scene& scene, const Eigen::MatrixXd& N)
      : law_(*config.law),
        plant_(*config.plant),
        scene_(scene),
        N_(N),
        flow_(plant_, N, 5'000'000),
        shares_(law_),
        workspace_(law_.workspace_size()),
        state_(law_.state_size()) {}

  void begin(std::uint64_t seed) {
    generator_.seed(seed);
    x_ = Eigen::VectorXd::Zero(plant_.states());
    law_.initialize(state_.data());
    const Eigen::VectorXd estimate = -kAssumed.initial_error * direction(plant_.states());
    law_.observer().start_from(estimate.data(), state_.data());
    due_.clear();
    // The first samples come at any time.
    for (const SamplingTimes& times : scene_.times) {
      due_.push_back(uniform() < 0.3 ? 1 : from_seconds(uniform() * times.T2));
    }
    compare();
  }

  void play(int events, Manner manner) {
    for (int i = 0; i < events; ++i) {
      const Duration next = *std::min_element(due_.begin(), due_.end());
      for (int part = 0; part < kParts; ++part) flow(part_of(next, part), manner);
      for (std::size_t sensor = 0; sensor < due_.size(); ++sensor) {
        due_[sensor] -= next;
        if (due_[sensor] > 0) continue;
        sample(sensor, manner);
        due_[sensor] = interval(scene_.times[sensor], manner);
      }
    }
  }

  double bound() const { return law_.error_bound(state_.data()); }
  /// Of the norm, a state, and the ellipsoid.
  double largest_share() const { return largest_share_; }
  double largest_state_share() const { return largest_state_share_; }
  double largest_ellipsoid_share() const { return largest_ellipsoid_share_; }

 private:
  static constexpr int kParts = 3;
  static Duration part_of(Duration interval, int part) {
    return interval * (part + 1) / kParts - interval * part / kParts;
  }

  double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(generator_); }
  Eigen::VectorXd direction(Eigen::Index size) {
    std::normal_distribution<double> normal;
    Eigen::VectorXd result(size);
    for (Eigen::Index i = 0; i < size; ++i) result(i) = normal(generator_);
    return result.normalized();
  }
  Eigen::VectorXd error() const { return x_ - state_.head(plant_.states()); }

  /// Out along `along` in most cases, else in.
  Eigen::VectorXd push(double norm, const Eigen::VectorXd& along, Manner manner) {
    if (!manner.is_worst || !(along.norm() > 0.0)) return norm * direction(along.size());
    return (uniform() < 0.8 ? norm : -norm) * along.normalized();
  }

  Duration interval(const SamplingTimes& times, Manner manner) {
    const double choice = uniform();
    if (manner.strays && choice < 0.1) return from_seconds(times.T2 * (1.0 + 2.0 * uniform()));
    if (manner.strays && choice < 0.2) return 1 + from_seconds(times.T1 * uniform());
    if (choice < 0.5) return from_seconds(times.T2);
    if (choice < 0.6) return std::max<Duration>(1, from_seconds(times.T1));
    return std::max<Duration>(1, from_seconds(times.T1 + uniform() * (times.T2 - times.T1)));
  }

  void flow(Duration duration, Manner manner) {
    const Eigen::VectorXd w = push(kAssumed.disturbance, N_.transpose() * error(), manner);
    flow_.apply(0, w, duration, x_);
    law_.flow(duration, state_.data(), workspace_.data());
    compare();
  }

  void sample(std::size_t sensor, Manner manner) {
    const Eigen::MatrixXd& C = plant_.modes().front().outputs[sensor]->affine()->M();
    const Eigen::VectorXd y = C * x_ + push(kAssumed.noise, -(C * error()), manner);
    const Event event{0, EventKind::kSample, static_cast<int>(sensor), y.data(), y.size(), 0};
    static_cast<void>(law_.reset(event, state_.data(), workspace_.data()));
    compare();
  }

  void compare() {
    ASSERT_TRUE(std::isfinite(bound()));
    // Of the integration, where the flow is not affine.
    const double rounding = (plant_.is_affine() ? 1e-12 : 1e-7) * (1.0 + x_.norm());
    const double share = std::max(0.0, error().norm() - rounding) / bound();
    largest_share_ = std::max(largest_share_, share);
    largest_state_share_ =
        std::max(largest_state_share_, shares_.largest(state_, error(), rounding));
    if (++comparisons_ % 4 != 0) return;
    largest_ellipsoid_share_ =
        std::max(largest_ellipsoid_share_, shares_.of_ellipsoid(state_, error(), rounding));
  }

  const ObserverLaw& law_;
  const Plant& plant_;
  const Scene& scene_;
  Eigen::MatrixXd N_;
  DisturbedFlow flow_;
  StateShares shares_;
  Eigen::VectorXd workspace_;
  Eigen::VectorXd state_;
  Eigen::VectorXd x_;
  std::vector<Duration> due_;
  std::mt19937_64 generator_;
  std::size_t comparisons_ = 0;
  double largest_share_ = 0.0;
  double largest_state_share_ = 0.0;
  double largest_ellipsoid_share_ = 0.0;
};

/// The text with the first number of the P of a node made larger.
std::string with_other_P(std::string text, const std::string& node) {
  const std::size_t line = text.find("\"" + node + "\": [[", text.find("  P:"));
  EXPECT_NE(line, std::string::npos) << text;
  text.insert(text.find("[[", line) + 2, "9");
  return text;
}

class TimerDependentFile : public ::testing::TestWithParam<Scene> {};

TEST_P(TimerDependentFile, HoldsWhatItSays) {
  const Scene& scene = GetParam();
  const DesignedObserver observer = observer_of(scene);
  // Read again, it is the same, and its proof is one.
  const Certificate& written = observer.design().certificate;
  const Certificate read = observer.certificate();
  EXPECT_EQ(read.theorem, written.theorem);
  EXPECT_EQ(read.subject.timer_nodes, written.subject.timer_nodes);
  for (const auto& [name, value] : written.values) {
    EXPECT_EQ(read.values.at(name), value) << name;
  }
  const auto proofs = prove(read.theorem->conditions(read.subject), read.values);
  EXPECT_EQ(first_unproved(proofs), "");
  EXPECT_THROW(observer.config(with_other_P(observer.gain_file(), "2"), kAssumptions), ConfigError);

  const ObserverConfig config = observer.config(observer.gain_file(), kAssumptions);
  SensorRuns runs(config, scene, read.subject.plant.N);
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Manner manner;
    manner.strays = seed % 2 == 1;
    manner.is_worst = seed % 3 != 2;
    ASSERT_NO_FATAL_FAILURE(runs.begin(seed));
    ASSERT_NO_FATAL_FAILURE(runs.play(60, manner));
    ASSERT_LE(runs.largest_share(), 1.0 + 1e-9) << seed;
    ASSERT_LE(runs.largest_state_share(), 1.0 + 1e-9) << seed;
    ASSERT_LE(runs.largest_ellipsoid_share(), 1.0 + 1e-6) << seed;
  }
  // Otherwise the runs would not notice a bound of another size.
  EXPECT_GT(runs.largest_share(), 0.05);
  RecordProperty("largest_share", std::to_string(runs.largest_share()));

  // After samples that came too late it falls back to what it was, in the end.
  const int regular = scene.times.size() > 1 ? 4000 : 1000;
  runs.begin(1000);
  runs.play(regular, {false, true});
  const double before = runs.bound();
  runs.play(40, {true, true});
  runs.play(regular, {false, true});
  EXPECT_LE(runs.bound(), 2.0 * before);
}

INSTANTIATE_TEST_SUITE_P(EveryLaw, TimerDependentFile, ::testing::ValuesIn(kScenes),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace sampled_data_observers::test
