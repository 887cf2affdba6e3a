#include "tools/design/simulated_trajectory.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "sampled_data_observers/plant/runge_kutta_flow.h"
#include "simulation/simulator.h"

namespace sampled_data_observers {
namespace {

class PlantField : public VectorField {
 public:
  PlantField(const VectorMap& flow, const Eigen::VectorXd& u) : flow_(flow), u_(u) {}
  void evaluate(const double* x, double* dx) const override { flow_.evaluate(x, u_.data(), dx); }

 private:
  const VectorMap& flow_;
  const Eigen::VectorXd& u_;
};

/// Puts together what the messages of a simulation tell.
class Recorder {
 public:
  explicit Recorder(const Scenario& scenario)
      : plant_(*scenario.plant),
        flow_(plant_.states(), plant_.integration().step),
        x_(scenario.initial_state),
        u_(Eigen::VectorXd::Zero(plant_.inputs())),
        mode_(scenario.initial_mode),
        start_(scenario.start),
        now_(scenario.start) {}

  /// Where the message holds any.
  void change_inputs(const SimulatedChannel& channel, const SimulatedMessage& message) {
    std::size_t value = 0;
    for (const SimulatedReading& reading : channel.readings) {
      if (!reading.input_channel) {
        value += reading.source.size;
        continue;
      }
      flow_to(message.stamp);
      for (const Eigen::Index input : plant_.input_channels()[*reading.input_channel].inputs) {
        u_(input) = message.values[value++];
      }
    }
  }

  void see_truth(const SimulatedMessage& message) {
    const Eigen::Map<const Eigen::VectorXd> x(message.values.data(), plant_.states());
    if (message.stamp > now_) add_step(message.stamp, x, false);
    x_ = x;
  }

  void jump(const SimulatedMessage& message) {
    const Eigen::VectorXd before = flowed_to(message.stamp);
    add_step(message.stamp, before, true);
    const PlantMode& mode = plant_.modes()[mode_];
    if (mode.jump) mode.jump->evaluate(before.data(), u_.data(), x_.data());
    mode_ = plant_.find_mode(message.mode).value_or(mode_);
  }

  std::vector<TrajectoryStep> take() { return std::move(steps_); }

 private:
  Eigen::VectorXd flowed_to(Stamp stamp) const {
    Eigen::VectorXd x = x_;
    if (stamp > now_) {
      flow_.apply(PlantField(*plant_.modes()[mode_].flow, u_), stamp - now_, x.data());
    }
    return x;
  }

  void flow_to(Stamp stamp) {
    if (stamp > now_) add_step(stamp, flowed_to(stamp), false);
  }

  void add_step(Stamp stamp, const Eigen::VectorXd& end, bool jumps) {
    steps_.push_back(
        {to_seconds(now_ - start_), to_seconds(stamp - now_), x_, end, u_, mode_, jumps});
    x_ = end;
    now_ = stamp;
  }

  const Plant& plant_;
  RungeKuttaFlow flow_;
  Eigen::VectorXd x_;
  Eigen::VectorXd u_;
  std::size_t mode_;
  Stamp start_;
  Stamp now_;
  std::vector<TrajectoryStep> steps_;
};

}  // namespace

std::vector<TrajectoryStep> simulated_trajectory(Scenario scenario, std::size_t steps) {
  scenario.truth_period = std::max<Duration>(1, scenario.duration / static_cast<Duration>(steps));
  scenario.signals.clear();
  for (SensorScenario& sensor : scenario.sensors) sensor.delivery = {};
  if (scenario.jumps) {
    scenario.jumps->faults = {};
    scenario.jumps->delivery = {};
  }
  Recorder recorder(scenario);
  Simulator simulator(scenario);
  while (const std::optional<SimulatedMessage> message = simulator.next()) {
    const SimulatedChannel& channel = simulator.channels()[message->channel];
    switch (channel.kind) {
      case SimulatedChannel::Kind::kInput:
      case SimulatedChannel::Kind::kMeasurement:
        recorder.change_inputs(channel, *message);
        break;
      case SimulatedChannel::Kind::kJump:
        recorder.jump(*message);
        break;
      case SimulatedChannel::Kind::kTruth:
        recorder.see_truth(*message);
        break;
      case SimulatedChannel::Kind::kSignal:
        break;
    }
  }
  return recorder.take();
}

}  // namespace sampled_data_observers
