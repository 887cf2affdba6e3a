// What tf and a GPS tell a filter, live: the place of the antenna, the heading, and the datum.
#include <diagnostic_msgs/DiagnosticArray.h>
#include <rosgraph_msgs/Log.h>
#include <sensor_msgs/NavSatFix.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>

#include "ros/observer_client.h"

namespace sampled_data_observers {
namespace {

tf2_msgs::TFMessage transform(const std::string& frame, const std::string& child, double x,
                              double y, double yaw) {
  tf2_msgs::TFMessage message;
  message.transforms.resize(1);
  geometry_msgs::TransformStamped& only = message.transforms[0];
  only.header.stamp = ros::Time::now();
  only.header.frame_id = frame;
  only.child_frame_id = child;
  only.transform.translation.x = x;
  only.transform.translation.y = y;
  only.transform.rotation.z = std::sin(0.5 * yaw);
  only.transform.rotation.w = std::cos(0.5 * yaw);
  return message;
}

class NavSatTest : public testing::Test {
 protected:
  NavSatTest() {
    const bool latched = true;
    static_ = handle_.advertise<tf2_msgs::TFMessage>("/tf_static", 1, latched);
    moving_ = handle_.advertise<tf2_msgs::TFMessage>("/tf", 10);
    fixes_ = handle_.advertise<sensor_msgs::NavSatFix>("fix", 10);
    status_subscriber_ = handle_.subscribe<EventStatus>(
        "events", 100, [this](const EventStatusConstPtr& status) { last_ = *status; });
    log_subscriber_ = handle_.subscribe<rosgraph_msgs::Log>(
        "/rosout", 100,
        [this](const rosgraph_msgs::LogConstPtr& line) { log_ += line->msg + "\n"; });
    diagnostics_subscriber_ = handle_.subscribe<diagnostic_msgs::DiagnosticArray>(
        "/diagnostics", 10, [this](const diagnostic_msgs::DiagnosticArrayConstPtr& array) {
          for (const diagnostic_msgs::DiagnosticStatus& status : array->status) {
            for (const diagnostic_msgs::KeyValue& value : status.values) {
              if (value.key == "datum of the local plane") datum_ = value.value;
            }
          }
        });
    get_estimate_ = handle_.serviceClient<GetEstimate>("get_estimate");
  }

  /// Waits for what becomes of an event of this sensor.
  void await_use(const std::string& sensor) {
    EXPECT_TRUE(test::spin_until([&] { return last_.source == sensor; })) << sensor;
    EXPECT_EQ(EventStatus::USED, last_.outcome) << last_.reason;
  }

  std::vector<double> estimate() {
    GetEstimate call;
    EXPECT_TRUE(get_estimate_.call(call));
    EXPECT_TRUE(call.response.success) << call.response.message;
    return call.response.estimate.state;
  }

  ros::NodeHandle handle_;
  ros::Publisher static_;
  ros::Publisher moving_;
  ros::Publisher fixes_;
  ros::Subscriber status_subscriber_;
  ros::Subscriber log_subscriber_;
  ros::Subscriber diagnostics_subscriber_;
  ros::ServiceClient get_estimate_;
  EventStatus last_;
  std::string log_;
  std::string datum_;
};

TEST_F(NavSatTest, FixesAreThoseOfTheAntennaThatTfKnows) {
  static_.publish(transform("base_link", "gps", 0.4, 0.1, 0.0));
  ASSERT_TRUE(test::spin_until([this] {
    return fixes_.getNumSubscribers() > 0 && moving_.getNumSubscribers() > 0 &&
           status_subscriber_.getNumPublishers() > 0 && get_estimate_.exists() &&
           log_subscriber_.getNumPublishers() > 1;  // this node's and the observer's
  }));
  const double yaw = 1.2;
  moving_.publish(transform("map", "base_link", 0.0, 0.0, yaw));
  await_use("heading");
  sensor_msgs::NavSatFix fix;
  fix.header.stamp = ros::Time::now();
  fix.header.frame_id = "gps";
  fix.latitude = 48.25;
  fix.longitude = 16.375;
  fix.altitude = 180.5;
  fixes_.publish(fix);
  await_use("gps");
  const std::vector<double> state = estimate();
  ASSERT_EQ(3u, state.size());
  EXPECT_NEAR(yaw, state[2], 1e-6);
  EXPECT_NEAR(-0.4 * std::cos(yaw) + 0.1 * std::sin(yaw), state[0], 1e-6);
  EXPECT_NEAR(-0.4 * std::sin(yaw) - 0.1 * std::cos(yaw), state[1], 1e-6);

  const std::string datum = "[48.250000000, 16.375000000, 180.5000]";
  EXPECT_TRUE(test::spin_until([&] { return datum_ == datum; })) << datum_;
  EXPECT_TRUE(test::spin_until([&] {
    return log_.find("datum of the local plane: " + datum) != std::string::npos;
  })) << log_;
}

}  // namespace
}  // namespace sampled_data_observers
