// Observers of one process share the thread that publishes estimates: what one of them does, or who
// listens to it, must not hold up the others.
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <ros/spinner.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "messages/time_conversion.h"
#include "ros/spin_until.h"
#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/config/yaml_file.h"
#include "sampled_data_observers/ros/estimate_publication.h"

namespace sampled_data_observers {
namespace {

ObserverConfig observer_config() {
  return read_observer_config(read_yaml_text(R"(
observer: ConstantGainObserver
plant: {states: [p, v], A: [[0, 1], [0, -0.1]]}
sensors: {position: {C: [[1, 0]], source: {topic: position}}}
sampling: {T1: 0.01, T2: 0.5}
gains: {L: [[0.8], [2.0]]}
rate: 500
history: {duration: 60, max_events: 100}
)",
                                             "test.yaml"),
                              no_plant_plugins);
}

/// An observer that has its first event, and what it publishes.
struct Observer {
  explicit Observer(const std::string& name)
      : handle(name),
        runtime(config, NodeLog("/" + name), "reset"),
        publication(handle, runtime, nullptr) {
    const double value = 0.0;
    const SharedRuntime::Access access = runtime.access();
    const Event event{access.now(), EventKind::kSample, 0, &value, 1};
    EXPECT_TRUE(access->receive(event, access.now()).used());
  }

  std::uint64_t published() {
    RunStatistics later(1);
    runtime.statistics().take(later);
    return count += later.lateness.count;
  }

  const ObserverConfig config = observer_config();
  ros::NodeHandle handle;
  SharedRuntime runtime;
  EstimatePublication publication;
  std::uint64_t count = 0;
};

TEST(IsolationTest, AnObserverWhoseRuntimeIsTakenHoldsUpNoOther) {
  Observer taken("taken");
  Observer free("free");
  ros::CallbackQueue queue;
  ros::NodeHandle listener;
  listener.setCallbackQueue(&queue);
  std::vector<Stamp> stamps;
  const ros::Subscriber subscriber = listener.subscribe<StateEstimate>(
      taken.publication.topic(), 100000, [&](const StateEstimate::ConstPtr& message) {
        stamps.push_back(to_stamp(message->header.stamp));
      });
  ASSERT_TRUE(test::spin_until([&] { return subscriber.getNumPublishers() > 0; }));
  taken.publication.start(taken.config, NodeLog("/taken"));
  free.publication.start(free.config, NodeLog("/free"));
  ASSERT_TRUE(test::spin_until([&] { return taken.published() > 10; }));
  std::uint64_t before = 0;
  {
    const SharedRuntime::Access long_event = taken.runtime.access();
    before = taken.published();
    const std::uint64_t others = free.published();
    EXPECT_TRUE(test::spin_until([&] { return free.published() >= others + 100; }));
    EXPECT_EQ(before, taken.published());
  }
  // What it owes comes then, and none is lost.
  EXPECT_TRUE(test::spin_until([&] { return taken.published() >= before + 100; }));
  queue.callAvailable();
  ASSERT_LE(before + 100, stamps.size());
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    ASSERT_EQ(taken.config.period, stamps[i] - stamps[i - 1]);
  }
}

TEST(IsolationTest, ASubscriberThatWaitsHoldsUpNobody) {
  Observer heard("heard");
  Observer other("other");
  ros::CallbackQueue queue;
  ros::NodeHandle listener;
  listener.setCallbackQueue(&queue);
  std::atomic<bool> inside{false};
  std::atomic<bool> released{false};
  const ros::Subscriber subscriber = listener.subscribe<StateEstimate>(
      heard.publication.topic(), 1, [&](const StateEstimate::ConstPtr&) {
        inside = true;
        while (!released) std::this_thread::yield();
      });
  ros::AsyncSpinner spinner(1, &queue);
  spinner.start();
  ASSERT_TRUE(test::spin_until([&] { return subscriber.getNumPublishers() > 0; }));
  heard.publication.start(heard.config, NodeLog("/heard"));
  other.publication.start(other.config, NodeLog("/other"));
  ASSERT_TRUE(test::spin_until([&] { return inside.load(); }));
  const std::uint64_t before = heard.published();
  const std::uint64_t others = other.published();
  EXPECT_TRUE(test::spin_until(
      [&] { return heard.published() >= before + 100 && other.published() >= others + 100; }));
  released = true;
}

}  // namespace
}  // namespace sampled_data_observers
