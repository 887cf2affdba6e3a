#include "messages/decoded_source.h"

#include <ros/message_event.h>
#include <ros/subscribe_options.h>

#include <algorithm>
#include <array>
#include <boost/make_shared.hpp>
#include <cstring>
#include <utility>

#include "messages/other_definition.h"
#include "messages/time_conversion.h"
#include "sampled_data_observers/runtime/estimator.h"

namespace sampled_data_observers {
namespace {

const RawMessage& raw(const MessagePointer& message) {
  return *static_cast<const RawMessage*>(message.get());
}

/// To the stamp that messages carry; nothing for a type without.
std::optional<MessagePath> path_to_stamp(const MessageDefinition& definition) {
  if (definition.type() == "std_msgs/Time") return path_to(definition, {}, {"data"});
  const std::optional<MessagePath> header = find_header(definition);
  if (!header) return std::nullopt;
  return path_to(definition, *header, {"stamp"});
}

/// Asks for the stamp that events have, where it is that of messages; the first thing asked for, it
/// has the slots 0 and 1.
std::pair<std::size_t, std::size_t> want_stamp(const TopicSource& source,
                                               const MessageDefinition& definition,
                                               PlanCompiler& compiler) {
  if (source.stamped_on_receipt) return {0, 0};
  const std::optional<MessagePath> path = path_to_stamp(definition);
  if (path) return compiler.want_time(*path);
  throw ConfigError(source.origin, source.path + "/stamp",
                    "receipt (" + source.type + " carries no stamp)", "none");
}

/// In the bytes of all messages; nothing where it depends on them, or is not that of events.
std::optional<std::size_t> offset_of_stamp(const TopicSource& source,
                                           const MessageDefinition& definition) {
  if (source.stamped_on_receipt) return std::nullopt;
  return fixed_offset(definition, *path_to_stamp(definition));
}

DecodingPlan compile_stamp(const TopicSource& source,
                           const std::shared_ptr<const MessageDefinition>& definition) {
  PlanCompiler compiler(definition);
  want_stamp(source, *definition, compiler);
  const bool is_whole = true;
  return compiler.compile(!is_whole);
}

std::shared_ptr<LocalPlane> plane_of(const std::shared_ptr<const TransformBuffer>& transforms) {
  return transforms == nullptr ? nullptr : transforms->plane();
}

/// As it was sent: ros::Time would carry nanoseconds over.
Stamp stamp_from(std::uint32_t seconds, std::uint32_t nanoseconds) {
  ros::Time time;
  time.sec = seconds;
  time.nsec = nanoseconds;
  return to_stamp(time);
}

}  // namespace

DecodedSource::DecodedSource(const TopicSource& source,
                             std::shared_ptr<const MessageDefinition> definition,
                             std::shared_ptr<const TransformBuffer> transforms)
    : topic_(source.topic),
      by_receipt_(source.stamped_on_receipt),
      has_mode_(source.has_mode),
      stamp_offset_(source.stamp_offset),
      corrected_(source),
      definition_(std::move(definition)),
      transforms_(std::move(transforms)),
      thinned_(source.min_interval),
      stamp_plan_(compile_stamp(source, definition_)),
      stamp_at_(offset_of_stamp(source, *definition_)),
      parts_(compile(source, definition_, plane_of(transforms_))),
      decoded_(parts_.plan.counts()),
      values_(parts_.fields.size() + (parts_.covariance ? parts_.covariance->size() : 0)) {}

DecodedSource::Parts DecodedSource::compile(
    const TopicSource& source, const std::shared_ptr<const MessageDefinition>& definition,
    std::shared_ptr<LocalPlane> plane) {
  PlanCompiler compiler(definition);
  const auto stamp = want_stamp(source, *definition, compiler);
  DecodedFields fields(source, *definition, compiler, std::move(plane));
  std::optional<CovarianceFields> covariance;
  if (source.covariance) covariance.emplace(source, *definition, compiler);
  FrameBlocks frames(source, *definition, fields.paths(), compiler);
  return {stamp, std::move(fields), std::move(covariance), std::move(frames), compiler.compile()};
}

ros::Subscriber DecodedSource::subscribe(ros::NodeHandle& handle, std::uint32_t queue_length,
                                         const Receiver& receive) const {
  using Message = const ros::MessageEvent<const RawMessage>&;
  ros::SubscribeOptions options;
  options.initByFullCallbackType<Message>(topic_, queue_length, [receive](Message message) {
    receive(message.getConstMessage(), to_stamp(message.getReceiptTime()));
  });
  // So that roscpp refuses publishers of another definition, which RefusedPublishers listens to.
  // With "*" it would take on that of the first publisher, and refuse the right ones.
  options.datatype = definition_->type();
  options.md5sum = definition_->md5sum();
  options.transport_hints.tcpNoDelay();
  return handle.subscribe(options);
}

MessagePointer DecodedSource::deserialize(std::uint8_t* data, std::uint32_t size,
                                          const Connection& connection) const {
  const auto message = boost::make_shared<RawMessage>();
  message->bytes.assign(data, data + size);
  message->connection = connection;
  return message;
}

Stamp DecodedSource::own_stamp(const RawMessage& message) const {
  if (stamp_at_) {
    std::array<std::uint32_t, 2> time{};  // seconds and nanoseconds
    if (message.bytes.size() < *stamp_at_ + sizeof time) return 0;
    std::memcpy(time.data(), message.bytes.data() + *stamp_at_, sizeof time);
    return stamp_from(time[0], time[1]);
  }
  std::array<double, 2> numbers{};
  std::array<char, 2> are_held{};
  const DecodingSlots slots{numbers.data(), are_held.data(), nullptr, nullptr, nullptr};
  if (stamp_plan_.run(message.bytes.data(), message.bytes.size(), slots).any()) return 0;
  return stamp_from(static_cast<std::uint32_t>(numbers[0]), static_cast<std::uint32_t>(numbers[1]));
}

Stamp DecodedSource::stamp_of(const MessagePointer& message, Stamp receipt) const {
  if (!raw(message).is_of(definition_->type(), definition_->md5sum())) return 0;
  const Stamp stamp = by_receipt_ ? receipt : own_stamp(raw(message));
  return stamp > 0 ? stamp + stamp_offset_ : stamp;
}

Reading DecodedSource::read(const MessagePointer& message, Stamp receipt, Event& event) {
  const MessageBytes& bytes = raw(message).bytes;
  event.stamp = 0;
  if (!raw(message).is_of(definition_->type(), definition_->md5sum())) {
    return Reading::kOtherDefinition;
  }
  if (parts_.plan.run(bytes.data(), bytes.size(), decoded_.slots()).any())
    return Reading::kMalformed;
  const auto [seconds, nanoseconds] = parts_.stamp;
  event.stamp = by_receipt_ ? receipt
                            : stamp_from(static_cast<std::uint32_t>(decoded_.number(seconds)),
                                         static_cast<std::uint32_t>(decoded_.number(nanoseconds)));
  if (event.stamp > 0) event.stamp += stamp_offset_;
  const bool has_stamp = event.stamp > 0;
  if (has_stamp && !parts_.frames.transform(decoded_, event.stamp, transforms_.get())) {
    return Reading::kNoTransform;
  }
  const Reading fields = parts_.fields.read(decoded_, event.stamp, values_.data());
  if (fields != Reading::kEvent) return fields;
  event.values = values_.data() + (has_mode_ ? 1 : 0);
  event.size = static_cast<Eigen::Index>(parts_.fields.size()) - (has_mode_ ? 1 : 0);
  if (has_mode_) event.mode = values_.front();
  if (!corrected_.apply(event)) return Reading::kOutOfLimits;
  if (parts_.covariance && !add_covariance(event)) return Reading::kNoCovariance;
  // What will be rejected does not take the place of the next message.
  const bool counts = has_stamp && is_admissible(event.vector());
  return !counts || thinned_.keep(event.stamp) ? Reading::kEvent : Reading::kPassedOver;
}

/// Behind the values, once they are corrected.
bool DecodedSource::add_covariance(Event& event) {
  if (event.values != values_.data()) std::copy_n(event.values, event.size, values_.data());
  event.values = values_.data();
  event.covariance = static_cast<Eigen::Index>(parts_.covariance->size());
  return parts_.covariance->read(decoded_, values_.data() + event.size);
}

std::string DecodedSource::describe_sender(const MessagePointer& message) const {
  return describe_other_definition(topic_, *raw(message).connection, definition_->type(),
                                   definition_->md5sum());
}

void DecodedSource::name_missing_transform(const MessagePointer& message, Stamp stamp,
                                           std::string& text) const {
  const MessageBytes& bytes = raw(message).bytes;
  parts_.plan.run(bytes.data(), bytes.size(), decoded_.slots());
  parts_.frames.name_missing(decoded_, stamp, *transforms_, text);
}

}  // namespace sampled_data_observers
