#include "faults/configurations.h"

#include "faults/fault_bench.h"
#include "faults/messages.h"

namespace sampled_data_observers::test {
namespace {

std::string own(const std::string& file) { return "test/faults/configurations/" + file; }

Configuration oscillating(const std::string& name, const std::vector<std::string>& files) {
  Configuration configuration;
  configuration.name = name;
  for (const std::string& file : files) configuration.files.push_back(own(file));
  configuration.sample = [](FaultBench& bench, Stamp stamp, double p) {
    bench.publish("position", measurement(stamp, {p}));
  };
  return configuration;
}

Configuration with(Configuration configuration,
                   std::function<void(FaultBench&, Stamp, double)> sample) {
  configuration.sample = std::move(sample);
  return configuration;
}

Configuration at_rest(const std::string& name, double level) {
  Configuration configuration = oscillating(name, {name + ".yaml"});
  configuration.flow = rest();
  configuration.start = {level};
  configuration.push = {0.0};  // anywhere else it would not stay
  configuration.has_input = false;
  return configuration;
}

Configuration certified(const std::string& name, const std::string& last) {
  Configuration configuration = oscillating(name, {last});
  configuration.type = "IntersampleInjectionObserver";
  configuration.files.insert(configuration.files.end(),
                             {"config/examples/ferrante2019_oscillator/plant.yaml",
                              "test/certificate/ferrante2019_oscillator_0.2.yaml"});
  configuration.flow = oscillator(2.0);
  configuration.has_input = false;
  configuration.period = 150'000'000;
  configuration.tolerance = 0.02;
  return configuration;
}

/// The turntable stands still, but is published anew with each sample, as a moving one is.
void sample_camera(FaultBench& bench, Stamp stamp, double p) {
  bench.publish("/tf", turntable(stamp), 0);
  bench.publish("camera", point_ahead(stamp, "lens", p));
}

/// By an IMU whose messages say how sure it is.
Configuration filtered() {
  Configuration configuration = oscillating("filtered", {"filtered.yaml"});
  configuration.type = "HybridKalmanFilter";
  configuration.sample = [](FaultBench& bench, Stamp stamp, double p) {
    sensor_msgs::Imu message = heading(stamp, p);
    message.orientation_covariance[8] = 1e-4;
    bench.publish("imu", message);
  };
  return configuration;
}

std::vector<Configuration> all_configurations() {
  const auto joint = [](FaultBench& bench, Stamp stamp, double p) {
    bench.publish("joint_states", joint_state(stamp, {"caster", "wheel"}, {0.0, p}));
  };
  const auto imu = [](FaultBench& bench, Stamp stamp, double p) {
    bench.publish("imu", heading(stamp, p));
  };
  return {
      oscillating("oscillator", {"oscillator.yaml", "jumps.yaml", "position.yaml"}),
      oscillating("looping", {"oscillator.yaml", "jumps.yaml", "position.yaml", "looping.yaml"}),
      oscillating("gated", {"oscillator.yaml", "jumps.yaml", "gated.yaml"}),
      oscillating("guarded", {"oscillator.yaml", "jumps.yaml", "position.yaml", "guarded.yaml"}),
      oscillating("thinned", {"oscillator.yaml", "jumps.yaml", "thinned.yaml"}),
      oscillating("contact", {"oscillator.yaml", "contact.yaml", "position.yaml"}),
      oscillating("switched", {"switched.yaml", "position.yaml"}),
      with(oscillating("joint", {"oscillator.yaml", "jumps.yaml", "joint.yaml"}), joint),
      with(oscillating("imu", {"oscillator.yaml", "jumps.yaml", "imu.yaml"}), imu),
      with(oscillating("camera", {"oscillator.yaml", "jumps.yaml", "camera.yaml"}), sample_camera),
      filtered(),
      at_rest("unstable", 0.0),
      at_rest("tank", 1.0),
      certified("certified", "rate.yaml"),
      certified("bounded", "error_assumptions.yaml"),
  };
}

}  // namespace

const Configuration& configuration(const std::string& name) {
  static const std::vector<Configuration> kAll = all_configurations();
  for (const Configuration& configuration : kAll) {
    if (configuration.name == name) return configuration;
  }
  throw std::out_of_range("no configuration " + name);
}

}  // namespace sampled_data_observers::test
