#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/hybrid/time.h"
#include "sampled_data_observers/runtime/body_estimate.h"

namespace sampled_data_observers {

/// How tf is told where the body is.
struct TransformOutput {
  /// Empty: the body's pose itself, world frame → base frame. Otherwise the frame of an odometry
  /// that publishes odom frame → base frame itself: what is published is world frame → odom frame.
  std::string odom_frame;
  /// Added to the stamp of the estimate [ns]; may be negative.
  Duration time_offset = 0;
  /// How long an estimate waits for the transform odom frame → base frame of its stamp [ns].
  Duration timeout = 0;
};

/// The estimate in standard messages: that of a rigid body. doc/configuration.md describes the
/// keys.
struct OutputsConfig {
  /// Which numbers of the estimate are the body's.
  BodyStates body;
  /// Whether the pose's covariance is the ellipsoid that holds the error, from the guaranteed
  /// bound.
  bool pose_is_bounded = false;
  /// In which the pose is given.
  std::string world_frame;
  /// Empty where no output needs it.
  std::string base_frame;
  /// Topic of nav_msgs/Odometry; empty: not published.
  std::optional<std::string> odometry;
  /// Topic of geometry_msgs/PoseWithCovarianceStamped; empty: not published.
  std::optional<std::string> pose;
  /// Topic of geometry_msgs/TwistWithCovarianceStamped; empty: not published.
  std::optional<std::string> twist;
  /// Empty where tf is told nothing.
  std::optional<TransformOutput> transform;
};

/// What the numbers of a body may be named.
struct BodyNames {
  std::vector<std::string> states;  ///< that are estimated
  std::vector<std::string> inputs;  ///< that are known
};

/// Reads the section `outputs`; nothing where there is none.
/// @param root         the section that holds it
/// @param names        what its values may name
/// @param world_frame  the key `frame_id`
/// @param has_bound    whether the error of the estimates has a guaranteed bound
/// @throws ConfigError for the first fault: a name that does not exist, a frame that is missing.
std::optional<OutputsConfig> read_outputs(ConfigSection& root, const BodyNames& names,
                                          const std::string& world_frame, bool has_bound);

}  // namespace sampled_data_observers
