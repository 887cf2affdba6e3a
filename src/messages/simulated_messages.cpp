#include "messages/simulated_messages.h"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <limits>
#include <memory>

#include "messages/definition/installed_definitions.h"
#include "messages/message_covariance.h"
#include "sampled_data_observers/messages/message_source.h"

namespace sampled_data_observers {
namespace {

ConfigError field_set_twice(const std::string& text, const TopicSource& source) {
  return {source.origin, source.path + "/fields",
          "fields that each have one value in a simulated message: for another sensor or input of "
          "the same field, a topic of its own",
          "'" + text + "', which another value sets already"};
}

}  // namespace

MessageEncoder::MessageEncoder(const std::vector<SimulatedReading>& readings,
                               const std::optional<NavSatDatum>& navsat)
    : has_mode_(readings.front().source.has_mode) {
  const TopicSource& source = readings.front().source;
  const auto transforms = std::make_shared<TransformBuffer>(std::vector<StaticTransform>(), navsat);
  for (const SimulatedReading& reading : readings) {
    make_message_source(reading.source, transforms);  // which refuses what can't be read
  }
  plane_ = transforms->plane();
  definition_ = installed_definition(source.type);
  if (source.has_mode) add_field(source.mode, source);
  for (const SimulatedReading& reading : readings) add_reading(reading);
  if (!fixes_.empty() && !plane_->datum()) {
    throw ConfigError(source.origin, source.path + "/fields",
                      "a navsat/datum of numbers, since nobody knows where the simulated plant is",
                      "datum: first_fix");
  }
  const bool is_transform = source.frames.are_wanted_themselves();
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
  const auto has_frame = [](const SimulatedReading& reading) {
    return !reading.source.frames.frame.empty();
  };
  const auto in_frame = std::find_if(readings.begin(), readings.end(), has_frame);
  if (header && in_frame != readings.end()) {
    add_at(*header, "frame_id", MessageItem::Kind::kText);
    items_.back().text = in_frame->source.frames.frame;
  }
  if (header) add_at(*header, "stamp", MessageItem::Kind::kTime);
  if (source.type == "std_msgs/Time") add_at({}, "data", MessageItem::Kind::kTime);
  has_stamp_ = !items_.empty() && items_.back().kind == MessageItem::Kind::kTime;
  connection_ = boost::make_shared<ros::M_string>();
  (*connection_)["type"] = definition_->type();
  (*connection_)["md5sum"] = definition_->md5sum();
  (*connection_)["message_definition"] = definition_->text();
}

void MessageEncoder::add_reading(const SimulatedReading& reading) {
  const bool is_transform = reading.source.frames.are_wanted_themselves();
  const std::string prefix = is_transform ? "transforms.0.transform." : "";
  for (const std::string& field : reading.source.fields) add_field(prefix + field, reading.source);
  if (reading.variance.size() > 0) add_variances(reading, prefix);
}

/// A number can be written once only, and a quaternion by its numbers or by its angles.
void MessageEncoder::require_free(const MessageField& field, const std::string& text,
                                  const TopicSource& source) const {
  const auto is_angle = [](const MessageField& of) {
    return of.derived != MessageField::Derived::kNone && !of.is_in_plane();
  };
  const auto is_within = [](const MessagePath& inner, const MessagePath& outer) {
    return inner.size() == outer.size() + 1 &&
           std::equal(outer.begin(), outer.end(), inner.begin());
  };
  for (const MessageItem& item : items_) {
    const MessageField& other = item.field;
    const bool is_same = other.path == field.path && other.derived == field.derived;
    const bool is_quaternion = (is_angle(field) && is_within(other.path, field.path)) ||
                               (is_angle(other) && is_within(field.path, other.path));
    if (is_same || is_quaternion) throw field_set_twice(text, source);
  }
}

void MessageEncoder::add_field(const std::string& text, const TopicSource& source) {
  const MessageField field = *find_field(*definition_, text);
  require_free(field, text, source);
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
  std::optional<std::size_t>& place = fix.values.at(static_cast<std::size_t>(field.derived) - east);
  if (place) throw field_set_twice(text, source);
  place = value;
}

/// Where the messages have those of the values.
void MessageEncoder::add_variances(const SimulatedReading& reading, const std::string& prefix) {
  const TopicSource& source = reading.source;
  constexpr double kDiagonalIsKnown = 2.0;  // sensor_msgs/NavSatFix
  const auto add = [&](const MessagePath& path, double number) {
    items_.push_back({{path}});
    items_.back().number = number;
  };
  for (std::size_t i = 0; i < source.fields.size(); ++i) {
    const auto place = CovarianceFields::place_of(
        *definition_, *find_field(*definition_, prefix + source.fields[i]));
    if (!place) continue;
    const auto value = static_cast<Eigen::Index>(i);
    const double variance = reading.variance(value);
    if (variance == 0.0) continue;
    const Eigen::VectorXd& scales = source.correction.scale;
    const double scale = scales.size() == 0 ? 1.0 : scales(value);
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
    const std::vector<SimulatedReading>& readings = channel.readings;
    const bool is_own = readings.empty() || readings.front().source.is_of_own_type();
    if (!is_own) encoders_.back().emplace(readings, navsat);
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
  std::size_t value = 0;
  for (const SimulatedReading& reading : channel.readings) {
    const ValueCorrection& correction = reading.source.correction;
    const std::size_t first = value;
    for (; value < std::min(first + reading.source.size, message.values.size()); ++value) {
      const auto entry = static_cast<Eigen::Index>(value - first);
      if (correction.offset.size() > 0) message.values[value] -= correction.offset(entry);
      if (correction.scale.size() > 0) message.values[value] /= correction.scale(entry);
    }
  }
  if (!channel.readings.empty()) message.stamp -= channel.readings.front().source.stamp_offset;
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
