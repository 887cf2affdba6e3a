// Standard messages, tf and diagnostics of two observers on a clock that this test publishes.
#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <tf2_msgs/TFMessage.h>

#include <map>

#include "messages/time_conversion.h"
#include "ros/observer_client.h"

namespace sampled_data_observers {
namespace {

/// Keeps all messages of a topic.
template <class M>
class Recorder {
 public:
  explicit Recorder(const std::string& topic)
      : subscriber_(ros::NodeHandle().subscribe(topic, 1000, &Recorder::receive, this)) {}

  bool is_connected() const { return subscriber_.getNumPublishers() > 0; }

  std::vector<M> messages;

 private:
  void receive(const typename M::ConstPtr& message) { messages.push_back(*message); }

  ros::Subscriber subscriber_;
};

class StandardOutputsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    clock_publisher_ = handle_.advertise<rosgraph_msgs::Clock>("/clock", 10);
    odometry_publisher_ = handle_.advertise<tf2_msgs::TFMessage>("/tf", 10);
    ASSERT_TRUE(client_.connect());
    ASSERT_TRUE(test::spin_until([this] {
      return clock_publisher_.getNumSubscribers() >= 3 &&
             odometry_publisher_.getNumSubscribers() >= 2 && odometry_.is_connected() &&
             pose_.is_connected() && twist_.is_connected() && second_.is_connected() &&
             diagnostics_.is_connected();
    }));
  }

  void set_clock(double seconds) {
    rosgraph_msgs::Clock message;
    message.clock = ros::Time(seconds);
    clock_publisher_.publish(message);
  }

  /// Lets the clock run on in steps of 10 ms up to a time, and stand there until something holds.
  bool run_clock_until(double seconds, const std::function<bool()>& done) {
    return test::spin_until([&] {
      time_ = std::min(seconds, time_ + 0.01);
      set_clock(time_);
      ros::WallDuration(0.002).sleep();
      return time_ >= seconds && done();
    });
  }

  /// Lets the clock run on until something holds.
  bool run_clock_while_not(const std::function<bool()>& done) {
    return test::spin_until([&] {
      time_ += 0.01;
      set_clock(time_);
      ros::WallDuration(0.002).sleep();
      return done();
    });
  }

  /// The odometry of the robot: odom → base.
  void publish_odometry(double stamp, double x) {
    tf2_msgs::TFMessage message;
    message.transforms.resize(1);
    message.transforms[0].header.stamp = ros::Time(stamp);
    message.transforms[0].header.frame_id = "odom";
    message.transforms[0].child_frame_id = "base";
    message.transforms[0].transform.translation.x = x;
    message.transforms[0].transform.rotation.w = 1.0;
    odometry_publisher_.publish(message);
  }

  std::vector<geometry_msgs::TransformStamped> transforms(const std::string& child) const {
    std::vector<geometry_msgs::TransformStamped> found;
    for (const tf2_msgs::TFMessage& message : tf_.messages) {
      for (const geometry_msgs::TransformStamped& transform : message.transforms) {
        if (transform.child_frame_id == child) found.push_back(transform);
      }
    }
    return found;
  }

  /// Whether diagnostics of a name ever had this level and a message with this part.
  bool diagnosed(const std::string& name, int level, const std::string& part) const {
    for (const diagnostic_msgs::DiagnosticArray& array : diagnostics_.messages) {
      for (const diagnostic_msgs::DiagnosticStatus& status : array.status) {
        if (status.name == name && status.level == level &&
            status.message.find(part) != std::string::npos) {
          return true;
        }
      }
    }
    return false;
  }

  double time_ = 100.0;
  ros::NodeHandle handle_;
  ros::Publisher clock_publisher_;
  ros::Publisher odometry_publisher_;
  test::ObserverClient client_;
  Recorder<nav_msgs::Odometry> odometry_{"odometry"};
  Recorder<geometry_msgs::PoseWithCovarianceStamped> pose_{"pose"};
  Recorder<geometry_msgs::TwistWithCovarianceStamped> twist_{"twist"};
  Recorder<StateEstimate> second_{"second/estimate"};
  Recorder<tf2_msgs::TFMessage> tf_{"/tf"};
  Recorder<diagnostic_msgs::DiagnosticArray> diagnostics_{"/diagnostics"};
};

TEST_F(StandardOutputsTest, FollowTheEstimateAndDiagnosticsSayHowItGoes) {
  const auto& Ok = diagnostic_msgs::DiagnosticStatus::OK;
  const auto& Error = diagnostic_msgs::DiagnosticStatus::ERROR;
  const auto& Stale = diagnostic_msgs::DiagnosticStatus::STALE;
  EXPECT_TRUE(run_clock_until(
      100.1, [&] { return diagnosed("observer: estimates", Stale, "nothing was received"); }));

  EXPECT_EQ(EventStatus::USED, client_.input(ros::Time(100.1), 0.25).outcome);
  client_.publish_sample(ros::Time(100.1), 2.0);
  ASSERT_TRUE(run_clock_until(101.0, [&] {
    return !odometry_.messages.empty() &&
           odometry_.messages.back().header.stamp == ros::Time(101.0) &&
           odometry_.messages.size() == client_.estimates.size() &&
           pose_.messages.size() == client_.estimates.size() &&
           twist_.messages.size() == client_.estimates.size() && !second_.messages.empty() &&
           transforms("second_base").size() == second_.messages.size();
  }));
  ASSERT_EQ(46u, client_.estimates.size());  // 100.10 s to 101.00 s at 50 Hz
  for (std::size_t i = 0; i < client_.estimates.size(); ++i) {
    const StateEstimate& estimate = client_.estimates[i];
    const nav_msgs::Odometry& odometry = odometry_.messages[i];
    EXPECT_EQ(estimate.header.stamp, odometry.header.stamp);
    EXPECT_EQ(estimate.header.stamp, pose_.messages[i].header.stamp);
    EXPECT_EQ(estimate.header.stamp, twist_.messages[i].header.stamp);
    EXPECT_EQ(estimate.state[0], odometry.pose.pose.position.x);
    EXPECT_EQ(estimate.state[0], pose_.messages[i].pose.pose.position.x);
    EXPECT_EQ(0.5, odometry.pose.pose.position.z);
    EXPECT_EQ(1.0, odometry.pose.pose.orientation.w);
    EXPECT_EQ(estimate.state[1], odometry.twist.twist.linear.x);
    EXPECT_EQ(estimate.state[1], twist_.messages[i].twist.twist.linear.x);
    EXPECT_EQ(0.25, odometry.twist.twist.angular.z);  // the input that holds
    EXPECT_EQ(0.25, twist_.messages[i].twist.twist.angular.z);
    EXPECT_EQ(3.0, pose_.messages[i].pose.covariance[14]);
  }
  EXPECT_EQ("world", odometry_.messages[0].header.frame_id);
  EXPECT_EQ("base", odometry_.messages[0].child_frame_id);
  EXPECT_EQ("world", pose_.messages[0].header.frame_id);
  EXPECT_EQ("base", twist_.messages[0].header.frame_id);

  const std::vector<geometry_msgs::TransformStamped> alone = transforms("second_base");
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_EQ("world", alone[i].header.frame_id);
    EXPECT_EQ(second_.messages[i].header.stamp + ros::Duration(0.1), alone[i].header.stamp);
    EXPECT_EQ(second_.messages[i].state[0], alone[i].transform.translation.x);
  }

  // No odometry was known so far. Now it is, up to 101 s.
  EXPECT_TRUE(transforms("odom").empty());
  EXPECT_TRUE(transforms("base").empty());
  publish_odometry(100.0, 0.0);
  publish_odometry(101.0, 10.0);
  ASSERT_TRUE(run_clock_until(101.2, [&] {
    return !transforms("odom").empty() &&
           transforms("odom").back().header.stamp == ros::Time(101.0);
  }));
  const std::vector<geometry_msgs::TransformStamped> corrections = transforms("odom");
  std::map<ros::Time, double> positions;
  for (const StateEstimate& estimate : client_.estimates) {
    positions[estimate.header.stamp] = estimate.state[0];
  }
  for (std::size_t i = 0; i < corrections.size(); ++i) {
    const ros::Time stamp = corrections[i].header.stamp;
    EXPECT_TRUE(i == 0 || corrections[i - 1].header.stamp < stamp);
    EXPECT_EQ("world", corrections[i].header.frame_id);
    const double odometry = 10.0 * (stamp - ros::Time(100.0)).toSec();
    EXPECT_NEAR(positions.at(stamp) - odometry, corrections[i].transform.translation.x, 1e-6);
  }
  EXPECT_GE(corrections.size(), 15u);  // those of the last 0.5 s waited for it

  // Beside much else on the machine, some estimates are late at first.
  EXPECT_TRUE(run_clock_while_not(
      [&] { return diagnosed("observer: estimates", Ok, "published at their rate"); }));
  EXPECT_TRUE(diagnosed("observer: certificate", Ok, "none configured"));
  client_.sample(ros::Time(0), {1.0});
  EXPECT_TRUE(test::spin_until(
      [&] { return diagnosed("observer: events from position", Error, "header.stamp"); }));
  EXPECT_TRUE(test::spin_until(
      [&] { return diagnosed("observer: estimates", Stale, "nothing comes on /clock"); }));
}

}  // namespace
}  // namespace sampled_data_observers
