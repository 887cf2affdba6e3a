#pragma once

#include <sampled_data_observers/Input.h>
#include <sampled_data_observers/JumpEvent.h>
#include <sampled_data_observers/Measurement.h>

#include <algorithm>
#include <string>
#include <vector>

#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/hybrid/event.h"
#include "sampled_data_observers/ros/message_fields.h"
#include "sampled_data_observers/ros/time_conversion.h"

namespace sampled_data_observers {

/// Turns messages of type M into stamp and values of an event. This is the general case, which
/// takes them from named fields.
template <class M>
class ValueReader {
 public:
  /// @throws ConfigError for a field that M does not have, or none.
  explicit ValueReader(const TopicSource& source) : values_(source.size) {
    std::string known;
    for (const auto& field : message_fields<M>()) known += std::string(", ") + field.path;
    const std::string expected = "one field of " + source.type + " per value" + known;
    if (source.fields.size() != source.size) {
      throw ConfigError(source.origin, source.path + "/fields", expected, "none");
    }
    for (const std::string& path : source.fields) {
      const auto size = fields_.size();
      for (const auto& field : message_fields<M>()) {
        if (path == field.path) fields_.push_back(field);
      }
      if (fields_.size() == size) {
        throw ConfigError(source.origin, source.path + "/fields", expected, "'" + path + "'");
      }
    }
  }

  /// Sets stamp, values and size. The values live in the reader until the next call.
  void read(const M& message, Event& event) {
    for (std::size_t i = 0; i < fields_.size(); ++i) values_[i] = fields_[i].get(message);
    event.stamp = to_stamp(message.header.stamp);
    event.values = values_.data();
    event.size = static_cast<Eigen::Index>(values_.size());
  }

 private:
  std::vector<MessageField<M>> fields_;
  std::vector<double> values_;
};

/// @throws ConfigError when `source` names fields: this type has its values in order.
void refuse_fields(const TopicSource& source);

/// Messages that carry a list of values. The event's values are the message's own.
template <class M>
class ListReader {
 public:
  explicit ListReader(const TopicSource& source) { refuse_fields(source); }

  void read(const M& message, Event& event) {
    event.stamp = to_stamp(message.header.stamp);
    event.values = message.values.data();
    event.size = static_cast<Eigen::Index>(message.values.size());
  }
};

template <>
class ValueReader<Measurement> : public ListReader<Measurement> {
 public:
  using ListReader::ListReader;
};

template <>
class ValueReader<Input> : public ListReader<Input> {
 public:
  using ListReader::ListReader;
};

/// Jump events: the mode that follows where the plant switches, then the outputs where they come
/// with the event.
template <>
class ValueReader<JumpEvent> {
 public:
  explicit ValueReader(const TopicSource& source)
      : size_(source.size), first_output_(source.has_mode ? 1 : 0), values_(source.size + 1) {
    refuse_fields(source);
  }

  void read(const JumpEvent& message, Event& event) {
    event.stamp = to_stamp(message.header.stamp);
    event.release = to_stamp(message.release);
    const bool is_measured = !message.values.empty();
    event.channel = is_measured ? kMeasuredJump : kPlainJump;
    if (first_output_ == 1) values_[0] = static_cast<double>(message.mode);
    event.values = values_.data();
    event.size = first_output_ + static_cast<Eigen::Index>(message.values.size());
    if (message.values.size() > size_) {
      event.size = kWrongSize;
    } else {
      std::copy(message.values.begin(), message.values.end(), values_.begin() + first_output_);
    }
  }

 private:
  static constexpr Eigen::Index kWrongSize = -2;

  std::size_t size_;
  std::ptrdiff_t first_output_;
  std::vector<double> values_;
};

}  // namespace sampled_data_observers
