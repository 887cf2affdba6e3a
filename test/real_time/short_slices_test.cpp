#include "real_time/short_slices.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <thread>
#include <utility>

namespace sampled_data_observers {
namespace {

/// The runtime of the kernel's sched_attr, which is the slice of threads without real-time
/// priority.
std::uint64_t slice() {
  std::array<std::uint64_t, 6> attributes{};
  EXPECT_EQ(syscall(SYS_sched_getattr, 0, attributes.data(), sizeof(attributes), 0U), 0);
  return attributes[3];
}

bool kernel_has_slices() {
  utsname system{};
  uname(&system);
  std::pair<int, int> version;
  EXPECT_EQ(std::sscanf(system.release, "%d.%d", &version.first, &version.second), 2);
  return version >= std::make_pair(6, 12);
}

TEST(ShortSlicesTest, TheThreadAndThoseThatItStartsHaveThem) {
  if (!kernel_has_slices() || sched_getscheduler(0) != SCHED_OTHER) {
    GTEST_SKIP() << "Linux before 6.12, or of another policy";
  }
  std::thread([] {
    ask_for_short_slices();
    EXPECT_EQ(slice(), 100'000U);
    std::thread([] { EXPECT_EQ(slice(), 100'000U); }).join();
  }).join();
}

TEST(ShortSlicesTest, PolicyAndNicenessStay) {
  if (sched_getscheduler(0) != SCHED_OTHER) GTEST_SKIP() << "of another policy";
  std::thread([] {
    setpriority(PRIO_PROCESS, 0, 7);
    ask_for_short_slices();
    EXPECT_EQ(sched_getscheduler(0), SCHED_OTHER);
    EXPECT_EQ(getpriority(PRIO_PROCESS, 0), 7);
    sched_param parameters{};
    ASSERT_EQ(sched_setscheduler(0, SCHED_BATCH, &parameters), 0);
    ask_for_short_slices();
    EXPECT_EQ(sched_getscheduler(0), SCHED_BATCH);
  }).join();
}

}  // namespace
}  // namespace sampled_data_observers
