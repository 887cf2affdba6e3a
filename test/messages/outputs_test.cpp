// What needs no roscore: from an estimate to messages and transforms.
#include <gtest/gtest.h>

#include "sampled_data_observers/messages/body_messages.h"
#include "sampled_data_observers/runtime/odom_frame.h"
#include "support/allocation_counter.h"

namespace sampled_data_observers {
namespace {

BodyEstimate some_body() {
  BodyEstimate body;
  body.position << 1, 2, 3;
  body.orientation = Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5);
  body.linear_velocity << 4, 5, 6;
  body.angular_velocity << 7, 8, 9;
  for (Eigen::Index i = 0; i < 36; ++i) {
    body.pose_covariance(i / 6, i % 6) = static_cast<double>(std::min(i / 6, i % 6) + 1);
  }
  body.twist_covariance = 2.0 * body.pose_covariance;
  return body;
}

TEST(BodyMessagesTest, OdometryHoldsPoseAndTwist) {
  nav_msgs::Odometry message;
  message.child_frame_id = "a frame whose name is not short";
  const BodyEstimate body = some_body();
  const std::size_t before = test::allocations();
  write(body, message);
  EXPECT_TRUE(test::allocations() == before || !test::allocations_are_counted());
  EXPECT_EQ(3.0, message.pose.pose.position.z);
  EXPECT_EQ(0.5, message.pose.pose.orientation.w);
  EXPECT_EQ(-0.5, message.pose.pose.orientation.y);
  EXPECT_EQ(5.0, message.twist.twist.linear.y);
  EXPECT_EQ(7.0, message.twist.twist.angular.x);
  EXPECT_EQ(2.0, message.pose.covariance[1 * 6 + 3]);
  EXPECT_EQ(12.0, message.twist.covariance[35]);
  EXPECT_EQ("a frame whose name is not short", message.child_frame_id);
}

TEST(BodyMessagesTest, PoseAndTwistAlone) {
  geometry_msgs::PoseWithCovarianceStamped pose;
  write(some_body(), pose);
  EXPECT_EQ(1.0, pose.pose.pose.position.x);
  EXPECT_EQ(1.0, pose.pose.covariance[5]);
  geometry_msgs::TwistWithCovarianceStamped twist;
  write(some_body(), twist);
  EXPECT_EQ(9.0, twist.twist.twist.angular.z);
  EXPECT_EQ(2.0, twist.twist.covariance[0]);
}

StampedTransform at(Stamp stamp, double x) {
  StampedTransform result;
  result.stamp = stamp;
  result.transform.translation().x() = x;
  return result;
}

/// An odometry that is known up to a stamp: x(t) = t.
OdomFrame::Odometry known_until(Stamp last) {
  return [last](Stamp stamp) -> std::optional<Eigen::Isometry3d> {
    if (stamp > last) return std::nullopt;
    return at(stamp, static_cast<double>(stamp)).transform;
  };
}

TEST(OdomFrameTest, IsWhereTheEstimateWouldHaveTheOdometryStart) {
  // The body stands 1 m ahead of odom, turned left; in the world it faces along y at (5, 5).
  const Eigen::AngleAxisd left(1.5707963267948966, Eigen::Vector3d::UnitZ());
  Eigen::Isometry3d odom_to_base = Eigen::Isometry3d::Identity();
  odom_to_base.translation().x() = 1.0;
  odom_to_base.linear() = left.toRotationMatrix();
  StampedTransform world_to_base = at(7, 5.0);
  world_to_base.transform.translation().y() = 5.0;
  world_to_base.transform.linear() = left.toRotationMatrix();
  OdomFrame frame(100, 1);
  frame.add(world_to_base);
  const auto found = frame.next([&](Stamp) { return std::make_optional(odom_to_base); });
  ASSERT_TRUE(found);
  EXPECT_EQ(7, found->stamp);
  EXPECT_TRUE(found->transform.linear().isIdentity(1e-12));
  EXPECT_TRUE(found->transform.translation().isApprox(Eigen::Vector3d(4.0, 5.0, 0.0), 1e-12));
}

TEST(OdomFrameTest, EstimatesWaitForTheOdometryOfTheirStamp) {
  OdomFrame frame(100, 10);
  for (const Stamp stamp : {10, 20, 30}) frame.add(at(stamp, static_cast<double>(stamp) + 1.0));
  EXPECT_FALSE(frame.next(known_until(9)));
  for (const Stamp stamp : {10, 20}) {
    const auto found = frame.next(known_until(25));
    ASSERT_TRUE(found);
    EXPECT_EQ(stamp, found->stamp);
    EXPECT_NEAR(1.0, found->transform.translation().x(), 1e-12);
  }
  EXPECT_FALSE(frame.next(known_until(25)));
  EXPECT_EQ(30, frame.next(known_until(30))->stamp);
  EXPECT_EQ(0u, frame.dropped());
}

TEST(OdomFrameTest, DropsWhatIsTooOldOrTooMuch) {
  OdomFrame frame(100, 3);
  frame.add(at(10, 0.0));
  frame.add(at(111, 0.0));
  EXPECT_EQ(1u, frame.dropped());
  for (const Stamp stamp : {112, 113, 114}) frame.add(at(stamp, 0.0));
  EXPECT_EQ(2u, frame.dropped());
  EXPECT_EQ(112, frame.next(known_until(1000))->stamp);
}

TEST(OdomFrameTest, ForgetsWhatWaitsWhenTimeGoesBack) {
  OdomFrame frame(100, 3);
  frame.add(at(50, 0.0));
  frame.add(at(20, 0.0));
  EXPECT_EQ(20, frame.next(known_until(1000))->stamp);
  EXPECT_FALSE(frame.next(known_until(1000)));
}

}  // namespace
}  // namespace sampled_data_observers
