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

std::string listed(const std::map<std::string, std::string>& topics) {
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

BagSet::BagSet(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    bags_.push_back(std::make_unique<rosbag::Bag>());
    open_for_reading(*bags_.back(), path);
  }
  rosbag::View view;
  look_through(view);
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    topics_[connection->topic] = connection->datatype;
  }
}

void BagSet::look_through(rosbag::View& view) const {
  for (const auto& bag : bags_) view.addQuery(*bag);
}

void BagSet::look_through(rosbag::View& view, const std::vector<std::string>& topics) const {
  for (const auto& bag : bags_) view.addQuery(*bag, rosbag::TopicQuery(topics));
}

std::string BagSet::name_of(const std::string& name) const {
  if (topics_.count(name) > 0) return name;
  std::string fault;
  if (!ros::names::validate(name, fault)) return name;
  const std::string resolved = ros::names::resolve(name);
  const std::string bare = resolved.substr(1);
  return topics_.count(resolved) == 0 && topics_.count(bare) > 0 ? bare : resolved;
}

std::shared_ptr<const MessageDefinition> BagSet::definition_of(const std::string& topic) const {
  rosbag::View view;
  look_through(view, {topic});
  const std::vector<const rosbag::ConnectionInfo*> connections = view.getConnections();
  if (connections.empty()) return nullptr;
  try {
    return std::make_shared<const MessageDefinition>(connections.front()->datatype,
                                                     connections.front()->msg_def);
  } catch (const DefinitionError& fault) {
    throw ReplayError("the type of " + topic + ": " + fault.what());
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

std::vector<BagChannel> bind_channels(const ObserverConfig& config, const BagSet& bags,
                                      const std::shared_ptr<const TransformBuffer>& transforms,
                                      bool may_lack_input) {
  const std::map<std::string, std::string>& topics = bags.topics();
  std::vector<BagChannel> result;
  for (const EventChannel& channel : event_channels(config)) {
    BagChannel bound;
    bound.channel = channel;
    bound.topic = bags.name_of(channel.source.topic);
    const auto found = topics.find(bound.topic);
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
    // That of the first tf has another name, and the same messages.
    const bool is_transform = channel.source.frames.are_wanted_themselves();
    if (bound.is_recorded && !is_transform && found->second != channel.source.type) {
      throw ReplayError(channel.source.origin + ": " + channel.source.path + ": expected " +
                        channel.source.type + " on " + bound.topic + ", found " + found->second +
                        " in the bag, which has" + listed(topics));
    }
    if (bound.is_recorded) bound.definition = bags.definition_of(bound.topic);
    bound.source = make_message_source(channel.source, transforms, bound.definition);
    result.push_back(std::move(bound));
  }
  return result;
}

}  // namespace sampled_data_observers
