#pragma once

#include <string>
#include <type_traits>

#include "messages/transform_message.h"
#include "sampled_data_observers/config/topic_config.h"
#include "sampled_data_observers/messages/transform_buffer.h"

namespace sampled_data_observers {

/// What can be done with messages of type M, by the functions that there are for it.
template <class M, class = void>
struct HasFrame : std::false_type {};
template <class M>
struct HasFrame<M, std::void_t<decltype(to_frame(Eigen::Isometry3d(), std::declval<M&>()))>>
    : std::true_type {};
template <class M, class = void>
struct HasBody : std::false_type {};
template <class M>
struct HasBody<M, std::void_t<decltype(to_body(Eigen::Isometry3d(), std::declval<M&>()))>>
    : std::true_type {};
template <class M, class = void>
struct HasChildFrame : std::false_type {};
template <class M>
struct HasChildFrame<M, std::void_t<decltype(std::declval<M&>().child_frame_id)>> : std::true_type {
};

/// Brings messages of type M into the frames that their source is configured for.
template <class M>
class MessageTransformer {
 public:
  /// @throws ConfigError for frames that messages of this type have no use for.
  explicit MessageTransformer(const TopicSource& source) : frames_(source.frames) {
    if (!frames_.frame.empty() && !HasFrame<M>::value) {
      throw ConfigError(source.origin, source.path + "/frame",
                        "none (nothing in " + source.type + " depends on a frame)",
                        "'" + frames_.frame + "'");
    }
    if (frames_.body_frame.empty()) return;
    if (!HasBody<M>::value) {
      throw ConfigError(source.origin, source.path + "/body_frame",
                        "none (" + source.type + " is not the pose of a sensor; see frame)",
                        "'" + frames_.body_frame + "'");
    }
    if (frames_.sensor_frame.empty() && !HasChildFrame<M>::value) {
      throw ConfigError(source.origin, source.path + "/sensor_frame",
                        "the frame of the sensor (" + source.type + " does not name it)",
                        "nothing (the key is missing)");
    }
  }

  /// The message in the configured frames at its stamp; null while a transform is not known.
  /// It lives until the next call, or as long as the message.
  /// @pre stamp > 0; `transforms` is not null where the source has frames
  const M* transform(const M& message, [[maybe_unused]] Stamp stamp,
                     const TransformBuffer* transforms) {
    if (!frames_.any()) return &message;
    transformed_ = message;
    if constexpr (HasFrame<M>::value) {
      if (!frames_.frame.empty()) {
        const auto pose = transforms->find(frames_.frame, message.header.frame_id, stamp);
        if (!pose) return nullptr;
        to_frame(*pose, transformed_);
      }
    }
    if constexpr (HasBody<M>::value) {
      if (!frames_.body_frame.empty()) {
        const auto body = transforms->find(sensor_frame(message), frames_.body_frame, stamp);
        if (!body) return nullptr;
        to_body(*body, transformed_);
      }
    }
    return &transformed_;
  }

  /// Writes which transform transform() did not find, "from -> to", into a text with room for
  /// kLongestPair characters: names are cut where they are too long for it.
  /// @pre the source has frames
  void name_missing(const M& message, [[maybe_unused]] Stamp stamp,
                    const TransformBuffer& transforms, std::string& text) const {
    if constexpr (HasBody<M>::value) {
      const bool is_of_body =
          !frames_.body_frame.empty() &&
          (frames_.frame.empty() || transforms.find(frames_.frame, message.header.frame_id, stamp));
      if (is_of_body) return write_pair(frames_.body_frame, sensor_frame(message), text);
    }
    if constexpr (HasFrame<M>::value) {
      write_pair(message.header.frame_id, frames_.frame, text);
    }
  }

 private:
  const std::string& sensor_frame(const M& message) const {
    if constexpr (HasChildFrame<M>::value) {
      if (frames_.sensor_frame.empty()) return message.child_frame_id;
    }
    return frames_.sensor_frame;
  }

  SourceFrames frames_;
  M transformed_;
};

}  // namespace sampled_data_observers
