#pragma once

#include <ros/node_handle.h>
#include <ros/steady_timer.h>

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "sampled_data_observers/ros/node_log.h"

namespace sampled_data_observers {

/// A topic, and the type of message that is expected on it.
struct ExpectedType {
  std::string topic;  ///< resolved
  std::string type;   ///< "package/Type"
};

/// What is said of a topic that nobody publishes: which others of its type there are. Empty where
/// there are none.
/// @param expected   that topic
/// @param published  topics and types, as the master has them
/// @param own        those that the one who asks publishes itself: they are none of these
std::string describe_silent_topic(const ExpectedType& expected,
                                  const std::vector<std::pair<std::string, std::string>>& published,
                                  const std::vector<std::string>& own);

/// Looks every few seconds whether the ROS master still knows this nodelet. roscpp registers topics
/// and services once only, so that after a restart of the master nobody would find them any more,
/// although connections stay. Then all topics of this process and the services of this nodelet are
/// registered again. It also asks of what type the topics are that this nodelet subscribes to: what
/// is of another never arrives, and only its publisher is told. Of a topic that nobody publishes
/// for a while the log names those of its type that there are.
class MasterWatch {
 public:
  /// Takes the place of a topic among those expected and the type under which it is published now;
  /// empty where it is not.
  using TypeReceiver = std::function<void(std::size_t, const std::string&)>;

  /// @param handle     its callback queue asks the master, and waits for its answer
  /// @param services   of this nodelet, at least one
  /// @param topics     that it subscribes to
  /// @param own_topics that it publishes
  /// @param take_type  called for each of them, every time
  /// @param log        of the nodelet
  MasterWatch(const ros::NodeHandle& handle, std::vector<std::string> services,
              std::vector<ExpectedType> topics, std::vector<std::string> own_topics,
              TypeReceiver take_type, NodeLog log);

  /// Does something else that asks the master each time, too: on the same thread, so that a master
  /// that does not answer holds up no other. To be set before the callback queue is called.
  void also(std::function<void()> ask) { ask_ = std::move(ask); }

 private:
  void check();
  void check_types();
  void register_again() const;

  const std::vector<std::string> services_;
  const std::vector<ExpectedType> topics_;
  const std::vector<std::string> own_topics_;
  const TypeReceiver take_type_;
  /// Where services of this process are: roscpp no longer tells while it ends.
  const std::string server_;
  /// The type that was last warned of, for each topic; empty: none.
  std::vector<std::string> warned_;
  /// How often in a row nobody published each of them.
  std::vector<int> silent_;
  const NodeLog log_;
  std::function<void()> ask_;
  ros::SteadyTimer timer_;
};

}  // namespace sampled_data_observers
