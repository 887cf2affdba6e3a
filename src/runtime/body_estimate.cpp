#include "sampled_data_observers/runtime/body_estimate.h"

#include <algorithm>
#include <cmath>

namespace sampled_data_observers {
namespace {

constexpr double kShortestQuaternion = 1e-6;

double value_of(const BodyNumber& number, const double* estimate, const double* input) {
  if (number.input) return input[*number.input];
  return number.state ? estimate[*number.state] : number.constant;
}

Eigen::Vector3d values_of(const std::array<BodyNumber, 3>& numbers, const double* estimate,
                          const double* input) {
  return {value_of(numbers[0], estimate, input), value_of(numbers[1], estimate, input),
          value_of(numbers[2], estimate, input)};
}

/// The rows and columns of a covariance (n x n) that belong to some numbers; inputs and
/// constants have none.
template <std::size_t N>
Eigen::Matrix<double, int{N}, int{N}> select(const std::array<BodyNumber, N>& numbers,
                                             const double* covariance, Eigen::Index n) {
  Eigen::Matrix<double, int{N}, int{N}> selected = Eigen::Matrix<double, int{N}, int{N}>::Zero();
  for (std::size_t row = 0; row < N; ++row) {
    for (std::size_t col = 0; col < N; ++col) {
      if (!numbers[row].state || !numbers[col].state) continue;
      selected(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(col)) =
          covariance[*numbers[row].state * n + *numbers[col].state];
    }
  }
  return selected;
}

/// Adds the variances of what is no state, or of all where nothing has a covariance.
void add_variances(const std::array<BodyNumber, 6>& numbers, bool has_covariance,
                   const std::array<double, 6>& variances, BodyEstimate::Covariance& covariance) {
  for (std::size_t i = 0; i < variances.size(); ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    if (!has_covariance || !numbers[i].state) covariance(axis, axis) += variances[i];
  }
}

}  // namespace

BodyReader::BodyReader(const BodyStates& states) : states_(states) {
  std::copy(states_.position.begin(), states_.position.end(), pose_.begin());
  if (states_.quaternion) {
    std::copy(states_.quaternion->begin(), states_.quaternion->end(), pose_.begin() + 3);
  } else {
    std::copy(states_.roll_pitch_yaw.begin(), states_.roll_pitch_yaw.end(), pose_.begin() + 3);
  }
  std::copy(states_.linear_velocity.begin(), states_.linear_velocity.end(), twist_.begin());
  std::copy(states_.angular_velocity.begin(), states_.angular_velocity.end(), twist_.begin() + 3);
}

/// `jacobian`: the rotation about the axes of the world that a small change of each of the numbers
/// of the orientation makes.
void BodyReader::read_orientation(const double* estimate, const double* input, BodyEstimate& body,
                                  Eigen::Matrix<double, 3, 4>& jacobian) const {
  jacobian.setZero();
  if (!states_.quaternion) {
    const Eigen::Vector3d angles = values_of(states_.roll_pitch_yaw, estimate, input);
    const Eigen::Quaterniond yaw(Eigen::AngleAxisd(angles.z(), Eigen::Vector3d::UnitZ()));
    const Eigen::Quaterniond yaw_and_pitch =
        yaw * Eigen::AngleAxisd(angles.y(), Eigen::Vector3d::UnitY());
    body.orientation = yaw_and_pitch * Eigen::AngleAxisd(angles.x(), Eigen::Vector3d::UnitX());
    jacobian.col(0) = yaw_and_pitch * Eigen::Vector3d::UnitX();
    jacobian.col(1) = yaw * Eigen::Vector3d::UnitY();
    jacobian.col(2) = Eigen::Vector3d::UnitZ();
    return;
  }
  const std::array<BodyNumber, 4>& q = *states_.quaternion;
  body.orientation.coeffs() << value_of(q[0], estimate, input), value_of(q[1], estimate, input),
      value_of(q[2], estimate, input), value_of(q[3], estimate, input);
  const double length = body.orientation.norm();
  if (!(length >= kShortestQuaternion)) {
    body.orientation.setIdentity();
    return;
  }
  body.orientation.coeffs() /= length;
  // A rotation by θ about the axes of the world changes q by (θ, 0) q / 2, so θ = 2 dq q*.
  const Eigen::Vector3d v = body.orientation.vec();
  jacobian << body.orientation.w(), -v.z(), v.y(), -v.x(),  //
      v.z(), body.orientation.w(), -v.x(), -v.y(),          //
      -v.y(), v.x(), body.orientation.w(), -v.z();
  jacobian *= 2.0 / length;
}

void BodyReader::read(const double* estimate, const double* input, const double* covariance,
                      Eigen::Index n, BodyEstimate& body) const {
  Eigen::Matrix<double, 6, 7> jacobian = Eigen::Matrix<double, 6, 7>::Zero();
  jacobian.topLeftCorner<3, 3>().setIdentity();
  Eigen::Matrix<double, 3, 4> orientation_jacobian;
  body.position = values_of(states_.position, estimate, input);
  read_orientation(estimate, input, body, orientation_jacobian);
  jacobian.bottomRightCorner<3, 4>() = orientation_jacobian;

  body.linear_velocity = values_of(states_.linear_velocity, estimate, input);
  body.angular_velocity = values_of(states_.angular_velocity, estimate, input);
  body.pose_covariance.setZero();
  body.twist_covariance.setZero();
  if (covariance != nullptr) {
    body.pose_covariance = jacobian * select(pose_, covariance, n) * jacobian.transpose();
    body.twist_covariance = select(twist_, covariance, n);
  }
  if (states_.velocity_in_world) {
    const Eigen::Matrix3d to_body = body.orientation.toRotationMatrix().transpose();
    body.linear_velocity = to_body * body.linear_velocity;
    body.angular_velocity = to_body * body.angular_velocity;
    BodyEstimate::Covariance to_body_twice = BodyEstimate::Covariance::Zero();
    to_body_twice.topLeftCorner<3, 3>() = to_body;
    to_body_twice.bottomRightCorner<3, 3>() = to_body;
    body.twist_covariance = to_body_twice * body.twist_covariance * to_body_twice.transpose();
  }
  const bool has_covariance = covariance != nullptr;
  add_variances(pose_axes(), has_covariance, states_.pose_variances, body.pose_covariance);
  add_variances(twist_, has_covariance, states_.twist_variances, body.twist_covariance);
}

std::array<BodyNumber, 6> BodyReader::pose_axes() const {
  std::array<BodyNumber, 6> axes;
  std::copy_n(pose_.begin(), axes.size(), axes.begin());
  return axes;
}

void BodyReader::read_pose_ellipsoid(const double* estimate, const double* input, const double* Q,
                                     Eigen::Index n, BodyEstimate& body) const {
  Eigen::Matrix<double, 6, 7> jacobian = Eigen::Matrix<double, 6, 7>::Zero();
  jacobian.topLeftCorner<3, 3>().setIdentity();
  Eigen::Matrix<double, 3, 4> of_orientation;
  read_orientation(estimate, input, body, of_orientation);
  jacobian.bottomRightCorner<3, 4>() = of_orientation;
  BodyEstimate::Covariance& ellipsoid = body.pose_covariance;
  ellipsoid = jacobian * select(pose_, Q, n) * jacobian.transpose();
  // Not so of what is no number.
  if (!(ellipsoid.cwiseAbs().maxCoeff() <= kUnknownVariance) || !ellipsoid.allFinite()) {
    ellipsoid.setZero();
    for (std::size_t i = 0; i < pose_.size(); ++i) {
      if (!pose_[i].state) continue;
      for (Eigen::Index axis = 0; axis < ellipsoid.rows(); ++axis) {
        if (jacobian(axis, static_cast<Eigen::Index>(i)) == 0.0) continue;
        ellipsoid(axis, axis) = kUnknownVariance;
      }
    }
  }
  add_variances(pose_axes(), true, states_.pose_variances, ellipsoid);
}

}  // namespace sampled_data_observers
