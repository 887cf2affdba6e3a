// Samples for the observer that bench/lateness runs, and how late its estimates are beside them:
//   lateness_load LOAD SECONDS >RECORD
// LOAD is what else happens: alone, flood (10 kHz), bursts (of late samples, 100 ms of them at a
// time), same_stamp (500 of one stamp, 5 times a second), samples (nothing else; callers come from
// outside). To an observer beside it, /other, it sends samples as when alone.
// Lines of the record: lateness in ns of each estimate on its way out, as it was received; then
// "status OUTCOME COUNT" and "sent COUNT".
#include <ros/ros.h>

#include <array>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "sampled_data_observers/EventStatus.h"
#include "sampled_data_observers/Measurement.h"
#include "sampled_data_observers/StateEstimate.h"

namespace sampled_data_observers {
namespace {

constexpr std::uint32_t kQueue = 20000;
constexpr double kRate = 100.0;   // Hz, of the samples
constexpr int kFlood = 100;       // samples instead of one
constexpr int kBurstPeriod = 20;  // samples between two bursts, of a tenth of a second

class Load {
 public:
  Load() {
    const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
    lateness_.reserve(1000000);
    estimates_ = handle_.subscribe<StateEstimate>("estimate", kQueue, &Load::take, this, hints);
    statuses_ = handle_.subscribe<EventStatus>("events", kQueue, &Load::count, this, hints);
    samples_ = handle_.advertise<Measurement>("position", kQueue);
    other_ = handle_.advertise<Measurement>("other/position", kQueue);
  }

  void run(const std::string& load, double seconds) {
    const auto is_connected = [this] {
      return samples_.getNumSubscribers() > 0 && other_.getNumSubscribers() > 0 &&
             estimates_.getNumPublishers() > 0 && statuses_.getNumPublishers() > 0;
    };
    const ros::WallTime patience = ros::WallTime::now() + ros::WallDuration(5.0);
    while (ros::ok() && !is_connected() && ros::WallTime::now() < patience) {
      ros::WallDuration(0.01).sleep();
    }
    ros::AsyncSpinner spinner(1);
    spinner.start();
    const ros::Time end = ros::Time::now() + ros::Duration(seconds);
    std::vector<ros::Time> late;
    int period = 0;
    for (ros::Time next = ros::Time::now(); ros::ok() && next < end;
         next += ros::Duration(1.0 / kRate), ++period) {
      ros::Time::sleepUntil(next);
      other_.publish(sample(next, 1.0));
      if (load == "flood") {
        for (int i = 0; i < kFlood; ++i) send(next + ros::Duration(0, i), 1.0);
      } else if (load == "bursts") {
        late.push_back(next);
        if (period % kBurstPeriod >= kBurstPeriod / 2) continue;
        for (const ros::Time& stamp : late) send(stamp, 1.0);
        late.clear();
      } else if (load == "same_stamp") {
        const int count = period % kBurstPeriod == 0 ? kBurstPeriod * kFlood / 4 : 1;
        for (int i = 0; i < count; ++i) send(next, 1.0 + 1e-3 * i);
      } else {
        send(next, 1.0);
      }
    }
    ros::WallDuration(1.0).sleep();
    spinner.stop();
  }

  void print() const {
    for (const std::int64_t lateness : lateness_) std::printf("%" PRId64 "\n", lateness);
    for (std::size_t i = 0; i < outcomes_.size(); ++i) {
      if (outcomes_[i] > 0) std::printf("status %zu %" PRId64 "\n", i, outcomes_[i]);
    }
    std::printf("sent %" PRId64 "\n", sent_);
  }

 private:
  static Measurement sample(const ros::Time& stamp, double value) {
    Measurement message;
    message.header.stamp = stamp;
    message.values = {value};
    return message;
  }

  void send(const ros::Time& stamp, double value) {
    samples_.publish(sample(stamp, value));
    ++sent_;
  }

  void take(const StateEstimate::ConstPtr& estimate) {
    lateness_.push_back((ros::Time::now() - estimate->header.stamp).toNSec());
  }

  void count(const EventStatus::ConstPtr& status) { ++outcomes_[status->outcome]; }

  ros::NodeHandle handle_;
  ros::Publisher samples_;
  ros::Publisher other_;  ///< of an observer that runs beside
  ros::Subscriber estimates_;
  ros::Subscriber statuses_;
  std::vector<std::int64_t> lateness_;
  std::array<std::int64_t, 256> outcomes_{};
  std::int64_t sent_ = 0;
};

}  // namespace
}  // namespace sampled_data_observers

int main(int argc, char** argv) {
  ros::init(argc, argv, "lateness_load", ros::init_options::AnonymousName);
  if (argc != 3) {
    std::fprintf(stderr, "usage: lateness_load LOAD SECONDS\n");
    return 2;
  }
  sampled_data_observers::Load load;
  load.run(argv[1], std::atof(argv[2]));
  load.print();
  return 0;
}
