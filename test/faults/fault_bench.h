#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <sampled_data_observers/EventStatus.h>
#include <sampled_data_observers/GetEstimate.h>
#include <sampled_data_observers/StateEstimate.h>

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "faults/configurations.h"
#include "faults/observer_under_test.h"
#include "ros/spin_until.h"

namespace sampled_data_observers::test {

/// The robot around an observer: its plant, its sensors, its clock. Faults are injected through it.
///
/// Time goes on only when this class says so, and each step waits until the observer has heard the
/// clock and has answered all that was sent to it. Whatever is waited for in vain throws.
class FaultBench {
 public:
  FaultBench();

  /// Loads the observer of a configuration unless it runs.
  void use(const Configuration& configuration);
  void unload();
  ObserverUnderTest& observer() { return observer_; }

  /// Starts plant and observer anew, both in the same state, at the present time.
  void settle();

  // Time.
  Stamp now() const { return now_; }
  /// Shows another time for a moment, until the observer has noticed: set_clock() is to follow.
  void show_wrong_time(const ros::Time& time);
  /// Sets the clock forth or back; the plant goes along.
  void set_clock(Stamp stamp);
  /// Time goes on without samples.
  void let_pass(double seconds);
  /// Time goes on without samples until all that was sent has been answered, if only because it was
  /// waited for long enough.
  void let_pass_until_answered();
  /// Time goes on, with an input and a sample each period.
  void go_on(double seconds);
  /// Time goes on, and each period something else is done instead of the sample.
  void go_on(double seconds, const std::function<void(Stamp)>& instead);

  // The plant.
  State truth(Stamp stamp) const { return truth_.at(stamp); }
  void jump_truth();
  /// Changes the state by an amount that nobody tells the observer.
  void push();

  // What the robot sends.
  /// @param statuses  how many events are to answer it on `events`
  template <class M>
  void publish(const std::string& topic, const M& message, int statuses = 1) {
    publisher<M>(topic).publish(message);
    sent_ += static_cast<std::size_t>(statuses);
  }
  void sample(Stamp stamp) { sample(stamp, truth(stamp)[0]); }
  void sample(Stamp stamp, double p) { configuration_->sample(*this, stamp, p); }

  /// A connected publisher.
  template <class M>
  ros::Publisher& publisher(const std::string& topic) {
    const auto made = publishers_.find(topic);
    ros::Publisher& found =
        made != publishers_.end()
            ? made->second
            : publishers_.emplace(topic, handle_.advertise<M>(topic, 5000)).first->second;
    if (found.getNumSubscribers() == 0) {
      require([&] { return found.getNumSubscribers() > 0; }, "no subscriber of " + topic);
    }
    return found;
  }
  /// Ends a publisher, as when its process dies.
  void end_publisher(const std::string& topic) { publishers_.erase(topic); }

  /// Waits until something holds.
  static void require(const std::function<bool()>& done, const std::string& complaint);
  /// Waits until all that was sent has been answered.
  void await_statuses();
  /// Waits for the estimate that is due now.
  void await_estimates();

  /// The estimate of the present time, as the service gives it.
  GetEstimate::Response get_estimate(const ros::Time& stamp = ros::Time());

  /// The message of a status on /diagnostics, as last received.
  std::string diagnosis(const std::string& name) const;

  const Configuration& configuration() const { return *configuration_; }

  /// How many events were sent since settle().
  std::size_t sent() const { return sent_; }
  // What came since then.
  std::vector<EventStatus> statuses;
  std::vector<StateEstimate> estimates;

 private:
  void publish_clock(const ros::Time& time);
  /// Publishes it and waits until the observer has heard it.
  void await_clock(const ros::Time& time);

  ros::NodeHandle handle_;
  ObserverUnderTest observer_;
  const Configuration* configuration_ = nullptr;
  PlantTruth truth_;
  Stamp now_ = 1000 * kNanosecondsPerSecond;
  std::map<std::string, ros::Publisher> publishers_;
  std::size_t sent_ = 0;
  Stamp newest_estimate_ = 0;
  ros::Publisher clock_;
  ros::Subscriber status_subscriber_;
  ros::Subscriber estimate_subscriber_;
  ros::Subscriber diagnostics_subscriber_;
  diagnostic_msgs::DiagnosticArray diagnostics_;
  ros::ServiceClient get_estimate_;
};

}  // namespace sampled_data_observers::test
