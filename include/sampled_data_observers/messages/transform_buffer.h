#pragma once

#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "sampled_data_observers/config/frame_config.h"
#include "sampled_data_observers/config/navsat_config.h"
#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// Characters of "from -> to", written by write_pair().
constexpr std::size_t kLongestPair = 144;

/// Writes the names of two frames, cut so that they fit, into a text with that much room: then it
/// allocates nothing.
void write_pair(const std::string& from, const std::string& to, std::string& text);

class LocalPlane;

/// The transforms that are known: those of the configuration, and what came on /tf and /tf_static,
/// of which it keeps the last 10 s. It is filled by whoever reads these topics, live or from a bag,
/// so that both know the same. And that from the earth into the local plane.
class TransformBuffer {
 public:
  /// @param transforms  those of the configuration, which hold at every stamp
  /// @param datum       of the local plane; nothing: there is none
  explicit TransformBuffer(const std::vector<StaticTransform>& transforms,
                           const std::optional<NavSatDatum>& datum = std::nullopt);

  /// Takes in transforms that arrive at `now`. Those of children that the configuration has
  /// transforms for are left out: it overrules the topics. So are moving ones from so far ahead
  /// that those of the present would be forgotten for them; before a simulated clock begins, when
  /// `now` is 0, nobody can tell.
  void take(const tf2_msgs::TFMessage& message, bool is_static, Stamp now);

  /// The pose of frame `source` in frame `target` at a stamp; nothing where it is not known (yet).
  /// Transforms between two stamps are interpolated, and never extrapolated; that of a frame in
  /// itself is always known.
  /// @pre stamp > 0
  std::optional<Eigen::Isometry3d> find(const std::string& target, const std::string& source,
                                        Stamp stamp) const;

  /// The pose of frame `source` in frame `target` where both are rigidly attached to each other,
  /// one and the same among them; nothing where that is not known (yet).
  std::optional<Eigen::Isometry3d> find_static(const std::string& target,
                                               const std::string& source) const;

  /// Forgets all moving transforms, since time begins anew.
  void clear();

  /// The local plane; null where there is none. Sources whose fields are in it set its datum.
  const std::shared_ptr<LocalPlane>& plane() const { return plane_; }

  /// Its datum as a configuration has it, "[latitude, longitude, altitude]"; empty as long as there
  /// is none.
  std::string datum_text() const;

 private:
  tf2::BufferCore buffer_;
  tf2::BufferCore static_buffer_;  ///< of those that never move, alone
  std::set<std::string> configured_children_;
  std::shared_ptr<LocalPlane> plane_;
};

}  // namespace sampled_data_observers
