#pragma once

#include <string>

namespace ros::console {
struct LogLocation;
}

namespace sampled_data_observers {

/// The log of one nodelet, under its name. The macros of rosconsole keep the name of whoever logs
/// first from a line, so that in one manager all observers would log as one of them.
class NodeLog {
 public:
  /// @param name  of the nodelet, resolved
  explicit NodeLog(std::string name);

  /// As given: what a line of the log is found by.
  const std::string& name() const { return name_; }

  /// A line by a format of printf, for people who look whether all is well.
  [[gnu::format(printf, 2, 3)]] void info(const char* format, ...) const;
  /// The same of what is wrong and goes on.
  [[gnu::format(printf, 2, 3)]] void warn(const char* format, ...) const;
  /// The same of what ends the nodelet.
  [[gnu::format(printf, 2, 3)]] void fatal(const char* format, ...) const;

 private:
  std::string name_;
  // Of each level, as long as the process lives.
  const ros::console::LogLocation* info_;
  const ros::console::LogLocation* warn_;
  const ros::console::LogLocation* fatal_;
};

}  // namespace sampled_data_observers
