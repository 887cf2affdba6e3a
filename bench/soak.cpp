// One hour of simulated time with ten million events at full speed: memory over time, ticks missed,
// and what became of the events. Some come late, some twice, some are garbage.
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <random>
#include <string>
#include <vector>

#include "messages/runtime_messages.h"
#include "sampled_data_observers/config/event_channels.h"
#include "sampled_data_observers/config/yaml_file.h"
#include "sampled_data_observers/runtime/observer_runtime.h"

namespace sampled_data_observers {
namespace {

constexpr Stamp kStart = 1'600'000'000'000'000'000;
constexpr Duration kHour = 3'600'000'000'000;
constexpr std::int64_t kEvents = 10'000'000;
constexpr Duration kStep = kHour / kEvents;
constexpr int kParts = 10;

// A cart with known acceleration, seen by two sensors.
const char kConfiguration[] = R"(
observer: ConstantGainObserver
plant: {states: [p, v], inputs: [a], A: [[0, 1], [-4, -0.4]], B: [[0], [1]]}
sensors:
  camera: {C: [[1, 0]], source: {topic: camera}}
  encoder: {C: [[0, 1]], source: {topic: encoder}}
input: {topic: acceleration}
sampling: {T1: 0.0001, T2: 1}
gains: {L: {camera: [[0.1], [0.1]], encoder: [[0], [0.05]]}}
rate: 1000
history: {duration: 0.2, max_events: 2000}
future_tolerance: 0.01
)";

/// An event on its way.
struct Message {
  Stamp arrival = 0;
  Stamp stamp = 0;
  std::size_t channel = 0;
  double value = 0.0;

  bool operator>(const Message& other) const { return arrival > other.arrival; }
};

std::size_t resident_kilobytes() {
  std::ifstream file("/proc/self/statm");
  std::size_t size = 0;
  std::size_t resident = 0;
  file >> size >> resident;
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) / 1024;
}

class Soak {
 public:
  Soak()
      : config_(read_observer_config(read_yaml_text(kConfiguration, "soak"), no_plant_plugins)),
        channels_(event_channels(config_)),
        runtime_(config_) {}

  /// Whether every tick came, in order, with a finite estimate.
  bool run() {
    std::printf("%12s %12s %10s %12s %10s\n", "events", "simulated s", "cpu s", "resident kB",
                "estimates");
    for (std::int64_t i = 0; i < kEvents; ++i) {
      const Stamp now = kStart + i * kStep;
      send(now);
      while (!under_way_.empty() && under_way_.top().arrival <= now) {
        receive(under_way_.top(), now);
        under_way_.pop();
      }
      publish(now);
      if ((i + 1) % (kEvents / kParts) != 0) continue;
      const double cpu = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
      std::printf("%12lld %12.0f %10.1f %12zu %10lld\n", static_cast<long long>(i + 1),
                  to_seconds(now - kStart), cpu, resident_kilobytes(),
                  static_cast<long long>(estimates_));
      std::fflush(stdout);
    }
    for (const auto& [reason, count] : outcomes_) std::printf("%12lld %s\n", count, reason);
    std::printf("missed ticks: %lld, estimates that are not finite: %lld\n",
                static_cast<long long>(missed_), static_cast<long long>(not_finite_));
    return missed_ == 0 && not_finite_ == 0;
  }

 private:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }

  void send(Stamp now) {
    Message message{now, now, static_cast<std::size_t>(uniform(0.0, 3.0)), uniform(-1.0, 1.0)};
    const double fate = uniform(0.0, 1.0);
    if (fate < 0.05) message.arrival += from_seconds(uniform(0.0, 0.05));  // late
    if (fate > 0.999) message.value = std::numeric_limits<double>::quiet_NaN();
    if (fate > 0.9985 && fate < 0.999) message.stamp = 0;
    if (fate > 0.998 && fate < 0.9985) message.stamp += from_seconds(60.0);
    if (fate > 0.997 && fate < 0.998) message.arrival += from_seconds(1.0);  // too old
    under_way_.push(message);
    if (fate > 0.05 && fate < 0.06) under_way_.push(message);  // twice
  }

  void receive(const Message& message, Stamp now) {
    const EventChannel& channel = channels_[message.channel];
    Event event;
    event.kind = channel.kind;
    event.sensor = channel.sensor;
    event.stamp = message.stamp;
    event.values = &message.value;
    event.size = 1;
    const EventReport report = runtime_.receive(event, now);
    write(channel, event, report, "", now, status_);
    ++outcomes_[describe(report)];
  }

  void publish(Stamp now) {
    while (const Estimate* estimate = runtime_.next_due(now)) {
      write(runtime_, *estimate, message_);
      if (last_ != 0 && estimate->stamp != last_ + config_.period) ++missed_;
      last_ = estimate->stamp;
      ++estimates_;
      for (const double value : message_.state) not_finite_ += std::isfinite(value) ? 0 : 1;
    }
  }

  const ObserverConfig config_;
  const std::vector<EventChannel> channels_;
  ObserverRuntime runtime_;
  std::mt19937_64 generator_{1};
  std::priority_queue<Message, std::vector<Message>, std::greater<>> under_way_;
  std::map<const char*, long long> outcomes_;
  EventStatus status_;
  StateEstimate message_;
  Stamp last_ = 0;
  std::int64_t estimates_ = 0;
  std::int64_t missed_ = 0;
  std::int64_t not_finite_ = 0;
};

}  // namespace
}  // namespace sampled_data_observers

int main() { return sampled_data_observers::Soak().run() ? EXIT_SUCCESS : EXIT_FAILURE; }
