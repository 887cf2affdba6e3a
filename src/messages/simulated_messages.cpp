#include "messages/simulated_messages.h"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <limits>
#include <memory>

#include "messages/definition/installed_definitions.h"
#include "messages/message_covariance.h"
#include "sampled_data_observers/messages/message_source.h"

namespace sampled_data_observers {

MessageEncoder::MessageEncoder(const TopicSource& source, const std::optional<NavSatDatum>& navsat,
                               double variance)
    : has_mode_(source.has_mode) {
  const auto transforms = std::make_shared<TransformBuffer>(std::vector<StaticTransform>(), navsat);
  make_message_source(source, transforms);
  plane_ = transforms->plane();
  definition_ = installed_definition(source.type);
  if (source.has_mode) add_field(source.mode);
  const bool is_transform = source.frames.are_wanted_themselves();
  const std::string prefix = is_transform ? "transforms.0.transform." : "";
  for (const std::string& field : source.fields) add_field(prefix + field);
  if (variance > 0.0) add_variances(source, prefix, variance);
  if (!fixes_.empty() && !plane_->datum()) {
    throw ConfigError(source.origin, source.path + "/fields",
                      "a navsat/datum of numbers, since nobody knows where the simulated plant is",
                      "datum: first_fix");
  }
  std::optional<MessagePath> header = find_header(*definition_);
  if (is_transform) {
    const PathStep first{0, PathStep::Entry::kIndex, 0, ""};
    header = path_to(*definition_, {first}, {"header"});
    items_.push_back(
        {{path_to(*definition_, {first}, {"child_frame_id"})}, MessageItem::Kind::kText});
    items_.back().text = source.frames.child_frame;
  }
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
  has_stamp_ = !items_.empty() && items_.back().kind == MessageItem::Kind::kTime;
  connection_ = boost::make_shared<ros::M_string>();
  (*connection_)["type"] = definition_->type();
  (*connection_)["md5sum"] = definition_->md5sum();
  (*connection_)["message_definition"] = definition_->text();
}

void MessageEncoder::add_field(const std::string& text) {
  const MessageField field = *find_field(*definition_, text);
  const std::size_t value = item_of_.size();
  item_of_.emplace_back();
  if (!field.is_in_plane()) {
    item_of_.back() = items_.size();
    items_.push_back({field});
    return;
  }
  const auto is_there = [&](const Fix& fix) { return fix.path == field.path; };
  const auto found = std::find_if(fixes_.begin(), fixes_.end(), is_there);
  Fix& fix = found == fixes_.end() ? fixes_.emplace_back(Fix{field.path, {}}) : *found;
  const auto east = static_cast<std::size_t>(MessageField::Derived::kEast);
  fix.values.at(static_cast<std::size_t>(field.derived) - east) = value;
}

/// Where the messages have those of the values.
void MessageEncoder::add_variances(const TopicSource& source, const std::string& prefix,
                                   double variance) {
  constexpr double kDiagonalIsKnown = 2.0;  // sensor_msgs/NavSatFix
  const auto add = [&](const MessagePath& path, double number) {
    items_.push_back({{path}});
    items_.back().number = number;
  };
  for (std::size_t i = 0; i < source.fields.size(); ++i) {
    const auto place = CovarianceFields::place_of(
        *definition_, *find_field(*definition_, prefix + source.fields[i]));
    if (!place) continue;
    const Eigen::VectorXd& scales = source.correction.scale;
    const double scale = scales.size() == 0 ? 1.0 : scales(static_cast<Eigen::Index>(i));
    add(place->path_with(*place), variance / (scale * scale));
    const auto type = CovarianceFields::type_of(*definition_, *place);
    if (type) add(*type, kDiagonalIsKnown);
  }
}

/// What is not said of its place in the plane is 0.
void MessageEncoder::add_fix(const Fix& fix, const std::vector<double>& values,
                             std::vector<MessageItem>& items) const {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::optional<std::size_t> value = fix.values.at(axis);
    if (value) point(static_cast<Eigen::Index>(axis)) = values[*value - (has_mode_ ? 1 : 0)];
  }
  const GeodeticPosition place = plane_->unproject(point);
  const auto add = [&](const char* name, double number) {
    items.push_back({{path_to(*definition_, fix.path, {name})}});
    items.back().number = number;
  };
  add("latitude", place.latitude);
  add("longitude", place.longitude);
  add("altitude", place.altitude);
}

RawMessage MessageEncoder::encode(const SimulatedMessage& from) const {
  std::vector<MessageItem> items = items_;
  if (has_stamp_) items.back().time = from.stamp;
  for (std::size_t i = 0; i < item_of_.size(); ++i) {
    if (!item_of_[i]) continue;
    const bool is_mode = has_mode_ && i == 0;
    items[*item_of_[i]].number = is_mode ? from.mode : from.values[i - (has_mode_ ? 1 : 0)];
  }
  for (const Fix& fix : fixes_) add_fix(fix, from.values, items);
  return {MessageWriter(*definition_).write(items), connection_};
}

ros::AdvertiseOptions MessageEncoder::advertise_options(const std::string& topic,
                                                        std::uint32_t queue) const {
  return {topic, queue, definition_->md5sum(), definition_->type(), definition_->text()};
}

SimulatedMessages::SimulatedMessages(const std::vector<SimulatedChannel>& channels,
                                     const std::optional<NavSatDatum>& navsat)
    : channels_(channels) {
  for (const SimulatedChannel& channel : channels_) {
    encoders_.emplace_back();
    const bool is_own = !channel.source || channel.source->is_of_own_type();
    if (!is_own) encoders_.back().emplace(*channel.source, navsat, channel.variance);
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
