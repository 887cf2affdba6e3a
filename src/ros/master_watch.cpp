#include "sampled_data_observers/ros/master_watch.h"

#include <ros/connection_manager.h>
#include <ros/init.h>
#include <ros/network.h>
#include <ros/publication.h>
#include <ros/this_node.h>
#include <ros/topic_manager.h>
#include <ros/xmlrpc_manager.h>

#include <algorithm>
#include <utility>

#include "config/misspelling.h"
#include "ros/master_call.h"
#include "sampled_data_observers/runtime/diagnosis.h"

namespace sampled_data_observers {
namespace {

constexpr double kPeriod = 3.0;  // s
/// Nodes may start one after the other: so many checks without a publisher are reported.
constexpr int kSilentChecks = 2;

using TopicsAndTypes = std::vector<std::pair<std::string, std::string>>;

/// As the master gives them.
TopicsAndTypes pairs_of(XmlRpc::XmlRpcValue& published) {
  TopicsAndTypes pairs;
  const int count = published.size();  // of a list: no iterators
  for (int i = 0; i < count; ++i) {
    pairs.emplace_back(static_cast<std::string>(published[i][0]),
                       static_cast<std::string>(published[i][1]));
  }
  return pairs;
}

/// The type of a topic; empty where it is not there, or unknown.
std::string type_of(const std::string& topic, const TopicsAndTypes& published) {
  for (const auto& [name, type] : published) {
    if (name == topic) return type == "*" ? "" : type;
  }
  return "";
}

/// As the master tells subscribers of new publishers: that is how roscpp learns of them.
void tell_of_publishers(const std::string& topic, const XmlRpc::XmlRpcValue& publishers) {
  XmlRpc::XmlRpcValue response;
  call_self("publisherUpdate", "/master", {XmlRpc::XmlRpcValue(topic), publishers}, response);
}

}  // namespace

std::string describe_silent_topic(const ExpectedType& expected, const TopicsAndTypes& published,
                                  const std::vector<std::string>& own) {
  constexpr std::size_t kMostNamed = 10;
  std::vector<std::string> others;
  for (const auto& [name, type] : published) {
    const bool is_own = std::find(own.begin(), own.end(), name) != own.end();
    if (type == expected.type && name != expected.topic && !is_own) others.push_back(name);
  }
  if (others.empty()) return "";
  std::sort(others.begin(), others.end());
  const std::string meant = misspelling_of(expected.topic, others);
  std::string named;
  for (std::size_t i = 0; i < std::min(others.size(), kMostNamed); ++i) {
    named += (i > 0 ? ", " : "") + others[i];
  }
  if (others.size() > kMostNamed) {
    named += " and " + std::to_string(others.size() - kMostNamed) + " more";
  }
  return "nobody publishes " + expected.topic + "; of its type, " + expected.type +
         ", there are: " + named + (meant.empty() ? "" : "; is it a misspelling of " + meant + "?");
}

MasterWatch::MasterWatch(const ros::NodeHandle& handle, std::vector<std::string> services,
                         std::vector<ExpectedType> topics, std::vector<std::string> own_topics,
                         TypeReceiver take_type, NodeLog log)
    : services_(std::move(services)),
      topics_(std::move(topics)),
      own_topics_(std::move(own_topics)),
      take_type_(std::move(take_type)),
      server_("rosrpc://" + ros::network::getHost() + ":" +
              std::to_string(ros::ConnectionManager::instance()->getTCPPort())),
      warned_(topics_.size()),
      silent_(topics_.size(), 0),
      log_(std::move(log)) {
  timer_ = handle.createSteadyTimer(ros::WallDuration(kPeriod),
                                    [this](const ros::SteadyTimerEvent&) { check(); });
}

void MasterWatch::check() {
  check_types();
  if (ask_) ask_();
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue payload;
  if (call_master("lookupService", {services_.front()}, response, payload)) return;
  const bool answered = response.valid();
  if (answered && !ros::isShuttingDown()) register_again();
}

void MasterWatch::check_types() {
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue topics;
  const std::string everywhere;
  if (!call_master("getPublishedTopics", {everywhere}, response, topics)) return;
  const TopicsAndTypes published = pairs_of(topics);
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    const std::string type = type_of(topics_[i].topic, published);
    take_type_(i, type);
    silent_[i] = type.empty() ? silent_[i] + 1 : 0;
    if (silent_[i] == kSilentChecks) {
      const std::string hint = describe_silent_topic(topics_[i], published, own_topics_);
      if (!hint.empty()) log_.warn("%s", hint.c_str());
    }
    if (type.empty() || type == topics_[i].type) {
      warned_[i].clear();
    } else if (type != warned_[i]) {
      warned_[i] = type;
      log_.warn("%s", describe_wrong_type(topics_[i].topic, type, topics_[i].type).c_str());
    }
  }
}

void MasterWatch::register_again() const {
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue payload;
  const std::string node = ros::XMLRPCManager::instance()->getServerURI();
  std::vector<std::string> published;
  ros::this_node::getAdvertisedTopics(published);
  for (const std::string& topic : published) {
    const ros::PublicationPtr publication = ros::TopicManager::instance()->lookupPublication(topic);
    if (!publication) continue;
    call_master("registerPublisher", {topic, publication->getDataType(), node}, response, payload);
  }
  std::vector<std::string> subscribed;
  ros::this_node::getSubscribedTopics(subscribed);
  const std::string any_type = "*";
  for (const std::string& topic : subscribed) {
    if (!call_master("registerSubscriber", {topic, any_type, node}, response, payload)) continue;
    // Where nobody has registered yet, the connections there are shall stay.
    if (payload.size() > 0) tell_of_publishers(topic, payload);
  }
  for (const std::string& service : services_) {
    call_master("registerService", {service, server_, node}, response, payload);
  }
  log_.warn("the ROS master was restarted: topics and services are registered again");
}

}  // namespace sampled_data_observers
