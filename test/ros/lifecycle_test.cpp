// The nodelet in this process: configurations that must not start, messages by pointer, loading and
// unloading, publishers that die.
#include <gtest/gtest.h>
#include <nodelet/loader.h>
#include <ros/ros.h>
#include <sys/wait.h>
#include <unistd.h>
#include <xmlrpcpp/XmlRpc.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include "ros/observer_client.h"
#include "sampled_data_observers/ros/master_watch.h"

namespace sampled_data_observers {
namespace {

const char kType[] = "sampled_data_observers/ConstantGainObserver";

std::size_t resident_kilobytes() {
  std::ifstream statm("/proc/self/statm");
  std::size_t total = 0;
  std::size_t resident = 0;
  statm >> total >> resident;
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) / 1024;
}

/// Loads the nodelet as `name`, whose parameters the launch file has set.
bool load(nodelet::Loader& loader, const std::string& name, const std::string& type = kType) {
  try {
    return loader.load(name, type, ros::M_string(), {});
  } catch (const std::exception&) {
    return false;
  }
}

class LifecycleTest : public ::testing::Test {
 protected:
  nodelet::Loader loader_{false};
};

TEST_F(LifecycleTest, ABadConfigurationDoesNotStart) {
  EXPECT_FALSE(load(loader_, "/without_configuration"));
  EXPECT_FALSE(load(loader_, "/unknown_key"));
  EXPECT_FALSE(load(loader_, "/key_in_two_files"));
  EXPECT_FALSE(load(loader_, "/wrong_field"));
  EXPECT_FALSE(load(loader_, "/bad_topic"));
  EXPECT_FALSE(load(loader_, "/wrong_type"));
  EXPECT_FALSE(load(loader_, "/no_files"));
  EXPECT_FALSE(load(loader_, "/no_directory"));
  EXPECT_FALSE(load(loader_, "/observer", "sampled_data_observers/SwitchedObserver"));
  EXPECT_TRUE(load(loader_, "/observer"));
  EXPECT_TRUE(load(loader_, "/plain_parameters", "sampled_data_observers/Observer"));
}

TEST_F(LifecycleTest, MessagesPassByPointerInOneProcess) {
  ASSERT_TRUE(load(loader_, "/observer"));
  ros::NodeHandle handle;
  // The sequence number is nothing that the observer writes. A message marked here that comes again
  // with its mark is the same object: a serialised one would carry the number of its publication.
  constexpr std::uint32_t kMark = 4242424242u;
  std::atomic<int> marked_again{0};
  const ros::Subscriber subscriber =
      handle.subscribe<StateEstimate>("estimate", 100, [&](const StateEstimate::ConstPtr& message) {
        if (message->header.seq == kMark) ++marked_again;
        const_cast<StateEstimate&>(*message).header.seq = kMark;
      });
  ros::Publisher publisher = handle.advertise<Measurement>("position", 10);
  ASSERT_TRUE(test::spin_until([&] { return publisher.getNumSubscribers() > 0; }));
  publisher.publish(
      boost::make_shared<Measurement>(test::ObserverClient::measurement(ros::Time::now(), {1.0})));
  EXPECT_TRUE(test::spin_until([&] { return marked_again > 10; }));
}

/// What comes from an observer in the namespace `ns`.
struct Received {
  explicit Received(const std::string& ns)
      : statuses(handle.subscribe(ns + "/events", kAll, &Received::take_status, this)),
        estimates(handle.subscribe(ns + "/estimate", kAll, &Received::take_estimate, this)) {}
  void take_status(const EventStatus::ConstPtr& status) {
    ++outcomes;
    used += status->outcome == EventStatus::USED || status->outcome == EventStatus::USED_LATE;
  }
  void take_estimate(const StateEstimate::ConstPtr& estimate) {
    in_order = in_order && newest < estimate->header.stamp;
    newest = estimate->header.stamp;
  }

  static constexpr std::uint32_t kAll = 100000;
  ros::NodeHandle handle;
  int outcomes = 0;
  int used = 0;
  bool in_order = true;
  ros::Time newest;
  ros::Subscriber statuses;
  ros::Subscriber estimates;
};

TEST_F(LifecycleTest, TwoThatShareAFloodedTopicLoseNothing) {
  ASSERT_TRUE(load(loader_, "/observer"));
  ASSERT_TRUE(loader_.load("/rear/observer", kType, {{"/rear/position", "/position"}}, {}));
  const Received front("");
  const Received rear("/rear");
  ros::Publisher publisher = ros::NodeHandle().advertise<Measurement>("position", 10);
  ASSERT_TRUE(test::spin_until([&] {
    return front.estimates.getNumPublishers() > 0 && rear.estimates.getNumPublishers() > 0 &&
           publisher.getNumSubscribers() > 0;
  }));
  constexpr int kBursts = 200;
  constexpr int kBurst = 100;
  ros::Time last;
  for (int burst = 0; burst < kBursts; ++burst) {  // 10,000 samples a second
    last = ros::Time::now();
    for (int i = 0; i < kBurst; ++i) {
      publisher.publish(test::ObserverClient::measurement(last + ros::Duration(0, i), {1.0}));
    }
    ros::spinOnce();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  for (const Received* received : {&front, &rear}) {
    EXPECT_TRUE(test::spin_until([&] { return received->outcomes == kBursts * kBurst; }))
        << received->outcomes;
    EXPECT_GT(received->used, 0);
    EXPECT_TRUE(test::spin_until([&] { return received->newest > last; }));
    EXPECT_TRUE(received->in_order);
  }
}

TEST_F(LifecycleTest, UnloadingAndReloadingLeaksNothing) {
  test::ObserverClient client;
  const auto cycle = [&] {
    ASSERT_TRUE(load(loader_, "/observer"));
    ASSERT_TRUE(client.connect());
    client.sample(ros::Time::now(), {1.0});
    ASSERT_TRUE(loader_.unload("/observer"));
  };
  for (int i = 0; i < 10; ++i) cycle();
  const std::size_t before = resident_kilobytes();
  for (int i = 0; i < 30; ++i) cycle();
  // The tables and the history of one observer alone take 0.1 MB; 30 leaked would show.
  EXPECT_LT(resident_kilobytes(), before + 2000);
}

TEST_F(LifecycleTest, UnloadingInTheMidstOfEventsLeavesNothingBehind) {
  test::ObserverClient client;
  std::atomic<bool> running{true};
  std::thread publisher([&] {
    while (running) {
      client.publish_sample(ros::Time::now(), 1.0);
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  });
  for (int i = 0; i < 30; ++i) {
    EXPECT_TRUE(load(loader_, "/observer"));
    EXPECT_TRUE(client.connect());
    EXPECT_TRUE(loader_.unload("/observer"));
    ros::V_string topics;
    ros::this_node::getAdvertisedTopics(topics);
    EXPECT_EQ(0, std::count(topics.begin(), topics.end(), "/estimate"));
    EXPECT_FALSE(ros::service::exists("/get_estimate", false));
    if (HasFailure()) break;
  }
  running = false;
  publisher.join();
}

TEST_F(LifecycleTest, AQueryThatTakesLongHoldsUpNeitherOthersNorUnloading) {
  ASSERT_TRUE(load(loader_, "/pendulum"));
  ros::NodeHandle handle;
  const ros::Publisher publisher = handle.advertise<Measurement>("position", 10);
  std::atomic<int> estimates{0};
  const ros::Subscriber subscriber = handle.subscribe<StateEstimate>(
      "estimate", 100, [&](const StateEstimate::ConstPtr&) { ++estimates; });
  ASSERT_TRUE(test::spin_until(
      [&] { return publisher.getNumSubscribers() > 0 && subscriber.getNumPublishers() > 0; }));
  publisher.publish(test::ObserverClient::measurement(ros::Time::now(), {1.0}));
  ASSERT_TRUE(test::spin_until([&] { return estimates > 0; }));

  const auto ask = [] {
    GetEstimate query;
    query.request.stamp = ros::Time::now() + ros::Duration(98.0);
    ros::service::call("/get_estimate", query);
    return query.response;
  };
  GetEstimate::Response long_one;
  std::thread caller([&] {
    do long_one = ask();
    while (long_one.message.find("busy") == 0);
  });
  EXPECT_TRUE(test::spin_until([&] { return ask().message.find("busy") == 0; }));
  const int before = estimates;
  EXPECT_TRUE(test::spin_until([&] { return estimates >= before + 25; }, 1.5));
  const ros::WallTime began = ros::WallTime::now();
  EXPECT_TRUE(loader_.unload("/pendulum"));
  EXPECT_LT((ros::WallTime::now() - began).toSec(), 3.0);
  caller.join();
  EXPECT_FALSE(long_one.success);
}

TEST_F(LifecycleTest, PublishersMayDieAndReturn) {
  ASSERT_TRUE(load(loader_, "/observer"));
  test::ObserverClient client;
  ASSERT_TRUE(client.connect());
  for (int i = 0; i < 3; ++i) {
    const std::size_t before = client.statuses.size();
    const pid_t publisher = fork();
    if (publisher == 0) {
      execlp("rostopic", "rostopic", "pub", "--rate", "20", "--substitute-keywords", "/position",
             "sampled_data_observers/Measurement", "{header: auto, values: [1.0]}", nullptr);
      _exit(1);
    }
    const bool came = test::spin_until([&] { return client.statuses.size() > before + 5; }, 60.0);
    kill(publisher, SIGKILL);  // in the middle of its work: no good-bye to the master
    waitpid(publisher, nullptr, 0);
    EXPECT_TRUE(came);
    const std::size_t estimates = client.estimates.size();
    EXPECT_TRUE(test::spin_until([&] { return client.estimates.size() > estimates + 10; }));
  }
  EXPECT_EQ(EventStatus::USED, client.sample(ros::Time::now(), {1.0}).outcome);
}

/// Ends roscpp: the last of this program.
TEST(MasterWatchTest, AfterShutdownNothingIsRegistered) {
  const char service[] = "/of_a_node_that_ends";
  ros::CallbackQueue queue;
  ros::NodeHandle handle;
  handle.setCallbackQueue(&queue);
  const MasterWatch watch(
      handle, {service}, {}, {}, [](std::size_t, const std::string&) {}, NodeLog("lifecycle_test"));
  XmlRpc::XmlRpcClient master(ros::master::getHost().c_str(),
                              static_cast<int>(ros::master::getPort()), "/");
  ros::shutdown();
  const ros::WallTime end =
      ros::WallTime::now() + ros::WallDuration(4.0);  // longer than its period
  while (ros::WallTime::now() < end) queue.callAvailable(ros::WallDuration(0.1));

  XmlRpc::XmlRpcValue question;
  question[0] = "/lifecycle_test";
  question[1] = service;
  XmlRpc::XmlRpcValue answer;
  ASSERT_TRUE(master.execute("lookupService", question, answer));
  EXPECT_EQ(-1, static_cast<int>(answer[0])) << "found: " << answer.toXml();
}

}  // namespace
}  // namespace sampled_data_observers
