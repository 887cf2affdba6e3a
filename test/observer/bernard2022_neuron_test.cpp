// The spiking neuron of bernard2022, section 7.2, with the high-gain observer of figure 3.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <string>

#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/config/yaml_file.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {
namespace {

constexpr Stamp kStart = 1000 * kNanosecondsPerSecond;
constexpr Duration kPeriod = kNanosecondsPerSecond / 1000;

/// The plant: x1, x2 with a = 0.02, b = 0.2, I = 10, c = -55, d = 4, v_m = 30.
class Neuron {
 public:
  const Eigen::Vector2d& x() const { return x_; }

  /// Flows by `duration` or up to the threshold; returns the time flowed.
  double flow(double duration) {
    constexpr double kStep = 1e-4;
    for (double t = 0.0; t < duration;) {
      const double step = std::min(kStep, duration - t);
      const Eigen::Vector2d next = after(step);
      if (next(0) < kThreshold) {
        x_ = next;
        t += step;
        continue;
      }
      double low = 0.0;
      double high = step;
      for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (after(middle)(0) < kThreshold ? low : high) = middle;
      }
      x_ = after(high);
      return t + high;
    }
    return duration;
  }
  bool fires() const { return x_(0) >= kThreshold; }
  void jump() { x_ = Eigen::Vector2d(-55.0, x_(1) + 4.0); }

 private:
  static constexpr double kThreshold = 30.0;

  static Eigen::Vector2d slope(const Eigen::Vector2d& x) {
    return {0.04 * x(0) * x(0) + 5.0 * x(0) + 140.0 - x(1) + 10.0, 0.02 * (0.2 * x(0) - x(1))};
  }
  Eigen::Vector2d after(double h) const {
    const Eigen::Vector2d k1 = slope(x_);
    const Eigen::Vector2d k2 = slope(x_ + 0.5 * h * k1);
    const Eigen::Vector2d k3 = slope(x_ + 0.5 * h * k2);
    const Eigen::Vector2d k4 = slope(x_ + h * k3);
    return x_ + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }

  Eigen::Vector2d x_ = Eigen::Vector2d(-55.0, -6.0);
};

/// Plant and observer together: y_c every millisecond, jumps, and, where `at_jumps`, the potential
/// just after each jump, too.
class Simulation {
 public:
  Simulation(const ObserverConfig& config, bool at_jumps)
      : estimator_(config.law, config.options),
        estimate_(estimator_.make_estimate()),
        at_jumps_(at_jumps) {
    submit(EventKind::kOutput);
  }

  void run_until(double end) {
    while (stamp_ < kStart + from_seconds(end)) {
      const Stamp next = (stamp_ / kPeriod + 1) * kPeriod;
      const double rest = to_seconds(next - kStart) - now_;
      const double flowed = neuron_.flow(rest);
      now_ = flowed < rest ? now_ + flowed : to_seconds(next - kStart);
      stamp_ = kStart + from_seconds(now_);
      if (neuron_.fires()) {
        neuron_.jump();
        ++jumps_;
        submit(EventKind::kJump);
        if (at_jumps_) submit(EventKind::kOutput);
      } else {
        submit(EventKind::kOutput);
      }
    }
  }

  Eigen::VectorXd estimate() {
    EXPECT_EQ(Timeline::Query::kOk, estimator_.estimate_at(stamp_, estimate_));
    return estimate_.state.head(estimator_.law().estimate_size());
  }
  const Eigen::Vector2d& x() const { return neuron_.x(); }
  int jumps() const { return jumps_; }

 private:
  void submit(EventKind kind) {
    const double y = neuron_.x()(0);
    const Event event{stamp_, kind, 0, &y, kind == EventKind::kJump ? 0 : 1};
    EXPECT_TRUE(estimator_.submit(event, stamp_).used());
  }

  Estimator estimator_;
  Estimate estimate_;
  bool at_jumps_;
  Neuron neuron_;
  double now_ = 0.0;  // time since kStart
  Stamp stamp_ = kStart;
  int jumps_ = 0;
};

std::string folder() {
  return std::string(SDO_SOURCE_DIR) + "/config/examples/bernard2022_neuron_high_gain/";
}

ObserverConfig shipped() {
  return read_observer_config(
      std::vector<std::string>{folder() + "scenario.yaml", folder() + "observer.yaml",
                               folder() + "gains_printed.yaml"},
      no_plant_plugins);
}

TEST(Bernard2022Neuron, ItsCoordinatesFollowThePlant) {
  // From the true state, without outputs: the observer flows as the plant if and only if T holds
  // its derivatives, Θ inverts T, and Φ is the fourth derivative.
  const ObserverConfig config = shipped();
  Eigen::VectorXd state(config.law->state_size());
  Eigen::VectorXd workspace(config.law->workspace_size());
  config.law->initialize(state.data());
  const Eigen::Vector4d x0(-55.0, -6.0, 0.02, 0.2);
  config.law->observer().start_from(x0.data(), state.data());
  config.law->flow(from_seconds(2.0), state.data(), workspace.data());
  Neuron neuron;
  neuron.flow(2.0);
  EXPECT_NEAR(neuron.x()(0), state(0), 1e-6);
  EXPECT_NEAR(neuron.x()(1), state(1), 1e-6);
  EXPECT_NEAR(0.02, state(2), 1e-7);
  EXPECT_NEAR(0.2, state(3), 1e-6);
  EXPECT_GT(state(0), -46.0);
}

TEST(Bernard2022Neuron, TheParametersAreFoundAsInThePaper) {
  // Holding y_c for 1 ms, half of it on average, delays what the observer sees: that leaves an
  // error of 0.0001 in a and 0.0004 in b (below 0.00001 with 0.1 ms).
  Simulation simulation(shipped(), false);
  simulation.run_until(20.0);
  EXPECT_EQ(1, simulation.jumps());
  const Eigen::VectorXd estimate = simulation.estimate();
  EXPECT_NEAR(0.0200, estimate(2), 1e-4);
  EXPECT_NEAR(0.2000, estimate(3), 4e-4);
  EXPECT_NEAR(simulation.x()(0), estimate(0), 1e-3);
  EXPECT_NEAR(simulation.x()(1), estimate(1), 1e-3);
  simulation.run_until(60.0);
  EXPECT_EQ(2, simulation.jumps());
  EXPECT_NEAR(0.0200, simulation.estimate()(2), 1e-4);
  EXPECT_NEAR(0.2000, simulation.estimate()(3), 5e-4);
}

TEST(Bernard2022Neuron, TheParametersComeBackSoonAfterAJump) {
  // The output before the jump is forgotten at it, so no innovation of its size comes in.
  for (const bool at_jumps : {false, true}) {
    Simulation simulation(shipped(), at_jumps);
    simulation.run_until(45.0);
    EXPECT_EQ(2, simulation.jumps());
    EXPECT_NEAR(0.2000, simulation.estimate()(3), 0.02);
  }
}

TEST(Bernard2022Neuron, TheOriginalFormFindsTheRecoveryVariable) {
  // a and b known: T = (x1, ẋ1) is invertible everywhere.
  const ObserverConfig config = read_observer_config(read_yaml_text(R"(
observer: HighGainObserver
plant:
  states: [x1, x2]
  parameters: {I: 10, a: 0.02, b: 0.2}
  flow: {x1: 0.04*x1^2 + 5*x1 + 140 - x2 + I, x2: a*(b*x1 - x2)}
  jump_map: {formulas: {x1: "-55", x2: x2 + 4}}
sensors: {membrane: {h: [x1], measured: continuous, source: {topic: membrane}}}
sampling: {T1: 0.001, T2: 0.001}
gains:
  form: original
  ell: 4
  K: [2, 1]
  T: [x1, 0.04*x1^2 + 5*x1 + 140 - x2 + I]
  saturations: {x2: [-30, 30]}
initial_estimate: {x1: -50, x2: 0}
)",
                                                                    "neuron.yaml"),
                                                     no_plant_plugins);
  Simulation simulation(config, true);
  simulation.run_until(20.0);
  EXPECT_EQ(1, simulation.jumps());
  EXPECT_NEAR(simulation.x()(1), simulation.estimate()(1), 2e-3);
  simulation.run_until(60.0);
  EXPECT_EQ(2, simulation.jumps());
  EXPECT_NEAR(simulation.x()(0), simulation.estimate()(0), 2e-3);
  EXPECT_NEAR(simulation.x()(1), simulation.estimate()(1), 2e-3);
}

}  // namespace
}  // namespace sampled_data_observers
