#pragma once

#include <tf2_msgs/TFMessage.h>

#include "sampled_data_observers/config/config_node.h"
#include "sampled_data_observers/config/frame_places.h"
#include "sampled_data_observers/messages/transform_buffer.h"

namespace sampled_data_observers {

/// The places of frames that a configuration has for parameters, on their way to become numbers:
/// looked up once, in its static_transforms and in what comes on /tf_static. Live and in replay
/// alike, the first messages with which all are known decide.
class StaticPlaces {
 public:
  /// @throws ConfigError
  explicit StaticPlaces(ConfigNode tree);

  /// Whether no message is wanted any more.
  bool are_known() const;

  /// How long a start waits for the last of them [ns].
  Duration timeout() const;

  /// Takes in static transforms.
  void take(const tf2_msgs::TFMessage& message);

  /// The configuration with numbers for them. @throws ConfigError where one is not known.
  ConfigNode tree() const;

 private:
  std::optional<Eigen::Vector3d> find(const FramePlace& place) const;

  ConfigNode tree_;
  std::vector<FramePlace> places_;
  TransformBuffer transforms_;
};

}  // namespace sampled_data_observers
