#pragma once

#include <ros/forwards.h>

#include <boost/shared_ptr.hpp>
#include <cstddef>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "sampled_data_observers/ros/message_inbox.h"

namespace sampled_data_observers {

/// A topic, and the definition by which its messages are read.
struct ExpectedDefinition {
  std::string topic;   ///< resolved
  std::string type;    ///< "package/Type"
  std::string md5sum;  ///< of its definition
};

/// Publishers with which roscpp makes no connection, since their type is another one than what this
/// process expects, or their definition of it. All that they send would be lost, and nobody but
/// they would be told. So the master is to be asked every few seconds who publishes; who is not
/// connected with twice in turn is listened to apart, by a subscription of any type, as long as
/// that is so.
class RefusedPublishers {
 public:
  /// What is said of such a publisher (describe_other_definition()).
  using Text = boost::shared_ptr<const std::string>;
  /// Takes the place of a topic among those expected, for each message that it refuses; called by
  /// roscpp's threads.
  using Receiver = std::function<void(std::size_t, const Text&)>;

  /// @param topics   that this nodelet subscribes to
  /// @param receive  allocates nothing where this must not
  RefusedPublishers(std::vector<ExpectedDefinition> topics, Receiver receive);
  /// No receiver is called any more.
  ~RefusedPublishers();
  RefusedPublishers(const RefusedPublishers&) = delete;
  RefusedPublishers& operator=(const RefusedPublishers&) = delete;

  /// Asks the master, and waits for its answer; for one thread at a time.
  void check();

 private:
  /// With one publisher.
  struct Connection {
    ros::SubscriptionPtr subscription;
    ros::SubscriptionCallbackHelperPtr helper;
  };

  void listen(std::size_t topic, const std::set<std::string>& publishers);
  Connection connect(std::size_t topic);
  static void end(const Connection& connection);

  const std::vector<ExpectedDefinition> topics_;
  const Receiver receive_;
  AtOnce at_once_;
  /// For each topic, the addresses of publishers without a connection at the last check.
  std::vector<std::set<std::string>> unconnected_;
  /// For each topic, by the address of the publisher's node.
  std::vector<std::map<std::string, Connection>> connections_;
};

}  // namespace sampled_data_observers
