#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// The frames in which the data of a source are wanted; all empty: as they come.
struct SourceFrames {
  /// The frame into which data are transformed from that in the message's header.
  std::string frame;
  /// The body of which the pose and twist are wanted that the message gives of a sensor on it.
  std::string body_frame;
  /// That sensor's frame; empty: the message's child_frame_id.
  std::string sensor_frame;
  /// How long a message waits for transforms at its stamp.
  Duration timeout = 0;
  /// Where the messages are transforms of tf: the frame whose pose in `frame` is wanted; else
  /// empty.
  std::string child_frame = {};

  /// Whether anything is to be transformed.
  bool any() const { return !frame.empty() || !body_frame.empty(); }
  /// Whether the messages are transforms of tf.
  bool are_wanted_themselves() const { return !child_frame.empty(); }
};

/// Reads `frame`, `body_frame`, `sensor_frame` and `tf_timeout` of a source.
SourceFrames read_source_frames(ConfigSection& source);

/// Reads `frame`, `child_frame` and `tf_timeout` of a source of transforms.
SourceFrames read_transform_frames(ConfigSection& source);

/// A transform that never changes.
struct StaticTransform {
  /// The frame in which the child stands: its parent in tf.
  std::string frame;
  /// The frame that is placed.
  std::string child_frame;
  /// Of the child's origin in the frame [m].
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  /// Roll, pitch, yaw [rad]: the child's axes are the frame's, rotated about x by roll, then y by
  /// pitch, then z by yaw, all three axes those of the frame.
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();
};

/// Reads the list `static_transforms`; nothing where there is none.
/// @throws ConfigError for frames that have two parents or are their own ancestors, too.
std::vector<StaticTransform> read_static_transforms(ConfigSection& root);

}  // namespace sampled_data_observers
