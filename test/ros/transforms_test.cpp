// A measurement in the frame of a sensor that turns, with transforms that come late or never.
#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/PointStamped.h>
#include <std_msgs/Float64.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>

#include "ros/observer_client.h"

namespace sampled_data_observers {
namespace {

/// Waits until diagnostics say something.
bool is_diagnosed(const std::string& part) {
  bool found = false;
  const auto take = [&](const diagnostic_msgs::DiagnosticArrayConstPtr& array) {
    for (const diagnostic_msgs::DiagnosticStatus& status : array->status) {
      found |= status.message.find(part) != std::string::npos;
    }
  };
  const ros::Subscriber subscriber =
      ros::NodeHandle().subscribe<diagnostic_msgs::DiagnosticArray>("/diagnostics", 100, take);
  return test::spin_until([&] { return found; });
}

// First, while nothing was received yet.
TEST(WrongTypeTest, DiagnosticsNameTheTypeThatIsPublishedAndTheOneExpected) {
  const ros::Publisher publisher = ros::NodeHandle().advertise<std_msgs::Float64>("camera", 1);
  EXPECT_TRUE(
      is_diagnosed("camera is published as std_msgs/Float64, expected geometry_msgs/PointStamped"));
  // So that it is not on its way to the next test.
  EXPECT_TRUE(test::spin_until([&] { return publisher.getNumSubscribers() > 0; }));
}

class TransformsTest : public testing::Test {
 protected:
  TransformsTest() {
    camera_ = handle_.advertise<geometry_msgs::PointStamped>("camera", 10);
    tf_ = handle_.advertise<tf2_msgs::TFMessage>("/tf", 10);
    const auto on_status = [this](const EventStatusConstPtr& status) {
      statuses_.push_back(*status);
    };
    status_subscriber_ = handle_.subscribe<EventStatus>("events", 100, on_status);
    const auto on_estimate = [this](const StateEstimateConstPtr& estimate) {
      estimates_.push_back(*estimate);
    };
    estimate_subscriber_ = handle_.subscribe<StateEstimate>("estimate", 1000, on_estimate);
  }

  void connect() {
    ASSERT_TRUE(test::spin_until([this] {
      return camera_.getNumSubscribers() > 0 && tf_.getNumSubscribers() > 0 &&
             status_subscriber_.getNumPublishers() > 0 &&
             estimate_subscriber_.getNumPublishers() > 0;
    }));
  }

  /// One metre ahead of the lens.
  void measure(const ros::Time& stamp) {
    geometry_msgs::PointStamped message;
    message.header.stamp = stamp;
    message.header.frame_id = "lens";
    message.point.x = 1.0;
    camera_.publish(message);
  }

  /// The turntable stands at x = 10 and looks into this direction.
  void turn(const ros::Time& stamp, double angle) {
    tf2_msgs::TFMessage message;
    message.transforms.resize(1);
    geometry_msgs::TransformStamped& transform = message.transforms[0];
    transform.header.stamp = stamp;
    transform.header.frame_id = "map";
    transform.child_frame_id = "turntable";
    transform.transform.translation.x = 10.0;
    transform.transform.rotation.w = std::cos(0.5 * angle);
    transform.transform.rotation.z = std::sin(0.5 * angle);
    tf_.publish(message);
  }

  ros::NodeHandle handle_;
  ros::Publisher camera_;
  ros::Publisher tf_;
  ros::Subscriber status_subscriber_;
  ros::Subscriber estimate_subscriber_;
  std::vector<EventStatus> statuses_;
  std::vector<StateEstimate> estimates_;
};

TEST_F(TransformsTest, MeasurementsWaitForTheirTransformsAndTheEstimateForNothing) {
  connect();
  // Half way between two directions, of which one is known yet.
  const ros::Time start = ros::Time::now() - ros::Duration(0.2);
  turn(start, 0.0);
  measure(start + ros::Duration(0.1));
  test::spin_until([] { return false; }, 0.2);
  EXPECT_TRUE(statuses_.empty());
  turn(start + ros::Duration(0.2), 2.0);
  ASSERT_TRUE(test::spin_until([this] { return !statuses_.empty(); }));
  EXPECT_EQ(EventStatus::USED, statuses_[0].outcome) << statuses_[0].reason;
  EXPECT_GT(statuses_[0].latency, 0.25);
  estimates_.clear();
  ASSERT_TRUE(test::spin_until([this] { return !estimates_.empty(); }));
  EXPECT_NEAR(10.0 + 1.5 * std::cos(1.0), estimates_[0].state[0], 1e-9);

  // And one whose transform never comes: the estimates do not wait for it.
  const ros::Time never = ros::Time::now();
  measure(never);
  ASSERT_TRUE(test::spin_until([this] { return statuses_.size() > 1; }));
  EXPECT_EQ(EventStatus::NO_TRANSFORM, statuses_[1].outcome) << statuses_[1].reason;
  EXPECT_EQ(never, statuses_[1].header.stamp);
  EXPECT_GT(statuses_[1].latency, 0.5);
  EXPECT_NE(std::string::npos, statuses_[1].reason.find("in time: lens -> map"));
  EXPECT_GT(estimates_.size(), 30u);
  EXPECT_EQ(1u, estimates_.back().samples);
  measure(never);
  EXPECT_TRUE(is_diagnosed("in time: lens -> map"));
}

}  // namespace
}  // namespace sampled_data_observers
