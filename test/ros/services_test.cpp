// The services that change a running observer, and estimates at once after events.
#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>
#include <sampled_data_observers/EnableSensor.h>
#include <sampled_data_observers/ReloadGains.h>
#include <std_srvs/SetBool.h>

#include <atomic>
#include <string>
#include <thread>

#include "messages/time_conversion.h"
#include "ros/observer_client.h"

namespace sampled_data_observers {
namespace {

template <class Service>
typename Service::Response call(const std::string& name, const typename Service::Request& request) {
  typename Service::Response response;
  typename Service::Request sent = request;
  EXPECT_TRUE(ros::service::call(name, sent, response)) << name;
  return response;
}

ReloadGains::Response reload(const std::string& file) {
  ReloadGains::Request request;
  request.file = file;
  return call<ReloadGains>("reload_gains", request);
}

// First, while no other stamp is known: as a bag is that is played by the wall clock.
TEST(OldStampsTest, TheLogSaysThatTheFirstEventsAreOld) {
  std::string warning;
  const auto take = [&](const rosgraph_msgs::LogConstPtr& entry) {
    if (entry->msg.find("older than the clock") != std::string::npos) warning = entry->msg;
  };
  const ros::Subscriber log = ros::NodeHandle().subscribe<rosgraph_msgs::Log>("/rosout", 100, take);
  test::ObserverClient client;
  ASSERT_TRUE(client.connect());
  // That of this test, and that of the observer.
  ASSERT_TRUE(test::spin_until([&] { return log.getNumPublishers() >= 2; }));
  EXPECT_EQ(EventStatus::USED, client.sample(ros::Time(1.4e9), {1.0}).outcome);
  ASSERT_TRUE(test::spin_until([&] { return !warning.empty(); }));
  EXPECT_EQ(0u, warning.find("stamps on position are "));
  EXPECT_NE(std::string::npos, warning.find("play the bag with --clock"));
}

class ServicesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(client_.connect());
    ASSERT_TRUE(client_.reset({}).success);
  }
  /// What a sample one above the estimate changes in it.
  double correction() {
    const ros::Time stamp = ros::Time::now();
    const double before = client_.get_estimate(stamp).estimate.state[0];
    EXPECT_EQ(EventStatus::USED, client_.sample(stamp, {before + 1.0}).outcome);
    return client_.get_estimate(stamp).estimate.state[0] - before;
  }

  test::ObserverClient client_;
};

TEST_F(ServicesTest, EstimatesFollowEventsAtOnceAndStampsIncrease) {
  for (int i = 0; i < 40; ++i) {
    const ros::Time stamp = ros::Time::now();
    client_.sample(stamp, {1.0});
    ASSERT_TRUE(test::spin_until([&] {
      return !client_.estimates.empty() && client_.estimates.back().header.stamp >= stamp;
    }));
  }
  std::size_t between = 0;
  for (std::size_t i = 1; i < client_.estimates.size(); ++i) {
    const ros::Time stamp = client_.estimates[i].header.stamp;
    EXPECT_LT(client_.estimates[i - 1].header.stamp, stamp);
    if (to_stamp(stamp) % 200'000'000 != 0) ++between;
  }
  EXPECT_GE(between, 35u);
}

TEST_F(ServicesTest, GainsAreChangedWithoutLosingTheEstimate) {
  std::string T2;
  const auto take = [&](const diagnostic_msgs::DiagnosticArrayConstPtr& array) {
    for (const diagnostic_msgs::DiagnosticStatus& status : array->status) {
      for (const diagnostic_msgs::KeyValue& pair : status.values) {
        if (pair.key == "T2") T2 = pair.value;
      }
    }
  };
  const ros::Subscriber diagnostics =
      ros::NodeHandle().subscribe<diagnostic_msgs::DiagnosticArray>("/diagnostics", 100, take);
  EXPECT_NEAR(0.8, correction(), 1e-9);
  const ros::Time now = ros::Time::now();
  const double before = client_.get_estimate(now).estimate.state[0];
  for (const char* bad : {"wrong_size.yaml", "other_rate.yaml", "missing.yaml", "../position.yaml",
                          "/etc/hostname", ""}) {
    const ReloadGains::Response refused = reload(bad);
    EXPECT_FALSE(refused.success) << bad;
    EXPECT_NE("", refused.message);
  }
  EXPECT_EQ(before, client_.get_estimate(now).estimate.state[0]);
  const ros::Time swap = ros::Time::now() + ros::Duration(10.0);
  const double expected = client_.get_estimate(swap).estimate.state[0];
  const ReloadGains::Response reloaded = reload("smaller.yaml");
  EXPECT_TRUE(reloaded.success) << reloaded.message;
  EXPECT_EQ("without certificate", reloaded.message);
  EXPECT_NEAR(expected, client_.get_estimate(swap).estimate.state[0], 1e-9);
  EXPECT_NEAR(0.4, correction(), 1e-9);
  EXPECT_TRUE(test::spin_until([&] { return T2 == "0.7 s"; })) << T2;  // the file's
}

TEST_F(ServicesTest, SamplesOfBeforeOtherGainsAreUsed) {
  ros::Time before = ros::Time::now();
  EXPECT_EQ(EventStatus::USED, client_.sample(before, {1.0}).outcome);
  for (int i = 0; i < 5; ++i) {
    const ros::Time stamp = ros::Time::now();
    EXPECT_TRUE(reload("smaller.yaml").success);
    EXPECT_EQ(EventStatus::USED, client_.sample(stamp, {1.0}).outcome);
    EXPECT_EQ(EventStatus::USED_LATE, client_.sample(before + ros::Duration(0, 1), {1.0}).outcome);
    before = stamp;
  }
}

TEST_F(ServicesTest, OneReloadAtATimeAndOthersAreToldSo) {
  // Each call waits for the pause after the change before, so that two callers meet.
  std::atomic<bool> told{false};
  const auto insist = [&told] {
    for (int i = 0; i < 100 && !told; ++i) {
      const ReloadGains::Response response = reload("smaller.yaml");
      const bool busy = response.message.find("busy") == 0;
      EXPECT_NE(busy, response.success) << response.message;
      if (busy) told = true;
    }
  };
  std::thread other(insist);
  insist();
  other.join();
  EXPECT_TRUE(told);
}

TEST_F(ServicesTest, SwitchedOffItIsSilentAndRejects) {
  std_srvs::SetBool::Request request;
  request.data = 0;
  EXPECT_TRUE(call<std_srvs::SetBool>("set_enabled", request).success);
  EXPECT_EQ(EventStatus::DISABLED, client_.sample(ros::Time::now(), {1.0}).outcome);
  EXPECT_FALSE(client_.get_estimate(ros::Time()).success);
  test::spin_until([] { return false; }, 0.2);  // what was on its way
  const std::size_t before = client_.estimates.size();
  EXPECT_FALSE(test::spin_until([&] { return client_.estimates.size() > before; }, 0.5));
  request.data = 1;
  EXPECT_TRUE(call<std_srvs::SetBool>("set_enabled", request).success);
  EXPECT_TRUE(test::spin_until([&] { return client_.estimates.size() > before; }));
  EXPECT_EQ(EventStatus::USED, client_.sample(ros::Time::now(), {1.0}).outcome);
}

TEST_F(ServicesTest, ASensorIsSwitchedOffAlone) {
  EnableSensor::Request request;
  request.name = "nobody";
  EXPECT_FALSE(call<EnableSensor>("enable_sensor", request).success);
  request.name = "position";
  EXPECT_TRUE(call<EnableSensor>("enable_sensor", request).success);
  EXPECT_EQ(EventStatus::DISABLED, client_.sample(ros::Time::now(), {1.0}).outcome);
  EXPECT_EQ(EventStatus::USED, client_.input(ros::Time::now(), 0.0).outcome);
  request.enabled = 1;
  EXPECT_TRUE(call<EnableSensor>("enable_sensor", request).success);
  EXPECT_EQ(EventStatus::USED, client_.sample(ros::Time::now(), {1.0}).outcome);
}

TEST_F(ServicesTest, AResetMayWaitForTheNextSample) {
  Reset::Request request;
  request.at_next_sample = 1;
  request.state = {1.0, 2.0};
  EXPECT_FALSE(call<Reset>("reset", request).success);
  request.state.clear();
  EXPECT_TRUE(call<Reset>("reset", request).success);
  EXPECT_FALSE(client_.get_estimate(ros::Time()).success);
  const ros::Time stamp = ros::Time::now();
  EXPECT_EQ(EventStatus::USED, client_.sample(stamp, {33.0}).outcome);
  EXPECT_NEAR(33.0, client_.get_estimate(stamp).estimate.state[0], 1e-6);
  EXPECT_NEAR(-0.25, client_.get_estimate(stamp).estimate.state[1], 1e-6);
}

}  // namespace
}  // namespace sampled_data_observers
