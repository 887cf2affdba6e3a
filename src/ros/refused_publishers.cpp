#include "sampled_data_observers/ros/refused_publishers.h"

#include <ros/message_event.h>
#include <ros/subscribe_options.h>
#include <ros/subscription.h>
#include <ros/topic_manager.h>
#include <ros/xmlrpc_manager.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <iterator>
#include <memory>
#include <utility>

#include "messages/other_definition.h"
#include "messages/queue_length.h"
#include "messages/raw_message.h"
#include "ros/master_call.h"

namespace sampled_data_observers {
namespace {

constexpr char kAny[] = "*";

/// The nodes that publish a topic, of what the master says of all.
std::vector<std::string> nodes_of(const std::string& topic, XmlRpc::XmlRpcValue& publishers) {
  std::vector<std::string> nodes;
  const int topics = publishers.size();
  for (int i = 0; i < topics; ++i) {
    if (static_cast<std::string>(publishers[i][0]) != topic) continue;
    XmlRpc::XmlRpcValue& names = publishers[i][1];
    const int count = names.size();
    for (int j = 0; j < count; ++j) nodes.push_back(static_cast<std::string>(names[j]));
  }
  return nodes;
}

/// The addresses of nodes whose messages on a topic come to this process.
std::set<std::string> connected(const std::string& topic) {
  std::set<std::string> addresses;
  XmlRpc::XmlRpcValue answer;
  if (!call_self("getBusInfo", ros::XMLRPCManager::instance()->getServerURI(), {}, answer)) {
    return addresses;
  }
  XmlRpc::XmlRpcValue& connections = answer[2];
  const int count = connections.size();
  for (int i = 0; i < count; ++i) {
    const bool is_inbound = static_cast<std::string>(connections[i][2]) == "i";
    const bool is_of_topic = static_cast<std::string>(connections[i][4]) == topic;
    if (is_inbound && is_of_topic) addresses.insert(static_cast<std::string>(connections[i][1]));
  }
  return addresses;
}

/// The addresses of nodes, but this one and those that are connected.
std::set<std::string> unconnected(const std::vector<std::string>& nodes,
                                  const std::set<std::string>& connected) {
  std::set<std::string> addresses;
  for (const std::string& node : nodes) {
    XmlRpc::XmlRpcValue response;
    XmlRpc::XmlRpcValue address;
    if (call_master("lookupNode", {node}, response, address)) {
      addresses.insert(static_cast<std::string>(address));
    }
  }
  addresses.erase(ros::XMLRPCManager::instance()->getServerURI());
  for (const std::string& address : connected) addresses.erase(address);
  return addresses;
}

/// What a connection is told apart by, so that its text is written once.
struct Told {
  boost::shared_ptr<ros::M_string> connection;
  RefusedPublishers::Text text;  ///< null: it is as expected
};

}  // namespace

RefusedPublishers::RefusedPublishers(std::vector<ExpectedDefinition> topics, Receiver receive)
    : topics_(std::move(topics)),
      receive_(std::move(receive)),
      unconnected_(topics_.size()),
      connections_(topics_.size()) {}

RefusedPublishers::~RefusedPublishers() {
  for (const auto& of_topic : connections_) {
    for (const auto& [address, connection] : of_topic) end(connection);
  }
}

/// The master is asked for addresses only where there are other numbers of publishers than of
/// connections.
void RefusedPublishers::check() {
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue state;
  if (!call_master("getSystemState", {}, response, state)) return;
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    const std::string& topic = topics_[i].topic;
    const std::vector<std::string> nodes = nodes_of(topic, state[0]);
    const bool are_all = nodes.size() == ros::TopicManager::instance()->getNumPublishers(topic);
    if (are_all && connections_[i].empty()) {
      unconnected_[i].clear();
      continue;
    }
    const std::set<std::string> now = unconnected(nodes, connected(topic));
    std::set<std::string> still;  // others may be about to connect
    std::set_intersection(now.begin(), now.end(), unconnected_[i].begin(), unconnected_[i].end(),
                          std::inserter(still, still.end()));
    unconnected_[i] = now;
    listen(i, still);
  }
}

void RefusedPublishers::listen(std::size_t topic, const std::set<std::string>& publishers) {
  std::map<std::string, Connection>& connections = connections_[topic];
  for (auto known = connections.begin(); known != connections.end();) {
    // One that had a connection would take no other definition any more than that one's.
    const bool is_of_use =
        publishers.count(known->first) > 0 && known->second.subscription->getNumPublishers() > 0;
    if (is_of_use) {
      ++known;
      continue;
    }
    end(known->second);
    known = connections.erase(known);
  }
  for (const std::string& publisher : publishers) {
    if (connections.count(publisher) > 0) continue;
    connections.emplace(publisher, connect(topic))
        .first->second.subscription->pubUpdate({publisher});
  }
}

/// Beside roscpp's own, of which there is one a topic: that takes on the definition of the first
/// publisher that it is connected with, and would refuse the right ones.
RefusedPublishers::Connection RefusedPublishers::connect(std::size_t topic) {
  using Message = const ros::MessageEvent<const RawMessage>&;
  const auto told = std::make_shared<Told>();
  ros::SubscribeOptions options;
  options.initByFullCallbackType<Message>(
      topics_[topic].topic, kQueueLength, [this, topic, told](Message message) {
        if (told->connection != message.getConnectionHeaderPtr()) {
          const ExpectedDefinition& expected = topics_[topic];
          told->connection = message.getConnectionHeaderPtr();
          told->text.reset();
          if (!message.getConstMessage()->is_of(expected.type, expected.md5sum)) {
            told->text = boost::make_shared<const std::string>(describe_other_definition(
                expected.topic, *told->connection, expected.type, expected.md5sum));
          }
        }
        if (told->text) receive_(topic, told->text);
      });
  Connection connection{boost::make_shared<ros::Subscription>(topics_[topic].topic, kAny, kAny,
                                                              ros::TransportHints().tcpNoDelay()),
                        options.helper};
  const bool at_the_same_time = true;
  connection.subscription->addCallback(connection.helper, kAny, &at_once_, kQueueLength,
                                       ros::VoidConstPtr(), !at_the_same_time);
  return connection;
}

/// Waits for a callback that is under way.
void RefusedPublishers::end(const Connection& connection) {
  connection.subscription->removeCallback(connection.helper);
  connection.subscription->shutdown();
}

}  // namespace sampled_data_observers
