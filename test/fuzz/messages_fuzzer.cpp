// Whatever bytes come as messages, the estimate stays finite. An input is a list of messages: the
// channel, the length (two bytes), and the message as roscpp sends it.
#include <ros/exception.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "messages/runtime_messages.h"
#include "sampled_data_observers/config/event_channels.h"
#include "sampled_data_observers/config/yaml_file.h"
#include "sampled_data_observers/messages/message_source.h"
#include "sampled_data_observers/runtime/observer_runtime.h"

using namespace sampled_data_observers;

namespace {

constexpr Stamp kStart = 1000 * kNanosecondsPerSecond;
constexpr Duration kStep = kNanosecondsPerSecond / 10;

// A message may announce 4e9 values that do not follow, and roscpp makes room for them before it
// looks; it catches what that throws. So does this program, but sooner.
constexpr std::size_t kLargestAllocation = std::size_t{1} << 22;
bool allocation_is_limited = false;

// Small, so that an input takes little time.
const char* const kCommon = "\nrate: 5\nhistory: {duration: 2, max_events: 20}\n";

const char* const kConfigurations[] = {R"yaml(
observer: HybridKalmanFilter
plant: {states: [p, v], inputs: [u], A: [[0, 1], [-2, -0.1]], B: [[0], [1]], jump_map: {A_d: [[1, 0], [0, -0.8]]}}
sensors:
  d: {C: [[0, 1]], measured: at_jumps, source: {topic: d}}
  s: {C: [[1, 0.3]], angular: [true], source: {topic: s}, gate: {mahalanobis: 3, recovery: {after: 1, action: reset}}}
sampling: {T1: 0.1, T2: 1}
gains: {P0: [[1, 0], [0, 2]], R: {d: [[0.1]], s: [[0.3]]}, Q: [[0, 0], [0, 0.5]], Q_d: [[0, 0], [0, 0.2]]}
)yaml",
                                       R"yaml(
observer: ConstantGainObserver
plant: {states: [p, v], flow: {p: v, v: "-sin(p) - v*sqrt(abs(v))"}, jump_map: {formulas: {p: p, v: -0.8*v}}, integration: {step: 0.05, horizon: 10}}
sensors:
  a: {C: [[1, 0], [0, 1]], source: {topic: a, type: geometry_msgs/PointStamped, fields: [point.x, point.y]}}
  b: {C: [[1, 0]], angular: [true], source: {topic: b, type: geometry_msgs/PoseStamped, fields: [pose.orientation.z]}, gate: {innovation: 0.5, recovery: {after: 1, action: accept}}}
jumps: {late: delayed}
sampling: {T1: 0.1, T2: 1}
gains: {L: {a: [[0.5, 0], [0, 0.2]], b: [[0.3], [0.1]]}}
)yaml",
                                       R"yaml(
observer: SwitchedObserver
plant:
  states: [p, v]
  modes:
    1: {A: [[0, 1], [-2, -0.1]], jump_map: {A_d: [[1, 0], [0, -0.8]]}}
    2: {A: [[0, 1], [-1, 0]], b: [0, 0.2]}
sensors:
  c: {C: [[1, 0]], measured: continuous, source: {topic: c}}
  e: {C: [[1, 0], [0, 1]], measured: at_jumps}
sampling: {T1: 0.1, T2: 1}
gains:
  L_c: {1: [[0.8], [0.5]], 2: [[1.2], [0.1]]}
  L_d: {1: {e: [[0.2, 0], [0, -0.2]]}, 2: {e: [["tau/(1 + tau)", 0], [0, 0]]}}
)yaml",
                                       R"yaml(
observer: ConstantGainObserver
plant: {states: [x, y, yaw], inputs: [v, w], flow: {x: "v*cos(yaw)", y: "v*sin(yaw)", yaw: "w"}, jump_map: {formulas: {x: x, y: y, yaw: yaw}}, integration: {step: 0.05, horizon: 10}}
input: {topic: i, type: nav_msgs/Odometry, fields: [twist.twist.linear.x, pose.pose.orientation.pitch]}
sensors:
  a: {h: [yaw], angular: [true], source: {topic: a, type: sensor_msgs/Imu, fields: [orientation.yaw], min_interval: 0.3}}
  b: {h: [x], source: {topic: b, type: sensor_msgs/JointState, fields: [position.wheel]}}
  d: {h: [x], source: {topic: d, type: sensor_msgs/LaserScan, fields: [ranges.3]}}
  c: {h: [y], source: {topic: c, type: std_msgs/Float64MultiArray, fields: [data.1], stamp: receipt}}
jumps: {detector: {source: {topic: j, type: geometry_msgs/WrenchStamped, fields: {f: wrench.force.z, t: wrench.torque.x}}, signal: f + t^2, threshold: 5, hysteresis: 1}}
sampling: {T1: 0.1, T2: 1}
gains: {L: {a: [[0], [0], [1]], b: [[0.5], [0], [0]], c: [[0], [0.5], [0.1]], d: [[0.1], [0], [0]]}}
)yaml"};

/// One observer and its channels, each of which turns bytes into an event.
class Observer {
 public:
  explicit Observer(const std::string& text)
      : config_(
            read_observer_config(read_yaml_text(text + kCommon, "fuzz.yaml"), no_plant_plugins)) {
    for (const EventChannel& channel : event_channels(config_)) {
      const std::shared_ptr<MessageSource> source = make_message_source(channel.source);
      channels_.push_back([this, channel, source](std::uint8_t* data, std::uint32_t size) {
        allocation_is_limited = true;
        const MessagePointer message = source->deserialize(data, size, nullptr);
        allocation_is_limited = false;
        Event event;
        event.kind = channel.kind;
        event.sensor = channel.sensor;
        if (source->read(message, now_, event) != Reading::kEvent) return;
        EventStatus status;
        write(channel, event, runtime_->receive(event, now_), "", now_, status);
      });
    }
  }

  void start() {
    runtime_.emplace(config_);
    now_ = kStart;
  }

  void receive(std::uint8_t channel, std::uint8_t* data, std::uint32_t size) {
    now_ += kStep;
    try {
      channels_[channel % channels_.size()](data, size);
    } catch (const ros::Exception&) {
    } catch (const std::bad_alloc&) {
    }
    allocation_is_limited = false;
    while (const Estimate* estimate = runtime_->next_due(now_)) check(*estimate);
  }

 private:
  void check(const Estimate& estimate) {
    StateEstimate message;
    write(*runtime_, estimate, message);
    for (const double value : message.state) require_finite(value);
    for (const double value : message.covariance) require_finite(value);
  }

  static void require_finite(double value) {
    if (!std::isfinite(value)) std::abort();
  }

  ObserverConfig config_;
  std::optional<ObserverRuntime> runtime_;
  std::vector<std::function<void(std::uint8_t*, std::uint32_t)>> channels_;
  Stamp now_ = kStart;
};

}  // namespace

void* operator new(std::size_t size) {
  const bool is_refused = allocation_is_limited && size > kLargestAllocation;
  void* memory = is_refused ? nullptr : std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return std::malloc(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static std::vector<std::unique_ptr<Observer>> observers = [] {
    std::vector<std::unique_ptr<Observer>> all;
    for (const char* text : kConfigurations) all.push_back(std::make_unique<Observer>(text));
    return all;
  }();
  if (size == 0) return 0;
  std::vector<std::uint8_t> bytes(data, data + size);
  Observer& observer = *observers[bytes[0] % observers.size()];
  observer.start();
  std::size_t at = 1;
  while (at + 3 <= size) {
    const std::uint8_t channel = bytes[at];
    const std::size_t announced = bytes[at + 1] + 256u * bytes[at + 2];
    at += 3;
    const std::size_t length = std::min(announced, size - at);
    observer.receive(channel, bytes.data() + at, static_cast<std::uint32_t>(length));
    at += length;
  }
  return 0;
}
