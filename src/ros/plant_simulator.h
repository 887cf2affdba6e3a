#pragma once

#include <nodelet/nodelet.h>
#include <ros/ros.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "messages/simulated_messages.h"
#include "sampled_data_observers/config/config_node.h"
#include "simulation/simulator.h"

namespace sampled_data_observers {

/// Runs a scenario live: publishes what a robot's sensors would send, each message when it arrives.
///
/// Private parameters: the scenario (read_parameter_tree()) and those of Options. It runs by the
/// wall clock, by a simulated clock of somebody else, or is the source of /clock itself. In a node
/// of its own it ends the node when the simulation is over.
class PlantSimulatorNodelet : public nodelet::Nodelet {
 public:
  ~PlantSimulatorNodelet() override;

 private:
  struct Options {
    /// Simulated seconds per second of the /clock that it publishes; 0: it publishes none.
    double clock_speed = 0.0;
    /// Whether to wait until each topic but that of the truth has a subscriber.
    bool wait_for_subscribers = true;
    /// How long to wait beyond that, for recorders and the like [s].
    double delay = 1.0;
  };

  /// @throws ConfigError for a bad configuration, after reporting it: the nodelet does not start.
  void onInit() override;
  void start();
  Options read_options(ConfigNode& tree) const;

  void run();
  bool wait_for_subscribers();
  void pause(double seconds);
  void run_by_clock();
  void run_own_clock();
  bool sleep_until(Stamp time);
  bool sleep_until(std::chrono::steady_clock::time_point deadline) const;
  void set_clock(Stamp time);
  void publish(SimulatedMessage message);
  Stamp end_of_clock() const;

  Options options_;
  std::unique_ptr<Simulator> simulator_;
  std::unique_ptr<const SimulatedMessages> messages_;
  std::vector<ros::Publisher> publishers_;
  ros::Publisher clock_publisher_;
  /// From the scenario's stamps to those of this run.
  Duration offset_ = 0;
  Stamp last_arrival_ = 0;
  std::atomic<bool> running_{false};
  std::thread thread_;
};

}  // namespace sampled_data_observers
