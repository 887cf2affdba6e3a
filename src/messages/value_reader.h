#pragma once

#include <sampled_data_observers/Input.h>
#include <sampled_data_observers/JumpEvent.h>
#include <sampled_data_observers/Measurement.h>

#include <charconv>
#include <optional>
#include <string>
#include <vector>

#include "messages/time_conversion.h"
#include "sampled_data_observers/config/topic_config.h"
#include "sampled_data_observers/hybrid/event.h"

namespace sampled_data_observers {

/// Takes the values of an event from a message of the package's own: a list of them. They are the
/// message's own, unless fields "values.0", "values.1" … are named.
template <class M>
class ValueReader {
 public:
  /// @throws ConfigError for fields that there are not.
  explicit ValueReader(const TopicSource& source) : has_mode_(source.has_mode) {
    const bool is_named = !source.fields.empty() || source.has_mode;
    if (!is_named) return;
    if (source.has_mode) add(source, "mode", source.mode);
    for (const std::string& field : source.fields) add(source, "fields", field);
    values_.resize(indices_.size());
  }

  /// Sets values, size and mode of the event. They live in the reader until the next call, or in
  /// the message. Returns false where the message does not hold a field.
  bool read(const M& message, Event& event) {
    if (indices_.empty()) {
      event.values = message.values.data();
      event.size = static_cast<Eigen::Index>(message.values.size());
      return true;
    }
    for (std::size_t i = 0; i < indices_.size(); ++i) {
      if (indices_[i] >= message.values.size()) return false;
      values_[i] = message.values[indices_[i]];
    }
    event.values = values_.data() + (has_mode_ ? 1 : 0);
    event.size = static_cast<Eigen::Index>(values_.size()) - (has_mode_ ? 1 : 0);
    if (has_mode_) event.mode = values_.front();
    return true;
  }

 private:
  void add(const TopicSource& source, const std::string& key, const std::string& path) {
    const std::string prefix = "values.";
    std::size_t index = 0;
    const char* const end = path.data() + path.size();
    const bool is_long = path.compare(0, prefix.size(), prefix) == 0 && path.size() > prefix.size();
    const char* const begin = is_long ? path.data() + prefix.size() : end;
    const auto [last, fault] = std::from_chars(begin, end, index);
    if (fault != std::errc() || last != end) {
      throw ConfigError(source.origin, source.path + "/" + key,
                        "fields of " + source.type + ", one per value: values.INDEX",
                        path.empty() ? "none" : "'" + path + "'");
    }
    indices_.push_back(index);
  }

  bool has_mode_;
  std::vector<std::size_t> indices_;
  std::vector<double> values_;
};

/// Jump events, and their withdrawals, which is the kind of the event then: the mode that follows
/// where the plant switches, then the outputs where they come with the event.
template <>
class ValueReader<JumpEvent> {
 public:
  /// @throws ConfigError when `source` names fields: this type has its values in order.
  explicit ValueReader(const TopicSource& source) : has_mode_(source.has_mode) {
    if (source.fields.empty() && source.mode.empty()) return;
    throw ConfigError(source.origin, source.path + (source.fields.empty() ? "/mode" : "/fields"),
                      "no fields (" + source.type + " has its values in order)", "some");
  }

  bool read(const JumpEvent& message, Event& event) const {
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
