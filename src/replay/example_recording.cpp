#include "sampled_data_observers/replay/example_recording.h"

#include <ros/names.h>
#include <rosbag/bag.h>
#include <sampled_data_observers/Input.h>
#include <sampled_data_observers/Measurement.h>
#include <sampled_data_observers/StateEstimate.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "sampled_data_observers/replay/bag_source.h"
#include "sampled_data_observers/replay/uniform.h"
#include "sampled_data_observers/ros/time_conversion.h"

namespace sampled_data_observers {
namespace {

constexpr Stamp kStart = 1000 * kNanosecondsPerSecond;
constexpr Duration kInputPeriod = kNanosecondsPerSecond / 50;
constexpr Duration kTruthPeriod = kNanosecondsPerSecond / 100;

/// A message to be recorded at the time of its arrival.
struct Arrival {
  Stamp time;
  std::function<void(rosbag::Bag&, const ros::Time&)> write;
};

class Simulation {
 public:
  Simulation(const ObserverConfig& config, const RecordingOptions& options)
      : config_(config), options_(options), random_(options.seed) {
    const LinearPlant& plant = *config.plant;
    x_ = Eigen::VectorXd::Ones(plant.states());
    u_ = Eigen::VectorXd::Zero(plant.inputs());
    scratch_ = Eigen::VectorXd::Zero(plant.states());
    for (std::size_t i = 0; i < plant.sensors().size(); ++i) {
      next_sample_.push_back(kStart + interval());
    }
  }

  std::vector<Arrival> run() {
    const Stamp end = kStart + from_seconds(options_.duration);
    Stamp now = kStart;
    while (now <= end) {
      if ((now - kStart) % kInputPeriod == 0 && config_.input) send_input(now);
      if ((now - kStart) % kTruthPeriod == 0) record_truth(now);
      Stamp next = now + kTruthPeriod - (now - kStart) % kTruthPeriod;
      for (std::size_t i = 0; i < next_sample_.size(); ++i) {
        if (next_sample_[i] == now) {
          send_sample(i, now);
          next_sample_[i] = now + interval();
        }
        next = std::min(next, next_sample_[i]);
      }
      config_.plant->flow().apply(next - now, x_.data(), u_.data(), scratch_.data());
      now = next;
    }
    std::stable_sort(arrivals_.begin(), arrivals_.end(),
                     [](const Arrival& a, const Arrival& b) { return a.time < b.time; });
    return std::move(arrivals_);
  }

 private:
  Duration interval() {
    return from_seconds(random_.in(to_seconds(config_.options.sampling.T1),
                                   to_seconds(config_.options.sampling.T2)));
  }

  template <class M>
  void send(const std::string& topic, M message, Stamp stamp, Stamp arrival) {
    message.header.stamp = to_ros_time(stamp);
    arrivals_.push_back(
        {arrival,
         [topic = ros::names::resolve(topic), message = std::move(message)](
             rosbag::Bag& bag, const ros::Time& time) { bag.write(topic, time, message); }});
  }

  void send_input(Stamp now) {
    u_.setConstant(std::sin(to_seconds(now - kStart)));
    Input message;
    message.values.assign(u_.data(), u_.data() + u_.size());
    send(config_.input->topic, std::move(message), now, now);
  }

  void record_truth(Stamp now) {
    StateEstimate message;
    message.names = config_.plant->description().state_names;
    message.state.assign(x_.data(), x_.data() + x_.size());
    send("truth", std::move(message), now, now);
  }

  void send_sample(std::size_t sensor, Stamp now) {
    const Eigen::VectorXd y = config_.plant->sensors()[sensor].C * x_;
    Measurement message;
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      message.values.push_back(y(i) + random_.in(-options_.noise, options_.noise));
    }
    const std::string& topic = config_.sensors[sensor].topic;
    const auto latency = [&] { return from_seconds(random_.in(0.0, options_.latency)); };
    if (random_.in(0.0, 1.0) < 0.05) send(topic, message, now, now + latency());
    send(topic, std::move(message), now, now + latency());
  }

  const ObserverConfig& config_;
  const RecordingOptions options_;
  Uniform random_;
  Eigen::VectorXd x_;
  Eigen::VectorXd u_;
  Eigen::VectorXd scratch_;
  std::vector<Stamp> next_sample_;
  std::vector<Arrival> arrivals_;
};

}  // namespace

void record_example(const ObserverConfig& config, const RecordingOptions& options,
                    const std::string& path) {
  for (const TopicSource& source : config.sensors) {
    if (source.type != "sampled_data_observers/Measurement") {
      throw ReplayError(source.origin + ": " + source.path +
                        "/type: expected sampled_data_observers/Measurement, found " + source.type);
    }
  }
  const std::vector<Arrival> arrivals = Simulation(config, options).run();
  rosbag::Bag bag;
  open_for_writing(bag, path);
  for (const Arrival& arrival : arrivals) arrival.write(bag, to_ros_time(arrival.time));
}

}  // namespace sampled_data_observers
