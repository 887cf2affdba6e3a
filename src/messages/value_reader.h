#pragma once

#include <sampled_data_observers/Input.h>
#include <sampled_data_observers/JumpEvent.h>
#include <sampled_data_observers/Measurement.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "messages/message_fields.h"
#include "messages/time_conversion.h"
#include "sampled_data_observers/config/topic_config.h"
#include "sampled_data_observers/hybrid/event.h"

namespace sampled_data_observers {

/// @throws ConfigError when `source` names fields: this type has its values in order.
void refuse_fields(const TopicSource& source);

void add_fields(MessageFields<Measurement>& fields);
void add_fields(MessageFields<Input>& fields);

/// Takes the values of an event from named fields of messages of type M: of a jump of a switched
/// plant, the mode first.
template <class M>
class FieldReader {
 public:
  /// @throws ConfigError for a field that M does not have, or too few.
  explicit FieldReader(const TopicSource& source) : has_mode_(source.has_mode) {
    MessageFields<M> known;
    add_fields(known);
    const auto add = [&](const char* key, const std::string& path) {
      fields_.push_back(known.find(path));
      if (fields_.back()) return;
      throw ConfigError(source.origin, source.path + "/" + key,
                        "fields of " + source.type + ", one per value: " + known.describe(),
                        path.empty() ? "none" : "'" + path + "'");
    };
    if (source.has_mode) add("mode", source.mode);
    for (const std::string& path : source.fields) add("fields", path);
    if (!source.of_jumps && source.fields.empty()) add("fields", "");
    values_.resize(fields_.size());
  }

  /// Sets values, size and mode of the event. The values live in the reader until the next call.
  /// Returns false where the message does not hold a field.
  bool read(const M& message, Event& event) {
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      const std::optional<double> value = fields_[i](message);
      if (!value) return false;
      values_[i] = *value;
    }
    event.values = values_.data() + (has_mode_ ? 1 : 0);
    event.size = static_cast<Eigen::Index>(values_.size()) - (has_mode_ ? 1 : 0);
    if (has_mode_) event.mode = values_.front();
    return true;
  }

 private:
  bool has_mode_;
  std::vector<FieldGetter<M>> fields_;
  std::vector<double> values_;
};

/// Turns messages of type M into the values of an event. In general these are fields.
template <class M>
class ValueReader : public FieldReader<M> {
 public:
  using FieldReader<M>::FieldReader;
};

/// Messages that carry a list of values. The event's values are the message's own, unless fields
/// are named.
template <class M>
class ListReader {
 public:
  explicit ListReader(const TopicSource& source) {
    if (!source.fields.empty()) fields_.emplace(source);
  }

  bool read(const M& message, Event& event) {
    if (fields_) return fields_->read(message, event);
    event.values = message.values.data();
    event.size = static_cast<Eigen::Index>(message.values.size());
    return true;
  }

 private:
  std::optional<FieldReader<M>> fields_;
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

/// Jump events, and their withdrawals, which is the kind of the event then: the mode that follows
/// where the plant switches, then the outputs where they come with the event.
template <>
class ValueReader<JumpEvent> {
 public:
  explicit ValueReader(const TopicSource& source) : has_mode_(source.has_mode) {
    refuse_fields(source);
  }

  bool read(const JumpEvent& message, Event& event) {
    event.release = to_stamp(message.release);
    event.index = message.index;
    if (message.withdraw != 0) event.kind = EventKind::kWithdrawal;
    if (has_mode_) event.mode = static_cast<double>(message.mode);
    event.values = message.values.data();
    event.size = static_cast<Eigen::Index>(message.values.size());
    return true;
  }

 private:
  bool has_mode_;
};

}  // namespace sampled_data_observers
