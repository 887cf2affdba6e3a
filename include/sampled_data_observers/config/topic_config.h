#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/config/detector_config.h"
#include "sampled_data_observers/config/frame_config.h"
#include "sampled_data_observers/hybrid/time.h"
#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// What is made of the values of messages before they are those of events: scale * value + offset,
/// which is to lie in limits.
struct ValueCorrection {
  /// One per value; empty: 1.
  Eigen::VectorXd scale;
  /// One per value; empty: 0.
  Eigen::VectorXd offset;
  /// One per value, lowest and highest; empty: none.
  std::vector<Eigen::Vector2d> limits;

  /// Whether values stay as they are.
  bool is_empty() const { return scale.size() == 0 && offset.size() == 0 && limits.empty(); }
};

/// How the covariance of values is taken from their messages: scaled, and with variances that are
/// not less than a floor.
struct MessageCovariance {
  /// Of the covariance, > 0.
  double scale = 1.0;
  /// One per value, in the square of its unit, >= 0.
  Eigen::VectorXd floor;

  /// Whether both are taken in the same way.
  bool operator==(const MessageCovariance& other) const {
    return scale == other.scale && floor == other.floor;
  }
};

/// Where the values of events come from.
struct TopicSource {
  /// Name of the topic, relative or absolute.
  std::string topic;
  /// Message type, such as "geometry_msgs/PoseStamped".
  std::string type;
  /// One field path per value, such as "pose.position.x"; empty for types that carry the values in
  /// order themselves, and for jumps without values.
  std::vector<std::string> fields;
  /// Number of values. A jump event may also carry none.
  std::size_t size = 0;
  /// Whether the messages are jumps.
  bool of_jumps = false;
  /// Whether a jump event carries the mode that follows.
  bool has_mode = false;
  /// The path of the field that holds it, for types that do not carry the mode themselves.
  std::string mode;
  /// Whether the stamp of an event is the time of receipt instead of the message's own.
  bool stamped_on_receipt = false;
  /// Added to every stamp [ns].
  Duration stamp_offset = 0;
  /// Of their values; for jumps none.
  ValueCorrection correction;
  /// Events nearer to the last one kept are passed over [ns]; 0: none.
  Duration min_interval = 0;
  /// Where the messages are no jumps but show them: how to detect them.
  std::optional<DetectorConfig> detector;
  /// Where the covariance of the values comes with them.
  std::optional<MessageCovariance> covariance;
  /// Into which frame the data are transformed, if any.
  SourceFrames frames;
  /// Where the configuration says so, for messages about it: file and line, or parameters of a
  /// node.
  std::string origin;
  /// Where in these: keys joined by '/'.
  std::string path;

  /// Whether its messages are Measurement, Input or JumpEvent, which carry values in order.
  bool is_of_own_type() const;
};

/// Reads the source of each sensor, below `sensors`; nothing for a sensor that measures at jumps
/// and whose outputs the jump events carry.
std::vector<std::optional<TopicSource>> read_sensor_sources(ConfigSection& root,
                                                            const Plant& plant);

/// Reads the sources of the plant's channels of inputs: the section `input` of all, or each of
/// `inputs`.
std::vector<TopicSource> read_input_sources(ConfigSection& root, const Plant& plant);

/// Reads a section `detector`: the source whose messages show jumps, and how to detect them.
TopicSource read_detector_source(ConfigSection section);

/// Reads the source of jump events from `section`, which is the section `jumps` of `root`; other
/// keys of it are left alone.
TopicSource read_jump_source(const ConfigSection& root, ConfigSection& section, const Plant& plant);

}  // namespace sampled_data_observers
