// gtest's main for tests that compute for long: ROS tests run beside them, and come first.
#include <gtest/gtest.h>
#include <sys/resource.h>

int main(int argc, char** argv) {
  ::setpriority(PRIO_PROCESS, 0, 10);
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
