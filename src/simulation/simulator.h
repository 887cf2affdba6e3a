#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <queue>
#include <string>
#include <utility>
#include <vector>

#include "sampled_data_observers/config/topic_config.h"
#include "simulation/jump_detection.h"
#include "simulation/scenario.h"
#include "simulation/simulated_plant.h"

namespace sampled_data_observers {

/// What an observer reads in the messages of a topic.
struct SimulatedReading {
  TopicSource source;
  /// Of the noise of each value; empty where it is not known.
  Eigen::VectorXd variance = {};
  /// Of inputs: which of the plant's channels they are.
  std::optional<std::size_t> input_channel = {};
};

/// A topic on which a simulation sends.
struct SimulatedChannel {
  enum class Kind { kMeasurement, kSignal, kInput, kJump, kTruth };

  /// That of its first reading.
  Kind kind = Kind::kMeasurement;
  std::string topic;
  /// Of the truth: names of the states.
  std::vector<std::string> names = {};
  /// None for signals and the truth; several where sensors and inputs share messages. A message has
  /// the values of one after the other.
  std::vector<SimulatedReading> readings = {};
};

/// A message that a robot's sensors would send.
struct SimulatedMessage {
  /// Position in Simulator::channels().
  std::size_t channel = 0;
  Stamp stamp = 0;
  /// When it is received.
  Stamp arrival = 0;
  /// The outputs, inputs or true states. Of several readings: one after the other. Of jump events:
  /// the outputs measured at jumps, where any of them has no topic of its own.
  std::vector<double> values;
  /// Label of the mode after a jump.
  int mode = 0;
  /// Number of jumps up to the stamp.
  std::uint64_t jumps = 0;
  /// Its place among the messages sent, which is that among those that arrive together.
  std::uint64_t number = 0;
};

/// Runs a scenario and gives its messages in the order of their arrival. The same scenario gives
/// the same messages, bit for bit.
///
/// What happens at one instant: the input changes, the plant jumps, continuous outputs and samples
/// are taken. So an input is computed from the state before a jump, and outputs from the one after
/// it; outputs measured at jumps are those just before. Jumps that never happen are told of after
/// those that do.
class Simulator {
 public:
  enum class End {
    kNone,      ///< it goes on
    kDuration,  ///< all of it was simulated
    kZeno,      ///< jumps came too close together
    kNotFinite  ///< a state is not finite any more, or the formula `when` has no value
  };

  explicit Simulator(Scenario scenario);
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;

  const Scenario& scenario() const { return scenario_; }
  const std::vector<SimulatedChannel>& channels() const { return channels_; }

  /// The next message; nothing when all were given.
  std::optional<SimulatedMessage> next();

  /// Why the simulation has ended.
  End end() const { return end_; }
  /// The same in words, with the time.
  std::string describe_end() const;
  /// How far it came since the start [ns].
  Duration time() const { return plant_.time(); }
  std::uint64_t jumps() const { return jumps_; }
  /// How many jumps there were and, in words, how many of them were told of wrongly.
  std::string describe_jumps() const;

 private:
  /// A sensor that measures on a schedule or at jumps, or a signal.
  struct SensorStream {
    std::optional<std::size_t> sensor;
    const SignalScenario* signal;
    const Noise* added;
    std::optional<std::size_t> channel;
    /// Whether its values come in the messages of a sensor before it, when that measures.
    bool follows;
    std::optional<ScheduledTimes> times;
    std::optional<Duration> next;
    RandomNumbers noise;
    DeliveryLine delivery;
    /// Of what is measured at jumps that never happened.
    RandomNumbers false_noise;
  };

  /// What is measured at a jump.
  struct JumpOutputs {
    /// What the event carries.
    std::vector<double> values;
    /// What sensors with topics of their own send.
    std::vector<std::pair<SensorStream*, std::vector<double>>> sent;
  };

  struct LaterArrival {
    bool operator()(const SimulatedMessage& a, const SimulatedMessage& b) const {
      return a.arrival != b.arrival ? a.arrival > b.arrival : a.number > b.number;
    }
  };

  RandomNumbers stream(const std::string& name) const { return {scenario_.seed, name}; }
  std::size_t add_channel(SimulatedChannel::Kind kind, const std::string& topic);
  std::size_t add_reading(SimulatedChannel::Kind kind, const SimulatedReading& reading);
  void add_inputs();
  void add_sensor(std::size_t sensor);
  void add_signal(const SignalScenario& signal);
  Duration next_time() const;
  void step();
  void change_input();
  void jump();
  void raise_false_alarm();
  std::string describe_rest() const;
  void measure(SensorStream& stream);
  std::vector<double> values_on(std::size_t channel);
  std::vector<double> exact_outputs(const SensorStream& stream) const;
  std::vector<double> outputs(const SensorStream& stream, RandomNumbers& random) const;
  JumpOutputs jump_outputs(bool is_false);
  void tell(const JumpOutputs& measured, int mode, Stamp stamp);
  SimulatedMessage message_now(std::size_t channel, std::vector<double> values) const;
  void send(SimulatedMessage message, const std::vector<Stamp>& arrivals);
  Stamp now() const { return scenario_.start + plant_.time(); }
  bool is_timed(const SensorStream& stream, SensorTiming timing) const;

  const Scenario scenario_;
  SimulatedPlant plant_;
  std::vector<SimulatedChannel> channels_;
  std::vector<SensorStream> sensors_;
  /// Those whose messages hold nothing but inputs.
  std::vector<std::size_t> input_channels_;
  std::size_t jump_channel_ = 0;
  std::size_t truth_channel_ = 0;
  Duration next_input_ = 0;
  Duration next_truth_ = 0;
  std::optional<ScheduledTimes> jump_times_;
  std::optional<Duration> next_jump_;
  std::optional<Duration> last_jump_;
  bool values_in_jumps_ = false;
  DeliveryLine jump_delivery_;
  JumpDetection detection_;
  std::optional<Duration> rest_since_;
  std::uint64_t jumps_ = 0;
  std::uint64_t sent_ = 0;
  std::priority_queue<SimulatedMessage, std::vector<SimulatedMessage>, LaterArrival> messages_;
  End end_ = End::kNone;
};

}  // namespace sampled_data_observers
