// Logs of several nodelets in one process.
#include "sampled_data_observers/ros/node_log.h"

#include <gtest/gtest.h>
#include <ros/console.h>

#include <string>
#include <vector>

#include "sampled_data_observers/ros/log_throttle.h"

namespace sampled_data_observers {
namespace {

class Listener : public ros::console::LogAppender {
 public:
  void log(ros::console::Level, const char* text, const char*, const char*, int) override {
    texts.emplace_back(text);
  }
  std::vector<std::string> texts;
};

void set_level(const char* nodelet, ros::console::levels::Level level) {
  ASSERT_TRUE(
      ros::console::set_logger_level(std::string(ROSCONSOLE_DEFAULT_NAME) + "." + nodelet, level));
  ros::console::notifyLoggerLevelsChanged();
}

/// From one line, as observers of one manager do.
void say(const NodeLog& log, const char* text) { log.info("%s, %d", text, 42); }

TEST(NodeLogTest, EachNodeletHasALogOfItsOwn) {
  static Listener listener;  // rosconsole never lets it go
  ros::console::register_appender(&listener);
  const NodeLog front("front");
  const NodeLog rear("rear");
  set_level("front", ros::console::levels::Warn);
  set_level("rear", ros::console::levels::Info);
  say(front, "not heard");
  say(rear, "heard");
  set_level("front", ros::console::levels::Info);
  set_level("rear", ros::console::levels::Warn);
  say(front, "heard now");
  say(rear, "not heard");
  const std::string long_text(5000, '.');
  rear.warn("%s", long_text.c_str());
  EXPECT_EQ((std::vector<std::string>{"heard, 42", "heard now, 42", long_text}), listener.texts);
}

TEST(LogThrottleTest, LetsEachCauseThroughOnce) {
  LogThrottle first;
  LogThrottle second;
  EXPECT_TRUE(first.admits());
  EXPECT_FALSE(first.admits());
  EXPECT_TRUE(second.admits());
}

}  // namespace
}  // namespace sampled_data_observers
