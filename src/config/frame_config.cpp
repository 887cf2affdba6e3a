#include "sampled_data_observers/config/frame_config.h"

#include <map>

namespace sampled_data_observers {
namespace {

constexpr double kLongestWait = 1000.0;  // s

std::string read_frame(ConfigSection& section, const std::string& key) {
  const std::string expected = "a name of a frame, without a slash in front";
  if (!section.has(key)) throw section.error(key, expected, section.absence_of(key));
  std::string frame = section.text(key);
  if (frame.empty() || frame.front() == '/') throw section.error(key, expected, "'" + frame + "'");
  return frame;
}

Duration read_tf_timeout(ConfigSection& source) {
  return from_seconds(source.number_in("tf_timeout", 0.0, kLongestWait, 0.5));
}

std::string read_optional_frame(ConfigSection& section, const std::string& key) {
  return section.has(key) ? read_frame(section, key) : "";
}

StaticTransform read_static_transform(ConfigSection& section) {
  StaticTransform transform;
  transform.frame = read_frame(section, "frame");
  transform.child_frame = read_frame(section, "child_frame");
  if (section.has("translation")) transform.translation = section.vector("translation", 3);
  ConfigSection rotation = section.section_or_empty("rotation");
  const char* const angles[] = {"roll", "pitch", "yaw"};
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (rotation.has(angles[i])) transform.rotation(i) = rotation.number(angles[i]);
  }
  rotation.finish();
  section.finish();
  return transform;
}

}  // namespace

SourceFrames read_source_frames(ConfigSection& source) {
  SourceFrames frames;
  frames.frame = read_optional_frame(source, "frame");
  frames.body_frame = read_optional_frame(source, "body_frame");
  frames.sensor_frame = read_optional_frame(source, "sensor_frame");
  if (frames.body_frame.empty() && !frames.sensor_frame.empty()) {
    throw source.error("sensor_frame", "a body_frame beside it", "none");
  }
  if (!frames.any() && source.has("tf_timeout")) {
    throw source.error("tf_timeout", "a frame or body_frame beside it", "none");
  }
  frames.timeout = read_tf_timeout(source);
  return frames;
}

SourceFrames read_transform_frames(ConfigSection& source) {
  SourceFrames frames;
  frames.frame = read_frame(source, "frame");
  frames.child_frame = read_frame(source, "child_frame");
  if (frames.frame == frames.child_frame) {
    throw source.error("child_frame", "another frame than " + frames.frame, "the same");
  }
  frames.timeout = read_tf_timeout(source);
  return frames;
}

std::vector<StaticTransform> read_static_transforms(ConfigSection& root) {
  std::vector<StaticTransform> transforms;
  if (!root.has("static_transforms")) return transforms;
  std::map<std::string, std::string> parents;
  for (ConfigSection& section : root.sections("static_transforms")) {
    const StaticTransform& transform = transforms.emplace_back(read_static_transform(section));
    if (!parents.emplace(transform.child_frame, transform.frame).second) {
      throw section.error("child_frame", "a frame that has no transform above",
                          "'" + transform.child_frame + "'");
    }
    std::string ancestor = transform.frame;
    while (parents.count(ancestor) != 0 && ancestor != transform.child_frame) {
      ancestor = parents.at(ancestor);
    }
    if (ancestor == transform.child_frame) {
      throw section.error("frame", "a frame that does not hang on its own child",
                          "'" + transform.frame + "'");
    }
  }
  return transforms;
}

}  // namespace sampled_data_observers
