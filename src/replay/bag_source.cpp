#include "replay/bag_source.h"

#include <ros/names.h>
#include <ros/serialization.h>
#include <rosbag/view.h>

#include <algorithm>
#include <map>

#include "messages/definition/plan_compiler.h"
#include "messages/time_conversion.h"
#include "replay/bag_check.h"
#include "replay/bag_records.h"

namespace sampled_data_observers {
namespace {

std::string listed(const std::vector<std::pair<std::string, std::string>>& topics) {
  std::string text;
  for (const auto& [topic, type] : topics) text += "\n  " + topic + " (" + type + ")";
  return text.empty() ? "\n  nothing" : text;
}

}  // namespace

BagMessageError::BagMessageError(const rosbag::MessageInstance& instance, const std::string& fault)
    : ReplayError("the message on " + instance.getTopic() + " received at " +
                  std::to_string(instance.getTime().toSec()) + " s: " + fault) {}

void open_for_reading(rosbag::Bag& bag, const std::string& path) {
  require_whole_bag(path);
  try {
    bag.open(path, rosbag::bagmode::Read);
  } catch (const std::exception& error) {
    throw ReplayError(path + ": can't be read as a bag: " + error.what());
  }
}

std::vector<std::pair<std::string, std::string>> bag_topics(const rosbag::Bag& bag) {
  rosbag::View view(bag);
  std::map<std::string, std::string> topics;
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    topics[connection->topic] = connection->datatype;
  }
  return {topics.begin(), topics.end()};
}

std::shared_ptr<const MessageDefinition> definition_in(const rosbag::Bag& bag,
                                                       const std::string& topic) {
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  const std::vector<const rosbag::ConnectionInfo*> connections = view.getConnections();
  if (connections.empty()) return nullptr;
  try {
    return std::make_shared<const MessageDefinition>(connections.front()->datatype,
                                                     connections.front()->msg_def);
  } catch (const DefinitionError& fault) {
    throw ReplayError(bag.getFileName() + ": on " + topic + ": " + fault.what());
  }
}

std::vector<std::uint8_t> checked_bytes(const rosbag::MessageInstance& instance) {
  struct Checked {
    DecodingPlan plan;
    DecodedMessage room;
  };
  static std::map<std::string, Checked> types;
  try {
    const std::string& type = instance.getDataType();
    auto known = types.find(type + instance.getMD5Sum());
    if (known == types.end()) {
      DecodingPlan plan = PlanCompiler(std::make_shared<const MessageDefinition>(
                                           type, instance.getMessageDefinition()))
                              .compile();
      DecodedMessage room(plan.counts());
      known = types.emplace(type + instance.getMD5Sum(), Checked{std::move(plan), std::move(room)})
                  .first;
    }
    std::vector<std::uint8_t> bytes(instance.size());
    const auto size = static_cast<std::uint32_t>(bytes.size());
    ros::serialization::OStream stream(bytes.data(), size);
    instance.write(stream);
    Checked& checked = known->second;
    const Malformation fault = checked.plan.run(bytes.data(), bytes.size(), checked.room.slots());
    if (fault.any()) throw BagMessageError(instance, fault.describe());
    return bytes;
  } catch (const BagMessageError&) {
    throw;
  } catch (const std::exception& fault) {
    throw BagMessageError(instance, fault.what());
  }
}

MessagePointer instantiate(const MessageSource& source, const rosbag::MessageInstance& instance) {
  std::vector<std::uint8_t> bytes = checked_bytes(instance);
  try {
    return source.deserialize(bytes.data(), static_cast<std::uint32_t>(bytes.size()),
                              instance.getConnectionHeader());
  } catch (const std::exception& fault) {
    throw BagMessageError(instance, fault.what());
  }
}

Reading BagChannel::read(const rosbag::MessageInstance& instance, Event& event) {
  message_ = instantiate(*source, instance);
  return source->read(message_, to_stamp(instance.getTime()), event);
}

std::vector<BagChannel> bind_channels(const ObserverConfig& config, const rosbag::Bag& bag,
                                      const std::shared_ptr<const TransformBuffer>& transforms,
                                      bool may_lack_input) {
  const auto topics = bag_topics(bag);
  std::vector<BagChannel> result;
  for (const EventChannel& channel : event_channels(config)) {
    BagChannel bound;
    bound.channel = channel;
    bound.topic = ros::names::resolve(channel.source.topic);
    const auto found = std::find_if(topics.begin(), topics.end(),
                                    [&](const auto& topic) { return topic.first == bound.topic; });
    bound.is_recorded = found != topics.end();
    // Jumps may never have happened, and a topic without messages is not recorded. A sensor without
    // a single sample is a mistake, and so is the signal of a detector.
    const bool is_input = channel.kind == EventKind::kInput;
    const bool may_be_empty =
        is_input ? may_lack_input : channel.kind == EventKind::kJump && !channel.source.detector;
    if (!bound.is_recorded && !may_be_empty) {
      throw ReplayError(
          channel.source.origin + ": " + channel.source.path + ": the bag has no topic " +
          bound.topic +
          (is_input ? " (where no input was ever sent, --no-input takes it as zero)" : "") +
          "; it has" + listed(topics));
    }
    if (bound.is_recorded && found->second != channel.source.type) {
      throw ReplayError(channel.source.origin + ": " + channel.source.path + ": expected " +
                        channel.source.type + " on " + bound.topic + ", found " + found->second +
                        " in the bag");
    }
    if (bound.is_recorded) bound.definition = definition_in(bag, bound.topic);
    bound.source = make_message_source(channel.source, transforms, bound.definition);
    result.push_back(std::move(bound));
  }
  return result;
}

std::vector<std::string> transform_topics() {
  return {ros::names::resolve("/tf"), ros::names::resolve("/tf_static")};
}

void take_transforms(const rosbag::MessageInstance& instance, TransformBuffer& transforms) {
  const auto message = instantiate<tf2_msgs::TFMessage>(instance);
  transforms.take(*message, instance.getTopic() == transform_topics().back(),
                  to_stamp(instance.getTime()));
}

}  // namespace sampled_data_observers
