#include "sampled_data_observers/messages/static_places.h"

#include <algorithm>
#include <utility>

#include "sampled_data_observers/config/config_section.h"

namespace sampled_data_observers {
namespace {

std::vector<StaticTransform> static_transforms_of(const ConfigNode& tree) {
  ConfigSection root(tree, "");
  return read_static_transforms(root);
}

}  // namespace

StaticPlaces::StaticPlaces(ConfigNode tree)
    : tree_(std::move(tree)),
      places_(frame_places(tree_)),
      transforms_(places_.empty() ? std::vector<StaticTransform>() : static_transforms_of(tree_)) {}

bool StaticPlaces::are_known() const {
  return std::all_of(places_.begin(), places_.end(),
                     [this](const FramePlace& place) { return find(place).has_value(); });
}

Duration StaticPlaces::timeout() const {
  Duration longest = 0;
  for (const FramePlace& place : places_) longest = std::max(longest, place.timeout);
  return longest;
}

void StaticPlaces::take(const tf2_msgs::TFMessage& message) {
  const bool is_static = true;
  const Stamp of_no_use = 0;
  transforms_.take(message, is_static, of_no_use);
}

ConfigNode StaticPlaces::tree() const {
  return with_places(tree_, [this](const FramePlace& place) { return find(place); });
}

std::optional<Eigen::Vector3d> StaticPlaces::find(const FramePlace& place) const {
  const std::optional<Eigen::Isometry3d> pose =
      transforms_.find_static(place.frame, place.child_frame);
  if (!pose) return std::nullopt;
  return pose->translation();
}

}  // namespace sampled_data_observers
