#include "simulation/simulator.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace sampled_data_observers {

Simulator::Simulator(Scenario scenario)
    : scenario_(std::move(scenario)),
      plant_(scenario_),
      jump_delivery_(scenario_.jumps ? scenario_.jumps->delivery : Delivery{},
                     stream("jumps/delivery")) {
  using Kind = SimulatedChannel::Kind;
  for (std::size_t i = 0; i < scenario_.sensors.size(); ++i) add_sensor(i);
  for (const SignalScenario& signal : scenario_.signals) add_signal(signal);
  if (scenario_.input) input_channel_ = add_channel(Kind::kInput, scenario_.input->topic);
  if (scenario_.jumps) {
    jump_channel_ = add_channel(Kind::kJump, scenario_.jumps_topic);
    if (scenario_.jumps->schedule) {
      jump_times_.emplace(*scenario_.jumps->schedule, stream("jumps/schedule"));
      next_jump_ = jump_times_->next();
    }
  }
  truth_channel_ = add_channel(Kind::kTruth, scenario_.truth_topic);
  channels_.back().names = scenario_.plant->state_names();
}

std::size_t Simulator::add_channel(SimulatedChannel::Kind kind, const std::string& topic) {
  channels_.push_back({kind, topic, {}});
  return channels_.size() - 1;
}

void Simulator::add_sensor(std::size_t sensor) {
  const SensorScenario& scenario = scenario_.sensors[sensor];
  const std::string name = "sensors/" + scenario_.plant->sensors()[sensor].name;
  SensorStream added{sensor,
                     nullptr,
                     &scenario.noise,
                     std::nullopt,
                     std::nullopt,
                     std::nullopt,
                     stream(name + "/noise"),
                     DeliveryLine(scenario.delivery, stream(name + "/delivery"))};
  if (scenario.topic.empty()) {
    values_in_jumps_ = true;
  } else {
    added.channel = add_channel(SimulatedChannel::Kind::kMeasurement, scenario.topic);
  }
  if (scenario.schedule) {
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
                     ScheduledTimes(signal.schedule, stream(name + "/schedule")),
                     std::nullopt,
                     stream(name + "/noise"),
                     DeliveryLine(signal.delivery, stream(name + "/delivery"))};
  added.next = added.times->next();
  sensors_.push_back(std::move(added));
}

bool Simulator::is_sampled(const SensorStream& stream) const {
  return stream.sensor &&
         scenario_.plant->sensors()[*stream.sensor].timing == SensorTiming::kSampled;
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
  if (jumps && last_jump_ && time - *last_jump_ < scenario_.jumps->min_separation) {
    end_ = End::kZeno;
    return;
  }
  if (scenario_.input && next_input_ == time) change_input();
  if (jumps) jump();
  for (const bool sampled : {false, true}) {
    for (SensorStream& sensor : sensors_) {
      if (sensor.next == time && is_sampled(sensor) == sampled) measure(sensor);
    }
  }
  if (next_truth_ == time) {
    const Eigen::VectorXd& x = plant_.state();
    send(truth_channel_, {x.data(), x.data() + x.size()}, {now()});
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
  send(input_channel_, {u.data(), u.data() + u.size()}, {now()});
  next_input_ += scenario_.input->period;
}

void Simulator::jump() {
  const JumpScenario& scenario = *scenario_.jumps;
  std::size_t next_mode = plant_.mode();
  if (!scenario.modes.empty()) {
    next_mode = *scenario_.plant->find_mode(scenario.modes[jumps_ % scenario.modes.size()]);
  }
  std::vector<double> values;
  std::vector<std::pair<SensorStream*, std::vector<double>>> measured;
  for (SensorStream& sensor : sensors_) {
    if (sensor.times) continue;
    const std::vector<double> y = outputs(sensor);
    if (values_in_jumps_) values.insert(values.end(), y.begin(), y.end());
    if (sensor.channel) measured.emplace_back(&sensor, y);
  }
  plant_.jump(next_mode);
  ++jumps_;
  last_jump_ = plant_.time();
  if (next_jump_ == plant_.time()) next_jump_ = jump_times_->next();
  send(jump_channel_, std::move(values), jump_delivery_.send(now()));
  for (auto& [sensor, y] : measured) {
    send(*sensor->channel, std::move(y), sensor->delivery.send(now()));
  }
}

void Simulator::measure(SensorStream& stream) {
  send(*stream.channel, outputs(stream), stream.delivery.send(now()));
  stream.next = stream.times->next();
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
std::vector<double> Simulator::outputs(SensorStream& stream) {
  const Noise& noise = *stream.added;
  std::vector<double> y = exact_outputs(stream);
  std::vector<double> added(y.size(), 0.0);
  if (noise.kind == Noise::Kind::kFormulas) {
    const double t = to_seconds(plant_.time());
    noise.formulas->evaluate(&t, nullptr, added.data());
  }
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (noise.kind == Noise::Kind::kUniform)
      added[i] = stream.noise.uniform(-noise.size, noise.size);
    if (noise.kind == Noise::Kind::kGaussian) added[i] = noise.size * stream.noise.gaussian();
    y[i] += added[i];
    if (stream.sensor && scenario_.plant->sensors()[*stream.sensor].angular[i]) {
      y[i] = wrap_angle(y[i]);
    }
  }
  return y;
}

void Simulator::send(std::size_t channel, std::vector<double> values,
                     const std::vector<Stamp>& arrivals) {
  SimulatedMessage message;
  message.channel = channel;
  message.stamp = now();
  message.values = std::move(values);
  message.mode = scenario_.plant->modes()[plant_.mode()].label;
  message.jumps = jumps_;
  for (const Stamp arrival : arrivals) {
    message.arrival = arrival;
    message.number = sent_++;
    messages_.push(message);
  }
}

std::string Simulator::describe_end() const {
  char at[64];
  std::snprintf(at, sizeof(at), "%.9f s", to_seconds(plant_.time()));
  switch (end_) {
    case End::kNone:
      return std::string("going on at ") + at;
    case End::kDuration:
      return std::string("ended after its duration, ") + at;
    case End::kZeno:
      return std::string("ended at ") + at +
             ", at a jump closer to the one before than min_separation (Zeno limit)";
    case End::kNotFinite:
      break;
  }
  return std::string("ended at ") + at + ", where the state or the formula `when` is not finite";
}

}  // namespace sampled_data_observers
