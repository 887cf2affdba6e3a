#include "simulation/simulator.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "simulation/topic_check.h"

namespace sampled_data_observers {

Simulator::Simulator(Scenario scenario)
    : scenario_(std::move(scenario)),
      plant_(scenario_),
      jump_delivery_(scenario_.jumps ? scenario_.jumps->delivery : Delivery{},
                     stream("jumps/delivery")),
      detection_(scenario_.jumps ? scenario_.jumps->faults : DetectionFaults{},
                 stream("jumps/detection"), stream("jumps/false")) {
  using Kind = SimulatedChannel::Kind;
  for (std::size_t i = 0; i < scenario_.sensors.size(); ++i) add_sensor(i);
  for (const SignalScenario& signal : scenario_.signals) add_signal(signal);
  if (scenario_.input) add_inputs();
  if (scenario_.jumps) {
    jump_channel_ = add_reading(Kind::kJump, {scenario_.jumps_source});
    if (scenario_.jumps->schedule) {
      jump_times_.emplace(*scenario_.jumps->schedule, stream("jumps/schedule"));
      next_jump_ = jump_times_->next();
    }
  }
  truth_channel_ = add_channel(Kind::kTruth, scenario_.truth_topic);
  channels_.back().names = scenario_.plant->state_names();
}

std::size_t Simulator::add_channel(SimulatedChannel::Kind kind, const std::string& topic) {
  channels_.push_back({kind, topic});
  return channels_.size() - 1;
}

/// To the channel of those that share its messages, or to one of its own.
std::size_t Simulator::add_reading(SimulatedChannel::Kind kind, const SimulatedReading& reading) {
  const auto found =
      std::find_if(channels_.begin(), channels_.end(), [&](const SimulatedChannel& channel) {
        return !channel.readings.empty() &&
               share_messages(channel.readings.front().source, reading.source);
      });
  const std::size_t channel = found != channels_.end()
                                  ? static_cast<std::size_t>(found - channels_.begin())
                                  : add_channel(kind, reading.source.topic);
  channels_[channel].readings.push_back(reading);
  return channel;
}

void Simulator::add_inputs() {
  const std::vector<TopicSource>& sources = scenario_.input->sources;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const std::size_t channel = add_reading(SimulatedChannel::Kind::kInput, {sources[i], {}, i});
    const bool is_new = channels_[channel].readings.size() == 1;
    if (is_new) input_channels_.push_back(channel);
  }
}

void Simulator::add_sensor(std::size_t sensor) {
  const SensorScenario& scenario = scenario_.sensors[sensor];
  const std::string name = "sensors/" + scenario_.plant->sensors()[sensor].name;
  SensorStream added{sensor,
                     nullptr,
                     &scenario.noise,
                     std::nullopt,
                     false,
                     std::nullopt,
                     std::nullopt,
                     stream(name + "/noise"),
                     DeliveryLine(scenario.delivery, stream(name + "/delivery")),
                     stream(name + "/false_noise")};
  if (scenario.source) {
    added.channel = add_reading(SimulatedChannel::Kind::kMeasurement,
                                {*scenario.source, variance_of(scenario.noise)});
    added.follows = channels_[*added.channel].readings.size() > 1;
  } else {
    values_in_jumps_ = true;
  }
  if (scenario.schedule && !added.follows) {
    added.times.emplace(*scenario.schedule, stream(name + "/schedule"));
    added.next = added.times->next();
  }
  sensors_.push_back(std::move(added));
}

void Simulator::add_signal(const SignalScenario& signal) {
  const std::string name = "signals/" + signal.name;
  SensorStream added{std::nullopt,
                     &signal,
                     &signal.noise,
                     add_channel(SimulatedChannel::Kind::kSignal, signal.topic),
                     false,
                     ScheduledTimes(signal.schedule, stream(name + "/schedule")),
                     std::nullopt,
                     stream(name + "/noise"),
                     DeliveryLine(signal.delivery, stream(name + "/delivery")),
                     stream(name + "/false_noise")};
  added.next = added.times->next();
  sensors_.push_back(std::move(added));
}

bool Simulator::is_timed(const SensorStream& stream, SensorTiming timing) const {
  return stream.sensor && scenario_.plant->sensors()[*stream.sensor].timing == timing;
}

std::optional<SimulatedMessage> Simulator::next() {
  while (end_ == End::kNone && (messages_.empty() || messages_.top().arrival > now())) step();
  if (messages_.empty()) return std::nullopt;
  SimulatedMessage message = messages_.top();
  messages_.pop();
  return message;
}

Duration Simulator::next_time() const {
  Duration next = std::min(scenario_.duration, next_truth_);
  if (scenario_.input) next = std::min(next, next_input_);
  if (next_jump_) next = std::min(next, *next_jump_);
  if (detection_.false_alarm()) next = std::min(next, *detection_.false_alarm());
  for (const SensorStream& sensor : sensors_) {
    if (sensor.next) next = std::min(next, *sensor.next);
  }
  return next;
}

/// Goes to the next instant at which something happens, and lets it happen.
void Simulator::step() {
  const bool crossed = plant_.flow_to(next_time());
  const Duration time = plant_.time();
  if (!plant_.is_finite()) {
    end_ = End::kNotFinite;
    return;
  }
  const bool jumps = crossed || next_jump_ == time;
  const bool too_soon = jumps && last_jump_ && time - *last_jump_ < scenario_.jumps->min_separation;
  if (too_soon && !scenario_.jumps->rest) {
    end_ = End::kZeno;
    return;
  }
  if (scenario_.input && next_input_ == time) change_input();
  if (too_soon) {
    plant_.rest();
    rest_since_ = time;
  } else if (jumps) {
    jump();
  }
  if (detection_.false_alarm() == time) raise_false_alarm();
  for (const bool sampled : {false, true}) {
    for (SensorStream& sensor : sensors_) {
      const bool is_sampled = is_timed(sensor, SensorTiming::kSampled);
      if (sensor.next == time && is_sampled == sampled) measure(sensor);
    }
  }
  if (next_truth_ == time) {
    const Eigen::VectorXd& x = plant_.state();
    send(message_now(truth_channel_, {x.data(), x.data() + x.size()}), {now()});
    next_truth_ += scenario_.truth_period;
  }
  if (time == scenario_.duration) end_ = End::kDuration;
}

void Simulator::change_input() {
  Eigen::VectorXd arguments(1 + plant_.state().size());
  arguments << to_seconds(plant_.time()), plant_.state();
  Eigen::VectorXd u(plant_.input().size());
  scenario_.input->formulas->evaluate(arguments.data(), nullptr, u.data());
  plant_.set_input(u);
  for (const std::size_t channel : input_channels_) {
    send(message_now(channel, values_on(channel)), {now()});
  }
  next_input_ += scenario_.input->period;
}

void Simulator::jump() {
  const JumpScenario& scenario = *scenario_.jumps;
  std::size_t next_mode = plant_.mode();
  if (!scenario.modes.empty()) {
    next_mode = *scenario_.plant->find_mode(scenario.modes[jumps_ % scenario.modes.size()]);
  }
  const JumpOutputs measured = jump_outputs(false);
  plant_.jump(next_mode);
  ++jumps_;
  last_jump_ = plant_.time();
  if (next_jump_ == plant_.time()) next_jump_ = jump_times_->next();
  const int mode = scenario_.plant->modes()[plant_.mode()].label;
  for (const Duration error : detection_.tell()) {
    tell(measured, mode, std::max(scenario_.start, now() + error));
  }
}

/// Tells of a jump that is none: into any other mode where the plant switches.
void Simulator::raise_false_alarm() {
  const JumpOutputs measured = jump_outputs(true);
  const std::vector<PlantMode>& modes = scenario_.plant->modes();
  std::size_t mode = plant_.mode();
  if (modes.size() > 1) {
    const std::size_t other = detection_.choose(modes.size() - 1);
    mode = other < mode ? other : other + 1;
  }
  tell(measured, modes[mode].label, now());
  detection_.pass_false_alarm();
}

/// What is measured in the present state, before a jump.
Simulator::JumpOutputs Simulator::jump_outputs(bool is_false) {
  JumpOutputs result;
  for (SensorStream& sensor : sensors_) {
    if (!is_timed(sensor, SensorTiming::kAtJumps)) continue;
    const std::vector<double> y = outputs(sensor, is_false ? sensor.false_noise : sensor.noise);
    if (values_in_jumps_) result.values.insert(result.values.end(), y.begin(), y.end());
    if (!sensor.channel) continue;
    if (!sensor.follows) {
      result.sent.emplace_back(&sensor, y);
      continue;
    }
    const auto shared = std::find_if(result.sent.begin(), result.sent.end(), [&](const auto& sent) {
      return sent.first->channel == sensor.channel;
    });
    shared->second.insert(shared->second.end(), y.begin(), y.end());
  }
  return result;
}

/// Nothing is told of before it has happened, nor before its stamp.
void Simulator::tell(const JumpOutputs& measured, int mode, Stamp stamp) {
  const Stamp departure = std::max(now(), stamp);
  const auto told = [&](std::size_t channel, const std::vector<double>& values) {
    SimulatedMessage message = message_now(channel, values);
    message.stamp = stamp;
    message.mode = mode;
    return message;
  };
  send(told(jump_channel_, measured.values), jump_delivery_.send(departure));
  for (const auto& [sensor, y] : measured.sent) {
    send(told(*sensor->channel, y), sensor->delivery.send(departure));
  }
}

void Simulator::measure(SensorStream& stream) {
  send(message_now(*stream.channel, values_on(*stream.channel)), stream.delivery.send(now()));
  stream.next = stream.times->next();
}

/// Of all that is read there, as it is now: of sensors, then of inputs, which are added later.
std::vector<double> Simulator::values_on(std::size_t channel) {
  std::vector<double> values;
  for (SensorStream& stream : sensors_) {
    if (stream.channel != channel) continue;
    const std::vector<double> y = outputs(stream, stream.noise);
    values.insert(values.end(), y.begin(), y.end());
  }
  for (const SimulatedReading& reading : channels_[channel].readings) {
    if (!reading.input_channel) continue;
    for (const Eigen::Index input :
         scenario_.plant->input_channels()[*reading.input_channel].inputs) {
      values.push_back(plant_.input()(input));
    }
  }
  return values;
}

std::vector<double> Simulator::exact_outputs(const SensorStream& stream) const {
  std::vector<double> y;
  if (stream.sensor) {
    y.resize(static_cast<std::size_t>(scenario_.plant->sensors()[*stream.sensor].outputs()));
    plant_.measure(*stream.sensor, y.data());
  } else {
    Eigen::VectorXd arguments(1 + plant_.state().size());
    arguments << to_seconds(plant_.time()), plant_.state();
    y.resize(static_cast<std::size_t>(stream.signal->formulas->size()));
    stream.signal->formulas->evaluate(arguments.data(), nullptr, y.data());
  }
  return y;
}

/// The outputs of a sensor with its noise; angles as sensors give them, in (−π, π].
std::vector<double> Simulator::outputs(const SensorStream& stream, RandomNumbers& random) const {
  const Noise& noise = *stream.added;
  std::vector<double> y = exact_outputs(stream);
  std::vector<double> added(y.size(), 0.0);
  if (noise.kind == Noise::Kind::kFormulas) {
    const double t = to_seconds(plant_.time());
    noise.formulas->evaluate(&t, nullptr, added.data());
  }
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double size = noise.size.size() == 0 ? 0.0 : noise.size(static_cast<Eigen::Index>(i));
    if (noise.kind == Noise::Kind::kUniform) added[i] = random.uniform(-size, size);
    if (noise.kind == Noise::Kind::kGaussian) added[i] = size * random.gaussian();
    y[i] += added[i];
    if (stream.sensor && scenario_.plant->sensors()[*stream.sensor].angular[i]) {
      y[i] = wrap_angle(y[i]);
    }
  }
  return y;
}

/// Of the present time, mode and number of jumps.
SimulatedMessage Simulator::message_now(std::size_t channel, std::vector<double> values) const {
  SimulatedMessage message;
  message.channel = channel;
  message.stamp = now();
  message.values = std::move(values);
  message.mode = scenario_.plant->modes()[plant_.mode()].label;
  message.jumps = jumps_;
  return message;
}

void Simulator::send(SimulatedMessage message, const std::vector<Stamp>& arrivals) {
  for (const Stamp arrival : arrivals) {
    message.arrival = arrival;
    message.number = sent_++;
    messages_.push(message);
  }
}

std::string Simulator::describe_rest() const {
  if (!rest_since_) return "";
  char text[64];
  std::snprintf(text, sizeof(text), ", at rest since %.9f s", to_seconds(*rest_since_));
  return text;
}

std::string Simulator::describe_jumps() const {
  std::string text = std::to_string(jumps_) + " jumps";
  const DetectionTally& tally = detection_.tally();
  if (tally.is_empty()) return text;
  return text + ", of which " + std::to_string(tally.missed) + " were not told of, " +
         std::to_string(tally.doubled) + " twice, " + std::to_string(tally.off) +
         " with stamps that are off; " + std::to_string(tally.false_alarms) +
         " told of that never happened";
}

std::string Simulator::describe_end() const {
  char at[64];
  std::snprintf(at, sizeof(at), "%.9f s", to_seconds(plant_.time()));
  switch (end_) {
    case End::kNone:
      return std::string("going on at ") + at;
    case End::kDuration:
      return std::string("ended after its duration, ") + at + describe_rest();
    case End::kZeno:
      return std::string("ended at ") + at +
             ", at a jump closer to the one before than min_separation (Zeno limit)";
    case End::kNotFinite:
      break;
  }
  return std::string("ended at ") + at + ", where the state or the formula `when` is not finite";
}

}  // namespace sampled_data_observers
