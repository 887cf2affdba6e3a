#include "ros/plant_simulator.h"

#include <rosgraph_msgs/Clock.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <string>
#include <utility>

#include "messages/plant_plugins.h"
#include "ros/parameter_tree.h"
#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/ros/node_log.h"
#include "simulation/scenario_config.h"

namespace sampled_data_observers {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr std::uint32_t kPublisherQueue = 2000;

/// The clock goes on that long after the last message, for estimates that are published late.
constexpr Duration kAfterEnd = kNanosecondsPerSecond;

/// Period of /clock: one simulated millisecond, but no more than 2000 a second, which roscpp's
/// timers would not heed, nor less than 200.
constexpr double kTick = 1e-3;
constexpr double kShortestTick = 0.5e-3;
constexpr double kLongestTick = 5e-3;

/// A machine that stalls for longer slows simulated time down instead of letting it leap.
constexpr std::chrono::milliseconds kTolerance{5};

constexpr double kPoll = 0.01;

}  // namespace

PlantSimulatorNodelet::~PlantSimulatorNodelet() {
  running_ = false;
  if (thread_.joinable()) thread_.join();
}

void PlantSimulatorNodelet::onInit() {
  try {
    ConfigNode tree = read_parameter_tree(getPrivateNodeHandle());
    options_ = read_options(tree);
    const Scenario scenario = read_scenario(tree, load_plant_plugin);
    for (const std::string& warning : scenario.warnings) {
      NodeLog(getName()).warn("%s", warning.c_str());
    }
    simulator_ = std::make_unique<Simulator>(scenario);
    messages_ = std::make_unique<const SimulatedMessages>(simulator_->channels(), scenario.navsat);
    start();
  } catch (const std::exception& error) {
    NodeLog(getName()).fatal("not started: %s", error.what());
    publishers_.clear();
    clock_publisher_ = ros::Publisher();
    throw;
  }
}

/// Takes its own keys out of the tree; what is left is the scenario.
PlantSimulatorNodelet::Options PlantSimulatorNodelet::read_options(ConfigNode& tree) const {
  ConfigNode own;
  own.kind = ConfigNode::Kind::kMap;
  own.origin = tree.origin;
  const auto is_own = [](const auto& entry) {
    return entry.first == "clock_speed" || entry.first == "wait_for_subscribers" ||
           entry.first == "delay";
  };
  std::copy_if(tree.entries.begin(), tree.entries.end(), std::back_inserter(own.entries), is_own);
  tree.entries.erase(std::remove_if(tree.entries.begin(), tree.entries.end(), is_own),
                     tree.entries.end());
  ConfigSection section(own, "");
  Options options;
  options.clock_speed = section.number_in("clock_speed", 0.0, 1000.0, 0.0);
  options.delay = section.number_in("delay", 0.0, 1000.0, options.delay);
  if (section.has("wait_for_subscribers")) {
    options.wait_for_subscribers =
        section.choice("wait_for_subscribers", {"true", "false"}) == "true";
  }
  if (options.clock_speed > 0.0 && !ros::Time::isSimTime()) {
    throw section.error("clock_speed", "the parameter /use_sim_time to be true beside it",
                        "wall time");
  }
  return options;
}

void PlantSimulatorNodelet::start() {
  ros::NodeHandle& handle = getNodeHandle();
  for (std::size_t i = 0; i < simulator_->channels().size(); ++i) {
    publishers_.push_back(messages_->advertise(i, handle, kPublisherQueue));
  }
  if (options_.clock_speed > 0.0) {
    clock_publisher_ = handle.advertise<rosgraph_msgs::Clock>("/clock", 1);
  }
  running_ = true;
  thread_ = std::thread([this] { run(); });
}

void PlantSimulatorNodelet::run() {
  if (!wait_for_subscribers()) return;
  if (options_.clock_speed > 0.0) {
    run_own_clock();
  } else {
    run_by_clock();
  }
  if (!running_) return;
  NodeLog(getName()).info("the simulation %s; %s", simulator_->describe_end().c_str(),
                          simulator_->describe_jumps().c_str());
  pause(0.5);  // lets the last messages reach recorders
  const bool is_own_node = getName() == ros::this_node::getName();
  if (running_ && is_own_node) ros::requestShutdown();
}

bool PlantSimulatorNodelet::wait_for_subscribers() {
  const auto first_without = [this]() -> const ros::Publisher* {
    for (std::size_t i = 0; i < publishers_.size(); ++i) {
      const SimulatedChannel::Kind kind = simulator_->channels()[i].kind;
      const bool may_be_unheard =
          kind == SimulatedChannel::Kind::kTruth || kind == SimulatedChannel::Kind::kSignal;
      if (!may_be_unheard && publishers_[i].getNumSubscribers() == 0) return &publishers_[i];
    }
    return nullptr;
  };
  SteadyClock::time_point next_report = SteadyClock::now() + std::chrono::seconds(2);
  while (options_.wait_for_subscribers && running_) {
    const ros::Publisher* publisher = first_without();
    if (publisher == nullptr) break;
    if (SteadyClock::now() >= next_report) {
      NodeLog(getName()).info("waiting for a subscriber of %s", publisher->getTopic().c_str());
      next_report += std::chrono::seconds(10);
    }
    pause(kPoll);
  }
  return running_;
}

/// Waits in wall time, with /clock standing at the time it has come to, or its start.
void PlantSimulatorNodelet::pause(double seconds) {
  const auto end = SteadyClock::now() + std::chrono::duration<double>(seconds);
  while (running_ && SteadyClock::now() < end) {
    if (last_arrival_ == 0) set_clock(simulator_->scenario().start);
    ros::WallDuration(std::min(seconds, kPoll)).sleep();
  }
}

Stamp PlantSimulatorNodelet::end_of_clock() const {
  return std::max(last_arrival_, simulator_->scenario().start + offset_ + simulator_->time()) +
         kAfterEnd;
}

void PlantSimulatorNodelet::run_by_clock() {
  while (running_ && !ros::Time::isValid()) ros::WallDuration(kPoll).sleep();
  const Stamp ready = to_stamp(ros::Time::now()) + from_seconds(options_.delay);
  const Stamp start = first_multiple_from(ready, kNanosecondsPerSecond);
  offset_ = start - simulator_->scenario().start;
  NodeLog(getName()).info("simulation starts at %.0f s and lasts %.6g s", to_seconds(start),
                          to_seconds(simulator_->scenario().duration));
  while (const std::optional<SimulatedMessage> message = simulator_->next()) {
    if (!sleep_until(message->arrival + offset_)) return;
    publish(*message);
  }
  sleep_until(end_of_clock());
}

void PlantSimulatorNodelet::run_own_clock() {
  pause(options_.delay);
  const double speed = options_.clock_speed;
  const Duration tick =
      from_seconds(std::clamp(kTick, kShortestTick * speed, kLongestTick * speed));
  const Stamp start = simulator_->scenario().start;
  NodeLog(getName()).info(
      "simulation starts at %.9g s of simulated time and lasts %.6g s, at speed %.6g",
      to_seconds(start), to_seconds(simulator_->scenario().duration), speed);
  SteadyClock::time_point origin = SteadyClock::now();
  Stamp next_tick = start;
  std::optional<SimulatedMessage> message = simulator_->next();
  while (running_) {
    const Stamp time = message ? std::min(next_tick, message->arrival) : next_tick;
    if (!message && time > end_of_clock()) return;
    const std::chrono::duration<double> since_origin(to_seconds(time - start) / speed);
    const auto deadline = origin + std::chrono::duration_cast<SteadyClock::duration>(since_origin);
    const auto late = SteadyClock::now() - deadline;
    if (late > kTolerance) origin += late;
    if (!sleep_until(deadline)) return;
    set_clock(time);
    if (time == next_tick) next_tick += tick;
    while (message && message->arrival <= time) {
      publish(*message);
      message = simulator_->next();
    }
  }
}

/// In chunks, so that the nodelet can be unloaded meanwhile. Returns false when it is.
bool PlantSimulatorNodelet::sleep_until(Stamp time) {
  while (running_) {
    const Duration left = time - to_stamp(ros::Time::now());
    if (left <= 0) return true;
    const double longest = ros::Time::isSimTime() ? 1e-3 : 0.05;
    ros::WallDuration(std::min(to_seconds(left), longest)).sleep();
  }
  return false;
}

bool PlantSimulatorNodelet::sleep_until(SteadyClock::time_point deadline) const {
  while (running_) {
    const auto now = SteadyClock::now();
    if (now >= deadline) return true;
    std::this_thread::sleep_until(std::min(deadline, now + std::chrono::milliseconds(50)));
  }
  return false;
}

void PlantSimulatorNodelet::set_clock(Stamp time) {
  if (!clock_publisher_) return;
  rosgraph_msgs::Clock message;
  message.clock = to_ros_time(time);
  clock_publisher_.publish(message);
}

void PlantSimulatorNodelet::publish(SimulatedMessage message) {
  message.stamp += offset_;
  message.arrival += offset_;
  last_arrival_ = message.arrival;
  messages_->visit(message, [&](const auto& filled) {
    using M = std::decay_t<decltype(filled)>;
    publishers_[message.channel].publish(boost::make_shared<M>(filled));
  });
}

}  // namespace sampled_data_observers
