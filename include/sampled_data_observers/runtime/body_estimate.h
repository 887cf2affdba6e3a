#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>

namespace sampled_data_observers {

/// Pose and velocity of a rigid body, with their covariances in the order of ROS: x, y, z, then the
/// rotations about x, y, z.
struct BodyEstimate {
  /// Positions or velocities first, then rotations: m², m rad and rad², or the same per s².
  using Covariance = Eigen::Matrix<double, 6, 6>;

  /// Of the body in the world frame [m].
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  /// From the body frame to the world frame.
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  /// In the body frame [m/s].
  Eigen::Vector3d linear_velocity = Eigen::Vector3d::Zero();
  /// In the body frame [rad/s].
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();
  /// Of position and of small rotations about the axes of the world frame.
  Covariance pose_covariance = Covariance::Zero();
  /// Of the velocities in the body frame.
  Covariance twist_covariance = Covariance::Zero();
};

/// One number of a body's pose or velocity: an estimated state, an input or, without either, a
/// constant.
struct BodyNumber {
  std::optional<Eigen::Index> state;  ///< position in the estimate
  std::optional<Eigen::Index> input;  ///< position in u, where it is no state
  double constant = 0.0;              ///< where it is neither
};

/// Which states and inputs of a plant are the pose and the velocity of a rigid body.
struct BodyStates {
  /// Of the body in the world frame [m].
  std::array<BodyNumber, 3> position;
  /// Roll, pitch and yaw: the body is rotated about the fixed axes x, y, z of the world, in this
  /// order.
  std::array<BodyNumber, 3> roll_pitch_yaw;
  /// x, y, z, w; instead of roll, pitch and yaw where present.
  std::optional<std::array<BodyNumber, 4>> quaternion;
  /// [m/s]
  std::array<BodyNumber, 3> linear_velocity;
  /// [rad/s]
  std::array<BodyNumber, 3> angular_velocity;
  /// Whether the velocities are those along the axes of the world frame instead of the body's.
  bool velocity_in_world = false;
  /// Variances of that of the pose which the observer has no covariance of, in the order of
  /// BodyEstimate [m², rad²].
  std::array<double, 6> pose_variances{};
  /// The same of the velocities [m²/s², rad²/s²].
  std::array<double, 6> twist_variances{};
};

/// Reads a body's pose and velocity off an estimate. Allocates nothing.
class BodyReader {
 public:
  /// @pre every state is an index of the estimates to be read, and every input one of the inputs
  explicit BodyReader(const BodyStates& states);

  /// @param estimate    n states
  /// @param input       the input that holds with them; may be null where no number is an input
  /// @param covariance  n x n, symmetric; null where the observer has none
  /// @param n           number of estimated states
  /// @param body        is written
  ///
  /// A quaternion is normalized, and is the identity where it is too short for that. Covariances
  /// are carried over to first order; the uncertainty of the orientation is left out of those of
  /// velocities given in the world frame.
  void read(const double* estimate, const double* input, const double* covariance, Eigen::Index n,
            BodyEstimate& body) const;

  /// Replaces the covariance of the pose by an ellipsoid, (error)(error)ᵀ <= it, from one of the
  /// states; the variances of what is no state stay. Where that is not finite, or beyond
  /// kUnknownVariance, by that for each of its axes. Q is n x n and symmetric: the ellipsoid that
  /// holds the error of the estimate; the others as for read().
  /// @pre at most one of roll, pitch and yaw is a state, and none of the quaternion's numbers: the
  ///      error of the pose is linear in that of the states
  void read_pose_ellipsoid(const double* estimate, const double* input, const double* Q,
                           Eigen::Index n, BodyEstimate& body) const;

  /// Stands for nothing known [m², rad²]: finite, as filters that take covariances need it.
  static constexpr double kUnknownVariance = 1e12;

 private:
  using Numbers = std::array<BodyNumber, 7>;

  void read_orientation(const double* estimate, const double* input, BodyEstimate& body,
                        Eigen::Matrix<double, 3, 4>& jacobian) const;
  std::array<BodyNumber, 6> pose_axes() const;

  BodyStates states_;
  /// Position and orientation, and the two velocities: what the covariances are of.
  Numbers pose_;
  std::array<BodyNumber, 6> twist_;
};

}  // namespace sampled_data_observers
