// Plays the Husky's bag live, with its stamps moved to now, to an observer that runs beside it, and
// writes down when each message was sent and each estimate and event status received:
//   live_player BAG SECONDS >RECORD
// Lines of the record, times in nanoseconds of the wall clock:
//   sent STAMP TIME | used STAMP | estimate STAMP EVENTS TIME | final STATE...
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Imu.h>

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "sampled_data_observers/EventStatus.h"
#include "sampled_data_observers/GetEstimate.h"
#include "sampled_data_observers/StateEstimate.h"

namespace sampled_data_observers {
namespace {

constexpr std::uint32_t kQueue = 2000;
const char kOdometry[] = "/husky_velocity_controller/odom";
const char kImu[] = "/imu/data";

/// What one thread writes and another one prints when both are done.
struct Received {
  std::uint64_t stamp = 0;
  std::uint64_t events = 0;
  std::uint64_t time = 0;
};

std::uint64_t now() { return ros::Time::now().toNSec(); }

class Player {
 public:
  Player() {
    const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
    estimates_.reserve(100000);
    used_.reserve(100000);
    sent_.reserve(100000);
    subscribers_ = {
        handle_.subscribe<StateEstimate>("estimate", kQueue, &Player::take_estimate, this, hints),
        handle_.subscribe<EventStatus>("events", kQueue, &Player::take_status, this, hints)};
    odometry_ = handle_.advertise<nav_msgs::Odometry>(kOdometry, kQueue);
    imu_ = handle_.advertise<sensor_msgs::Imu>(kImu, kQueue);
  }

  void play(const std::string& path, double seconds) {
    rosbag::Bag bag(path);
    const ros::Time first = rosbag::View(bag).getBeginTime();
    rosbag::View view(bag, rosbag::TopicQuery(std::vector<std::string>{kOdometry, kImu}), first,
                      first + ros::Duration(seconds));
    wait_for_observer();
    ros::AsyncSpinner spinner(1);
    spinner.start();
    offset_ = ros::Time::now() + ros::Duration(1.0) - first;
    for (const rosbag::MessageInstance& instance : view) {
      ros::Time::sleepUntil(instance.getTime() + offset_);
      if (!ros::ok()) break;
      if (instance.getTopic() == kImu) {
        send(*instance.instantiate<sensor_msgs::Imu>(), imu_);
      } else {
        send(*instance.instantiate<nav_msgs::Odometry>(), odometry_);
      }
    }
    ros::WallDuration(1.0).sleep();
    spinner.stop();
  }

  void print() {
    for (const Received& sent : sent_) {
      std::printf("sent %" PRIu64 " %" PRIu64 "\n", sent.stamp, sent.time);
    }
    for (const std::uint64_t stamp : used_) std::printf("used %" PRIu64 "\n", stamp);
    for (const Received& estimate : estimates_) {
      std::printf("estimate %" PRIu64 " %" PRIu64 " %" PRIu64 "\n", estimate.stamp, estimate.events,
                  estimate.time);
    }
    GetEstimate query;
    query.request.stamp.fromNSec(last_stamp_);
    if (!ros::service::call("get_estimate", query) || query.response.success == 0) {
      throw std::runtime_error("no estimate at the last stamp: " + query.response.message);
    }
    std::printf("final");
    for (const double value : query.response.estimate.state) std::printf(" %.17g", value);
    std::printf("\n");
  }

 private:
  void wait_for_observer() const {
    const auto is_connected = [this] {
      return odometry_.getNumSubscribers() > 0 && imu_.getNumSubscribers() > 0 &&
             subscribers_[0].getNumPublishers() > 0 && subscribers_[1].getNumPublishers() > 0;
    };
    while (ros::ok() && !is_connected()) ros::WallDuration(0.01).sleep();
  }

  template <class M>
  void send(M message, const ros::Publisher& publisher) {
    message.header.stamp += offset_;
    last_stamp_ = std::max(last_stamp_, message.header.stamp.toNSec());
    sent_.push_back({message.header.stamp.toNSec(), 0, now()});
    publisher.publish(message);
  }

  void take_estimate(const StateEstimate::ConstPtr& estimate) {
    estimates_.push_back({estimate->header.stamp.toNSec(), estimate->events, now()});
  }

  void take_status(const EventStatus::ConstPtr& status) {
    const bool is_used =
        status->outcome == EventStatus::USED || status->outcome == EventStatus::USED_LATE;
    if (is_used) used_.push_back(status->header.stamp.toNSec());
  }

  ros::NodeHandle handle_;
  ros::Publisher odometry_;
  ros::Publisher imu_;
  std::vector<ros::Subscriber> subscribers_;
  std::vector<Received> sent_;
  std::vector<std::uint64_t> used_;
  std::vector<Received> estimates_;
  /// From the stamps in the bag to those of this run.
  ros::Duration offset_;
  std::uint64_t last_stamp_ = 0;
};

}  // namespace
}  // namespace sampled_data_observers

int main(int argc, char** argv) {
  ros::init(argc, argv, "live_player");
  if (argc != 3) {
    std::fprintf(stderr, "usage: live_player BAG SECONDS\n");
    return 2;
  }
  try {
    sampled_data_observers::Player player;
    player.play(argv[1], std::atof(argv[2]));
    player.print();
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "live_player: %s\n", fault.what());
    return 1;
  }
  return 0;
}
