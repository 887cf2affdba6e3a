#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "messages/definition/plan_compiler.h"
#include "sampled_data_observers/config/topic_config.h"
#include "sampled_data_observers/messages/transform_buffer.h"

namespace sampled_data_observers {

/// What of a message depends on its frame, and how it is brought into the frames that its source is
/// configured for. F is the frame in the message's first header, (R, t) the pose of F in the
/// configured frame G.
///
/// | type, wherever it stands | in G |
/// | --- | --- |
/// | Point | R p + t |
/// | Vector3 | R v |
/// | Pose, Transform | (R, t) times the pose |
/// | Twist | that of G's origin, both on one rigid body: ω = R ω_F, v = R v_F + t × ω |
/// | Wrench | about G's origin: f = R f_F, τ = R τ_F + t × f |
/// | Accel | rotated only: another point's takes angular velocity and acceleration |
/// | Imu | F is the sensor's own frame, G one on the same body: rotated, q R⁻¹ |
///
/// The twist of a message with a child_frame_id is given in that frame, and stays. Covariances
/// stay.
class FrameBlocks {
 public:
  /// Asks the compiler for all that they take.
  /// @param fields  what is wanted of the messages
  /// @throws ConfigError for frames that messages of this definition have no use for.
  FrameBlocks(const TopicSource& source, const MessageDefinition& definition,
              const std::vector<MessagePath>& fields, PlanCompiler& compiler);

  /// Brings a message into the configured frames; returns false while a transform is not known.
  /// @pre stamp > 0; `transforms` is not null where the source has frames
  bool transform(DecodedMessage& message, Stamp stamp, const TransformBuffer* transforms);

  /// Writes which transform transform() did not find, "from -> to", into a text with room for
  /// kLongestPair characters: names are cut where they are too long for it.
  /// @pre the source has frames
  void name_missing(const DecodedMessage& message, Stamp stamp, const TransformBuffer& transforms,
                    std::string& text) const;

 private:
  enum class Kind : std::uint8_t { kPoint, kVector, kPose, kTwist, kWrench, kAccel, kImu };
  /// Its slots: three for each vector, x, y, z and w for a quaternion, in the order of the members.
  struct Block {
    Kind kind = Kind::kPoint;
    bool is_of_child = false;
    std::array<std::size_t, 10> slots{};
  };

  static std::optional<Kind> kind_of(const std::string& type);
  static bool has_block(const MessageDefinition& definition, bool is_pose);
  void require_use(const TopicSource& source, const MessageDefinition& definition) const;
  void add(const TopicSource& source, const MessageDefinition& definition, const MessagePath& field,
           PlanCompiler& compiler);
  static void to_frame(const Eigen::Isometry3d& pose, const Block& block, DecodedMessage& message);
  static void to_body(const Eigen::Isometry3d& body, const Block& block, DecodedMessage& message);
  std::string header_frame(const DecodedMessage& message) const;
  std::string sensor_frame(const DecodedMessage& message) const;

  SourceFrames frames_;
  bool has_child_ = false;
  std::size_t header_frame_ = 0;  ///< slots of texts
  std::size_t child_frame_ = 0;
  std::vector<MessagePath> known_;
  std::vector<Block> blocks_;
};

}  // namespace sampled_data_observers
