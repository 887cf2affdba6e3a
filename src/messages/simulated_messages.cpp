#include "messages/simulated_messages.h"

#include <boost/make_shared.hpp>
#include <limits>
#include <memory>

#include "messages/definition/installed_definitions.h"
#include "sampled_data_observers/messages/message_source.h"

namespace sampled_data_observers {
MessageEncoder::MessageEncoder(const TopicSource& source) : has_mode_(source.has_mode) {
  make_message_source(source, std::make_shared<TransformBuffer>(std::vector<StaticTransform>()));
  definition_ = installed_definition(source.type);
  const auto add_field = [&](const std::string& text) {
    items_.push_back({*find_field(*definition_, text)});
  };
  if (source.has_mode) add_field(source.mode);
  for (const std::string& field : source.fields) add_field(field);
  values_ = items_.size();
  const std::optional<MessagePath> header = find_header(*definition_);
  const auto add_at = [&](const MessagePath& from, const std::string& name,
                          MessageItem::Kind kind) {
    items_.push_back({{path_to(*definition_, from, {name})}, kind});
  };
  if (header && !source.frames.frame.empty()) {
    add_at(*header, "frame_id", MessageItem::Kind::kText);
    items_.back().text = source.frames.frame;
  }
  if (header) add_at(*header, "stamp", MessageItem::Kind::kTime);
  if (source.type == "std_msgs/Time") add_at({}, "data", MessageItem::Kind::kTime);
  connection_ = boost::make_shared<ros::M_string>();
  (*connection_)["type"] = definition_->type();
  (*connection_)["md5sum"] = definition_->md5sum();
  (*connection_)["message_definition"] = definition_->text();
}

RawMessage MessageEncoder::encode(const SimulatedMessage& from) const {
  std::vector<MessageItem> items = items_;
  if (has_mode_) items.front().number = from.mode;
  const std::size_t first = has_mode_ ? 1 : 0;
  for (std::size_t i = first; i < values_; ++i) items[i].number = from.values[i - first];
  if (items.size() > values_) items.back().time = from.stamp;
  return {MessageWriter(*definition_).write(items), connection_};
}

ros::AdvertiseOptions MessageEncoder::advertise_options(const std::string& topic,
                                                        std::uint32_t queue) const {
  return {topic, queue, definition_->md5sum(), definition_->type(), definition_->text()};
}

SimulatedMessages::SimulatedMessages(const std::vector<SimulatedChannel>& channels)
    : channels_(channels) {
  for (const SimulatedChannel& channel : channels_) {
    encoders_.emplace_back();
    const bool is_own = !channel.source || channel.source->is_of_own_type();
    if (!is_own) encoders_.back().emplace(*channel.source);
  }
}

ros::Publisher SimulatedMessages::advertise(std::size_t channel, ros::NodeHandle& handle,
                                            std::uint32_t queue) const {
  using Kind = SimulatedChannel::Kind;
  const std::string& topic = channels_[channel].topic;
  if (encoders_[channel]) {
    ros::AdvertiseOptions options = encoders_[channel]->advertise_options(topic, queue);
    return handle.advertise(options);
  }
  switch (channels_[channel].kind) {
    case Kind::kMeasurement:
    case Kind::kSignal:
      return handle.advertise<Measurement>(topic, queue);
    case Kind::kInput:
      return handle.advertise<Input>(topic, queue);
    case Kind::kJump:
      return handle.advertise<JumpEvent>(topic, queue);
    case Kind::kTruth:
      break;
  }
  return handle.advertise<StateEstimate>(topic, queue);
}

SimulatedMessage SimulatedMessages::uncorrected(const SimulatedChannel& channel,
                                                SimulatedMessage message) {
  if (!channel.source) return message;
  const ValueCorrection& correction = channel.source->correction;
  for (std::size_t i = 0; i < message.values.size(); ++i) {
    const auto entry = static_cast<Eigen::Index>(i);
    if (correction.offset.size() > 0) message.values[i] -= correction.offset(entry);
    if (correction.scale.size() > 0) message.values[i] /= correction.scale(entry);
  }
  message.stamp -= channel.source->stamp_offset;
  return message;
}

void SimulatedMessages::fill(const SimulatedChannel&, const SimulatedMessage& from,
                             Measurement& message) {
  message.values = from.values;
}

void SimulatedMessages::fill(const SimulatedChannel&, const SimulatedMessage& from,
                             Input& message) {
  message.values = from.values;
}

void SimulatedMessages::fill(const SimulatedChannel&, const SimulatedMessage& from,
                             JumpEvent& message) {
  message.mode = from.mode;
  message.values = from.values;
  message.release = to_ros_time(from.arrival);
}

void SimulatedMessages::fill(const SimulatedChannel& channel, const SimulatedMessage& from,
                             StateEstimate& message) {
  message.names = channel.names;
  message.state = from.values;
  message.jumps = from.jumps;
  message.time_since_sample = std::numeric_limits<double>::quiet_NaN();
}

}  // namespace sampled_data_observers
