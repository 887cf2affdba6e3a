#include "sampled_data_observers/config/frame_places.h"

#include <algorithm>
#include <utility>

#include "config/number_text.h"
#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/config/frame_config.h"

namespace sampled_data_observers {
namespace {

/// Publishers of static transforms may start after the observer.
constexpr Duration kWait = 10 * kNanosecondsPerSecond;

using Entry = std::pair<std::string, ConfigNode>;

ConfigNode* entry(ConfigNode* of, const std::string& key) {
  if (of == nullptr) return nullptr;
  for (Entry& found : of->entries) {
    if (found.first == key) return &found.second;
  }
  return nullptr;
}

std::string path_of(const std::string& name) { return "plant/parameters/" + name; }

FramePlace read_place(const std::string& name, const ConfigNode& node) {
  ConfigSection section(node, path_of(name));
  const bool has_timeout = section.has("tf_timeout");
  const SourceFrames frames = read_transform_frames(section);
  section.finish();
  return {name, frames.frame, frames.child_frame, has_timeout ? frames.timeout : kWait};
}

}  // namespace

std::vector<FramePlace> frame_places(const ConfigNode& tree) {
  std::vector<FramePlace> places;
  const ConfigNode* plant = tree.find("plant");
  const ConfigNode* parameters = plant == nullptr ? nullptr : plant->find("parameters");
  if (parameters == nullptr) return places;
  for (const auto& [name, value] : parameters->entries) {
    if (value.kind == ConfigNode::Kind::kMap) places.push_back(read_place(name, value));
  }
  return places;
}

ConfigNode with_places(ConfigNode tree, const PlaceFinder& find) {
  for (const FramePlace& place : frame_places(tree)) {
    ConfigNode& parameters = *entry(entry(&tree, "plant"), "parameters");
    const ConfigNode node = *parameters.find(place.name);
    const std::optional<Eigen::Vector3d> found = find(place);
    if (!found) {
      throw ConfigError(node.origin, path_of(place.name),
                        "the place of " + place.child_frame + " in " + place.frame +
                            ", from static_transforms or /tf_static",
                        "none in " + number_text(to_seconds(place.timeout)) + " s");
    }
    std::vector<Entry>& all = parameters.entries;
    all.erase(std::find_if(all.begin(), all.end(),
                           [&](const Entry& other) { return other.first == place.name; }));
    for (Eigen::Index i = 0; i < 3; ++i) {
      const std::string name = place.name + "_" + "xyz"[i];
      if (parameters.find(name) != nullptr) {
        throw ConfigError(node.origin, path_of(name), "one of " + place.name + " only", "two");
      }
      ConfigNode number;
      number.kind = ConfigNode::Kind::kScalar;
      number.origin = node.origin;
      number.scalar = number_text((*found)(i), 17);
      all.emplace_back(name, std::move(number));
    }
  }
  return tree;
}

}  // namespace sampled_data_observers
