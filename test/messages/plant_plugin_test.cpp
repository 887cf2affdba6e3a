#include <gtest/gtest.h>

#include <cmath>

#include "messages/plant_plugins.h"
#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/config/yaml_file.h"
#include "sampled_data_observers/plant/runge_kutta_flow.h"
#include "sampled_data_observers/runtime/estimator.h"
#include "support/allocation_counter.h"

namespace sampled_data_observers {
namespace {

constexpr Stamp kStart = 1000 * kNanosecondsPerSecond;

ObserverConfig shipped() {
  return read_observer_config(
      std::vector<std::string>{std::string(SDO_SOURCE_DIR) + "/config/pendulum.yaml"},
      load_plant_plugin);
}

/// The fault of the shipped configuration with `from` replaced by `to`.
std::string fault(const std::string& from, const std::string& to) {
  std::string text = R"(
observer: ConstantGainObserver
plant: {plugin: sampled_data_observers/Pendulum, parameters: {gravity: 9.81, length: 0.5, damping: 0.2}}
sensors: {camera: {output: angle, source: {topic: camera}}}
sampling: {T1: 0.05, T2: 0.15}
gains: {L: [[0.8], [4]]}
)";
  text.replace(text.find(from), from.size(), to);
  try {
    read_observer_config(read_yaml_text(text, "p.yaml"), load_plant_plugin);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(PlantPluginTest, ACompiledPlantIsObserved) {
  const ObserverConfig config = shipped();
  EXPECT_EQ((std::vector<std::string>{"angle", "rate"}), config.plant->state_names());
  class Truth : public VectorField {
   public:
    void evaluate(const double* x, double* dx) const override {
      dx[0] = x[1];
      dx[1] = -9.81 / 0.5 * std::sin(x[0]) - 0.2 * x[1];
    }
  };
  const RungeKuttaFlow flow(2, kNanosecondsPerSecond / 1000);
  double x[] = {2.0, 0.0};
  Estimator estimator(config.law, config.options);
  Estimate estimate = estimator.make_estimate();
  const std::size_t before = test::allocations();
  for (Stamp now = kStart; now < kStart + 5 * kNanosecondsPerSecond;
       now += kNanosecondsPerSecond / 10) {
    const double y = std::remainder(x[0], 2.0 * std::acos(-1.0));
    ASSERT_TRUE(estimator.submit({now, EventKind::kSample, 0, &y, 1, 0}, now).used());
    flow.apply(Truth(), kNanosecondsPerSecond / 10, x);
    estimator.estimate_at(now + kNanosecondsPerSecond / 10, estimate);
  }
  EXPECT_EQ(before, test::allocations());
  EXPECT_NEAR(x[1], estimate.state(1), 1e-4);
  EXPECT_NEAR(0.0, std::remainder(x[0] - estimate.state(0), 2.0 * std::acos(-1.0)), 1e-4);
}

TEST(PlantPluginTest, FaultsNameThePlugInAndWhatItNeeds) {
  EXPECT_NE(std::string::npos, fault("/Pendulum", "/Pendulun").find("p.yaml:3: plant/plugin"));
  EXPECT_NE(std::string::npos,
            fault("/Pendulum", "/Pendulun").find("there are: sampled_data_observers/Pendulum"));
  EXPECT_NE(std::string::npos, fault("length: 0.5, ", "").find("'length'"));
  EXPECT_NE(std::string::npos, fault("gravity: 9.81", "gravity: -1").find("'gravity'"));
  EXPECT_NE(std::string::npos, fault("damping", "drag").find("'damping'"));
  EXPECT_NE(std::string::npos, fault("damping: 0.2", "damping: 0.2, drag: 1").find("no others"));
  EXPECT_NE(std::string::npos, fault("output: angle", "output: end").find("angle, bob"));
}

}  // namespace
}  // namespace sampled_data_observers
