// The nodelet with a gain file: it publishes the bound that is proved, and does not start with
// gains or a plant that the proof is not about.
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <gtest/gtest.h>
#include <nodelet/loader.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>
#include <sampled_data_observers/ErrorEllipsoid.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "ros/observer_client.h"

namespace sampled_data_observers {
namespace {

class CertifiedNodeletTest : public ::testing::Test {
 protected:
  CertifiedNodeletTest() {
    log_ = handle_.subscribe<rosgraph_msgs::Log>(
        "/rosout", 1000,
        [this](const rosgraph_msgs::Log::ConstPtr& message) { messages_.push_back(message->msg); });
    EXPECT_TRUE(test::spin_until([this] { return log_.getNumPublishers() > 0; }));
  }

  bool load(const std::string& name) {
    try {
      return loader_.load(name, "sampled_data_observers/IntersampleInjectionObserver",
                          ros::M_string(), {});
    } catch (const std::exception&) {
      return false;
    }
  }

  /// Whether one message of the log has all these parts.
  bool is_logged(const std::vector<std::string>& parts) {
    return test::spin_until([&] {
      return std::any_of(messages_.begin(), messages_.end(), [&](const std::string& message) {
        return std::all_of(parts.begin(), parts.end(), [&](const std::string& part) {
          return message.find(part) != std::string::npos;
        });
      });
    });
  }

  ros::NodeHandle handle_;
  ros::Subscriber log_;
  std::vector<std::string> messages_;
  nodelet::Loader loader_{false};
};

TEST_F(CertifiedNodeletTest, RefusesOtherGainsAndPlants) {
  EXPECT_FALSE(load("/changed_gain"));
  EXPECT_TRUE(is_logged({"not started: ", "certificate: expected", "ferrante2019_theorem2",
                         "is violated by", "allow_uncertified: true"}));
  EXPECT_FALSE(load("/changed_plant"));
  EXPECT_TRUE(is_logged({"not started: ", "certificate/plant/hash: expected", "fingerprint"}));
}

TEST_F(CertifiedNodeletTest, StartsWithoutGuaranteeWhereThatIsAllowed) {
  EXPECT_TRUE(load("/allowed"));
  EXPECT_TRUE(is_logged({"no guarantee and no error bound: ", "is violated by"}));
}

TEST_F(CertifiedNodeletTest, PublishesTheBoundWhileTheAssumptionsHold) {
  ASSERT_TRUE(load("/observer"));
  EXPECT_TRUE(is_logged({"certified by ferrante2019_theorem2"}));
  std::vector<StateEstimate> estimates;
  const ros::Subscriber subscriber = handle_.subscribe<StateEstimate>(
      "estimate", 1000,
      [&](const StateEstimate::ConstPtr& estimate) { estimates.push_back(*estimate); });
  std::map<ros::Time, double> squares;
  const ros::Subscriber poses = handle_.subscribe<geometry_msgs::PoseWithCovarianceStamped>(
      "pose", 1000, [&](const geometry_msgs::PoseWithCovarianceStamped::ConstPtr& pose) {
        squares[pose->header.stamp] = pose->pose.covariance[0];
      });
  std::map<ros::Time, ErrorEllipsoid> ellipsoids;
  const ros::Subscriber ellipsoid = handle_.subscribe<ErrorEllipsoid>(
      "error_ellipsoid", 1000, [&](const ErrorEllipsoid::ConstPtr& message) {
        ellipsoids[message->header.stamp] = *message;
      });
  ros::Publisher publisher = handle_.advertise<Measurement>("position", 100);
  ASSERT_TRUE(test::spin_until([&] {
    return publisher.getNumSubscribers() > 0 && subscriber.getNumPublishers() > 0 &&
           poses.getNumPublishers() > 0 && ellipsoid.getNumPublishers() > 0;
  }));
  const ros::Time start = ros::Time::now() - ros::Duration(1.5);
  const ros::Time last = start + ros::Duration(1.35);
  for (int k = 0; k <= 9; ++k) {
    publisher.publish(
        test::ObserverClient::measurement(start + ros::Duration(0.15 * k), {std::cos(0.3 * k)}));
  }
  ASSERT_TRUE(test::spin_until([&] {
    return !estimates.empty() && estimates.back().header.stamp > last + ros::Duration(0.5);
  }));
  std::size_t in_time = 0;
  double at_T2 = 0.0;
  for (const StateEstimate& estimate : estimates) {
    if (estimate.header.stamp < last + ros::Duration(0.19)) {
      EXPECT_GE(estimate.error_bound, 1.0) << estimate.header.stamp;
      EXPECT_LT(estimate.error_bound, 30.0) << estimate.header.stamp;
      at_T2 = estimate.error_bound;
      ASSERT_EQ(2u, estimate.error_bounds.size());
      for (const double bound : estimate.error_bounds) EXPECT_LE(bound, estimate.error_bound);
      EXPECT_NEAR(1.0, std::sqrt(squares.at(estimate.header.stamp)) / estimate.error_bounds[0],
                  1e-6);
      const ErrorEllipsoid& set = ellipsoids.at(estimate.header.stamp);
      EXPECT_EQ(estimate.names, set.names);
      EXPECT_EQ("world", set.header.frame_id);
      ASSERT_EQ(4u, set.matrix.size());
      EXPECT_DOUBLE_EQ(squares.at(estimate.header.stamp), set.matrix[0]);
      EXPECT_EQ(set.matrix[1], set.matrix[2]);
      EXPECT_GT(set.matrix[0] * set.matrix[3], set.matrix[1] * set.matrix[2]);
      EXPECT_NEAR(1.0, std::sqrt(set.matrix[3]) / estimate.error_bounds[1], 1e-6);
      ++in_time;
    } else if (estimate.header.stamp > last + ros::Duration(0.3)) {
      // Then the error may grow as the plant does, and the bound with it.
      EXPECT_TRUE(std::isfinite(estimate.error_bound)) << estimate.header.stamp;
      EXPECT_GT(estimate.error_bound, at_T2) << estimate.header.stamp;
    }
  }
  EXPECT_GT(in_time, 100u);
}

}  // namespace
}  // namespace sampled_data_observers
