#include "sampled_data_observers/ros/node_log.h"

#include <ros/console.h>

#include <cstdarg>
#include <cstdio>
#include <map>
#include <mutex>
#include <utility>

namespace sampled_data_observers {
namespace {

using ros::console::Level;
using ros::console::LogLocation;

/// Whether a level of a logger is on, kept up to date by rosconsole, which never forgets a
/// location: neither may we.
const LogLocation& location_of(const std::string& name, Level level) {
  static std::mutex mutex;
  static auto& all = *new std::map<std::pair<std::string, Level>, LogLocation>;
  const std::lock_guard<std::mutex> lock(mutex);
  const auto [found, is_new] = all.try_emplace(
      {name, level}, LogLocation{false, false, ros::console::levels::Count, nullptr});
  if (is_new) {
    ROSCONSOLE_AUTOINIT;
    ros::console::initializeLogLocation(&found->second,
                                        std::string(ROSCONSOLE_DEFAULT_NAME) + "." + name, level);
  }
  return found->second;
}

void print(const LogLocation& location, const char* format, std::va_list arguments) {
  if (!location.logger_enabled_) return;
  std::va_list again;
  va_copy(again, arguments);
  const int length = std::vsnprintf(nullptr, 0, format, again);
  va_end(again);
  if (length < 0) return;
  std::string text(static_cast<std::size_t>(length) + 1, '\0');
  std::vsnprintf(text.data(), text.size(), format, arguments);
  ros::console::print(nullptr, location.logger_, location.level_, __FILE__, __LINE__, __func__,
                      "%s", text.c_str());
}

}  // namespace

NodeLog::NodeLog(std::string name)
    : name_(std::move(name)),
      info_(&location_of(name_, ros::console::levels::Info)),
      warn_(&location_of(name_, ros::console::levels::Warn)),
      fatal_(&location_of(name_, ros::console::levels::Fatal)) {}

void NodeLog::info(const char* format, ...) const {
  std::va_list arguments;
  va_start(arguments, format);
  print(*info_, format, arguments);
  va_end(arguments);
}

void NodeLog::warn(const char* format, ...) const {
  std::va_list arguments;
  va_start(arguments, format);
  print(*warn_, format, arguments);
  va_end(arguments);
}

void NodeLog::fatal(const char* format, ...) const {
  std::va_list arguments;
  va_start(arguments, format);
  print(*fatal_, format, arguments);
  va_end(arguments);
}

}  // namespace sampled_data_observers
