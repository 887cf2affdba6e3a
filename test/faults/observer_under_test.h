#pragma once

#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>
#include <sampled_data_observers/ReloadGains.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace sampled_data_observers::test {

/// The observer as a nodelet in a manager, a process of its own: loading, unloading, services.
class ObserverUnderTest {
 public:
  /// Makes a directory for gain files; waits for nothing.
  ObserverUnderTest();
  ~ObserverUnderTest();
  ObserverUnderTest(const ObserverUnderTest&) = delete;
  ObserverUnderTest& operator=(const ObserverUnderTest&) = delete;

  /// Whether a nodelet of this type starts with the private parameters that are there.
  bool load(const std::string& type);
  void unload();

  /// Removes all private parameters and sets those that observer.launch would set for these files,
  /// below the package, and `gains_directory`.
  void set_parameters(const std::vector<std::string>& files);
  ros::NodeHandle& parameters() { return parameters_; }

  /// The last line in the log of the manager that says why nothing was started.
  const std::string& refusal() const { return refusal_; }

  /// Calls a service of the observer. The response says whether it was done.
  template <class Service>
  typename Service::Response call(const std::string& name,
                                  const typename Service::Request& request) const {
    // A server closes connections that are not persistent as soon as it has answered, so that
    // roscpp's clients sometimes miss the answer.
    const bool persistent = true;
    ros::NodeHandle handle;
    ros::ServiceClient client = handle.serviceClient<Service>(name, persistent);
    typename Service::Request sent = request;
    typename Service::Response response;
    if (!client.call(sent, response)) throw std::runtime_error("no answer: " + name);
    return response;
  }
  bool reset(const std::vector<double>& state) const;
  ReloadGains::Response reload(const std::string& file) const;
  bool set_enabled(bool enabled) const;
  bool enable_sensor(const std::string& name, bool enabled) const;

  /// Writes a file into the directory of gain files.
  void write_gains(const std::string& file, const std::string& text) const;
  const std::string& gains_directory() const { return gains_directory_; }

 private:
  ros::NodeHandle parameters_;
  std::string gains_directory_;
  std::string refusal_;
  ros::Subscriber log_subscriber_;
};

}  // namespace sampled_data_observers::test
