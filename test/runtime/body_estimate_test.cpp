#include "sampled_data_observers/runtime/body_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/allocation_counter.h"

namespace sampled_data_observers {
namespace {

constexpr double kQuarterTurn = 1.5707963267948966;

BodyNumber state(Eigen::Index index) {
  BodyNumber number;
  number.state = index;
  return number;
}

/// The rotation vector of `to` seen from `from`, about the axes of the world.
Eigen::Vector3d rotation(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  const Eigen::AngleAxisd difference(to * from.conjugate());
  return difference.angle() * difference.axis();
}

/// The pose's covariance from that of the states, by differences.
BodyEstimate::Covariance covariance_by_differences(const BodyReader& reader,
                                                   const Eigen::VectorXd& estimate,
                                                   const Eigen::MatrixXd& covariance) {
  constexpr double kStep = 1e-6;
  Eigen::MatrixXd jacobian(6, estimate.size());
  BodyEstimate here;
  reader.read(estimate.data(), nullptr, nullptr, 0, here);
  for (Eigen::Index i = 0; i < estimate.size(); ++i) {
    Eigen::VectorXd moved = estimate;
    moved(i) += kStep;
    BodyEstimate there;
    reader.read(moved.data(), nullptr, nullptr, 0, there);
    jacobian.col(i).head(3) = (there.position - here.position) / kStep;
    jacobian.col(i).tail(3) = rotation(here.orientation, there.orientation) / kStep;
  }
  return jacobian * covariance * jacobian.transpose();
}

Eigen::MatrixXd some_covariance(Eigen::Index n) {
  Eigen::MatrixXd root = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i) root(i, (i + 1) % n) = 0.25 * static_cast<double>(i + 1);
  return root * root.transpose();
}

BodyEstimate::Covariance diagonal(const std::array<double, 6>& variances) {
  return Eigen::Matrix<double, 6, 1>(variances.data()).asDiagonal();
}

TEST(BodyReaderTest, MissingNumbersAreConstants) {
  BodyStates states;
  states.position[1] = state(1);
  states.position[2].constant = 0.3;
  const double estimate[] = {7.0, -2.0};
  BodyEstimate body;
  BodyReader(states).read(estimate, nullptr, nullptr, 2, body);
  EXPECT_EQ(Eigen::Vector3d(0.0, -2.0, 0.3), body.position);
  EXPECT_EQ(Eigen::Vector4d(0, 0, 0, 1), body.orientation.coeffs());
  EXPECT_EQ(Eigen::Vector3d::Zero(), body.linear_velocity);
}

TEST(BodyReaderTest, AnglesAreAboutFixedAxes) {
  BodyStates states;
  for (std::size_t i = 0; i < 3; ++i)
    states.roll_pitch_yaw[i] = state(static_cast<Eigen::Index>(i));
  const double estimate[] = {kQuarterTurn, 0.0, kQuarterTurn};
  BodyEstimate body;
  BodyReader(states).read(estimate, nullptr, nullptr, 3, body);
  // First about x: z of the body points to −y of the world. Then about z: to x.
  EXPECT_NEAR(1.0, (body.orientation * Eigen::Vector3d::UnitZ()).x(), 1e-12);
  EXPECT_NEAR(1.0, (body.orientation * Eigen::Vector3d::UnitX()).y(), 1e-12);
}

TEST(BodyReaderTest, ATooShortQuaternionIsTheIdentity) {
  BodyStates states;
  states.quaternion = {state(0), state(1), state(2), state(3)};
  BodyEstimate body;
  const double zero[] = {0.0, 0.0, 0.0, 0.0};
  const Eigen::MatrixXd covariance = some_covariance(4);
  BodyReader(states).read(zero, nullptr, covariance.data(), 4, body);
  EXPECT_EQ(Eigen::Vector4d(0, 0, 0, 1), body.orientation.coeffs());
  EXPECT_TRUE(body.pose_covariance.allFinite());
  const double twice[] = {0.0, 2.0, 0.0, 0.0};
  BodyReader(states).read(twice, nullptr, covariance.data(), 4, body);
  EXPECT_EQ(Eigen::Vector4d(0, 1, 0, 0), body.orientation.coeffs());
}

TEST(BodyReaderTest, VelocitiesOfTheWorldAreTurnedIntoTheBody) {
  BodyStates states;
  states.roll_pitch_yaw[2] = state(0);
  states.linear_velocity[0] = state(1);
  states.linear_velocity[1] = state(2);
  states.velocity_in_world = true;
  const double estimate[] = {kQuarterTurn, 3.0, 0.0};
  const Eigen::Matrix3d covariance = Eigen::Vector3d(0.5, 4.0, 1.0).asDiagonal();
  BodyEstimate body;
  BodyReader(states).read(estimate, nullptr, covariance.data(), 3, body);
  EXPECT_NEAR(0.0, body.linear_velocity.x(), 1e-12);
  EXPECT_NEAR(-3.0, body.linear_velocity.y(), 1e-12);
  EXPECT_NEAR(1.0, body.twist_covariance(0, 0), 1e-12);
  EXPECT_NEAR(4.0, body.twist_covariance(1, 1), 1e-12);
}

TEST(BodyReaderTest, CovariancesOfAnglesAreCarriedOver) {
  BodyStates states;
  for (std::size_t i = 0; i < 3; ++i) {
    states.roll_pitch_yaw[i] = state(static_cast<Eigen::Index>(i));
    states.position[i] = state(static_cast<Eigen::Index>(5 - i));
  }
  const BodyReader reader(states);
  Eigen::VectorXd estimate(6);
  estimate << 0.4, -0.7, 1.9, 1.0, 2.0, 3.0;
  const Eigen::MatrixXd covariance = some_covariance(6);
  BodyEstimate body;
  reader.read(estimate.data(), nullptr, covariance.data(), 6, body);
  const auto expected = covariance_by_differences(reader, estimate, covariance);
  EXPECT_TRUE(body.pose_covariance.isApprox(expected, 1e-5)) << body.pose_covariance - expected;
}

TEST(BodyReaderTest, CovariancesOfAQuaternionAreCarriedOver) {
  BodyStates states;
  states.quaternion = {state(1), state(2), state(3), state(4)};
  states.position[1] = state(0);
  const BodyReader reader(states);
  Eigen::VectorXd estimate(5);
  estimate << 1.0, 0.4, -0.7, 0.5, 0.9;
  const Eigen::MatrixXd covariance = some_covariance(5);
  BodyEstimate body;
  reader.read(estimate.data(), nullptr, covariance.data(), 5, body);
  const auto expected = covariance_by_differences(reader, estimate, covariance);
  EXPECT_TRUE(body.pose_covariance.isApprox(expected, 1e-5)) << body.pose_covariance - expected;
}

TEST(BodyReaderTest, ConfiguredVariancesStandWhereThereIsNoCovariance) {
  BodyStates states;
  states.position[0] = state(0);
  states.roll_pitch_yaw[2] = state(1);
  states.pose_variances = {1, 2, 3, 4, 5, 6};
  states.twist_variances = {7, 8, 9, 10, 11, 12};
  const double estimate[] = {0.0, 0.0};
  const Eigen::Matrix2d covariance = Eigen::Vector2d(0.5, 0.25).asDiagonal();
  BodyEstimate body;
  BodyReader(states).read(estimate, nullptr, covariance.data(), 2, body);
  EXPECT_EQ(diagonal({0.5, 2, 3, 4, 5, 0.25}), body.pose_covariance);
  BodyReader(states).read(estimate, nullptr, nullptr, 2, body);
  EXPECT_EQ(diagonal({1, 2, 3, 4, 5, 6}), body.pose_covariance);
  EXPECT_EQ(12.0, body.twist_covariance(5, 5));
}

TEST(BodyReaderTest, InputsStandForWhatIsNoState) {
  BodyStates states;
  states.roll_pitch_yaw[2] = state(0);
  states.linear_velocity[0].input = 1;
  states.angular_velocity[2].input = 0;
  states.twist_variances = {7, 8, 9, 10, 11, 12};
  states.velocity_in_world = true;
  const double estimate[] = {kQuarterTurn};
  const double input[] = {0.5, 2.0};
  const double variance = 0.25;
  BodyEstimate body;
  BodyReader(states).read(estimate, input, &variance, 1, body);
  // The body looks along y of the world: what moves along x of it moves to the right.
  EXPECT_TRUE(body.linear_velocity.isApprox(Eigen::Vector3d(0.0, -2.0, 0.0), 1e-12));
  EXPECT_EQ(Eigen::Vector3d(0.0, 0.0, 0.5), body.angular_velocity);
  EXPECT_EQ(diagonal({7, 8, 9, 10, 11, 12}), body.twist_covariance);
}

TEST(BodyReaderTest, AllocatesNothing) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer allocates";
  BodyStates states;
  states.linear_velocity[0].input = 0;
  states.quaternion = {state(0), state(1), state(2), state(3)};
  states.velocity_in_world = true;
  const BodyReader reader(states);
  const Eigen::MatrixXd covariance = some_covariance(4);
  const double estimate[] = {0.1, 0.2, 0.3, 0.4};
  const double input = 1.0;
  BodyEstimate body;
  const std::size_t before = test::allocations();
  reader.read(estimate, &input, covariance.data(), 4, body);
  EXPECT_EQ(before, test::allocations());
}

/// The body's pose with the error of an estimate of x, yaw and y about it.
TEST(BodyReaderTest, AnEllipsoidOfTheStatesIsOneOfThePose) {
  BodyStates states;
  states.position[0] = state(0);
  states.position[1] = state(2);
  states.position[2].constant = 1.0;
  states.roll_pitch_yaw[0].constant = 0.2;
  states.roll_pitch_yaw[1].constant = -0.3;
  states.roll_pitch_yaw[2] = state(1);
  states.pose_variances = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0};
  const BodyReader reader(states);
  const double estimate[] = {7.0, 2.5, -2.0};
  const Eigen::MatrixXd Q = some_covariance(3);
  BodyEstimate body;
  reader.read(estimate, nullptr, nullptr, 3, body);
  const std::size_t before = test::allocations();
  reader.read_pose_ellipsoid(estimate, nullptr, Q.data(), 3, body);
  EXPECT_TRUE(test::allocations() == before || !test::allocations_are_counted());
  BodyEstimate::Covariance expected = BodyEstimate::Covariance::Zero();
  const Eigen::Index axes[] = {0, 5, 1};
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) expected(axes[i], axes[j]) = Q(i, j);
  }
  expected(2, 2) = 3.0;
  expected(3, 3) = 4.0;
  expected(4, 4) = 5.0;
  EXPECT_LT((body.pose_covariance - expected).norm(), 1e-14);
  // Any error of the states within, as the error of the pose that it makes.
  BodyEstimate there;
  for (int k = 0; k < 20; ++k) {
    const Eigen::Vector3d z = Eigen::Vector3d(std::sin(k), std::cos(2.0 * k), std::sin(3.0 * k));
    const Eigen::Vector3d e = Q * z / std::sqrt(z.dot(Q * z));
    const double moved[] = {estimate[0] + e(0), estimate[1] + e(1), estimate[2] + e(2)};
    reader.read(moved, nullptr, nullptr, 3, there);
    const Eigen::Vector3d turn = rotation(body.orientation, there.orientation);
    EXPECT_LT(turn.head<2>().norm(), 1e-12);
    EXPECT_NEAR(turn(2), e(1), 1e-12);
  }
}

TEST(BodyReaderTest, AnEllipsoidThatIsNotFiniteIsALargeOne) {
  BodyStates states;
  states.position[1] = state(0);
  states.roll_pitch_yaw[2] = state(1);
  states.pose_variances = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0};
  const BodyReader reader(states);
  const double estimate[] = {7.0, 2.5};
  for (const double width :
       {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN(), 1e200}) {
    const Eigen::MatrixXd Q = (Eigen::MatrixXd(2, 2) << width, 0.0, 0.0, 1.0).finished();
    BodyEstimate body;
    reader.read_pose_ellipsoid(estimate, nullptr, Q.data(), 2, body);
    const double unknown = BodyReader::kUnknownVariance;
    EXPECT_EQ(diagonal({1.0, unknown, 3.0, 4.0, 5.0, unknown}), body.pose_covariance);
  }
}

}  // namespace
}  // namespace sampled_data_observers
