// All ROS tests: each launch file, ros/*.test, runs the suites that are about its nodes.
#include <gtest/gtest.h>
#include <ros/ros.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace sampled_data_observers {
namespace {

TEST(LaunchFilesTest, NameEverySuite) {
  std::ostringstream text;
  for (const auto& entry : std::filesystem::directory_iterator(SDO_SOURCE_DIR "/test/ros")) {
    if (entry.path().extension() == ".test") text << std::ifstream(entry.path()).rdbuf();
  }
  const std::string launch_files = text.str();
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  for (int i = 0; i < all.total_test_suite_count(); ++i) {
    const std::string name = all.GetTestSuite(i)->name();
    EXPECT_NE(std::string::npos, launch_files.find(name + ".*")) << "none runs " << name;
  }
}

/// A launch file that selects nothing must not pass: without a result it fails.
class SomethingRuns : public testing::EmptyTestEventListener {
  void OnTestProgramStart(const testing::UnitTest& all) override {
    if (all.test_to_run_count() == 0) std::exit(EXIT_FAILURE);
  }
};

}  // namespace
}  // namespace sampled_data_observers

int main(int argc, char** argv) {
  ros::init(argc, argv, "ros_tests");
  const ros::NodeHandle alive;  // roscpp shuts down with the last handle
  testing::InitGoogleTest(&argc, argv);
  testing::UnitTest::GetInstance()->listeners().Append(new sampled_data_observers::SomethingRuns);
  return RUN_ALL_TESTS();
}
