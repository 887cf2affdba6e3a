#include "sampled_data_observers/real_time/priority_inheritance_mutex.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <mutex>
#include <string>
#include <thread>

namespace sampled_data_observers {
namespace {

TEST(PriorityInheritanceMutexTest, LetsOneThreadInAtATime) {
  PriorityInheritanceMutex mutex;
  int count = 0;
  const auto work = [&] {
    for (int i = 0; i < 10000; ++i) {
      const std::lock_guard<PriorityInheritanceMutex> lock(mutex);
      ++count;
    }
  };
  std::thread other(work);
  work();
  other.join();
  EXPECT_EQ(20000, count);
}

TEST(PriorityInheritanceMutexTest, IsHeldByOneOnly) {
  PriorityInheritanceMutex mutex;
  ASSERT_TRUE(mutex.try_lock());
  std::thread([&] { EXPECT_FALSE(mutex.try_lock()); }).join();
  mutex.unlock();
  std::thread([&] {
    ASSERT_TRUE(mutex.try_lock());
    mutex.unlock();
  }).join();
}

TEST(PriorityInheritanceMutexTest, IsWaitedForAsLongAsAskedForAtMost) {
  using std::chrono::steady_clock;
  PriorityInheritanceMutex mutex;
  ASSERT_TRUE(mutex.try_lock_for(std::chrono::seconds(0)));
  std::thread([&] {
    const steady_clock::time_point start = steady_clock::now();
    EXPECT_FALSE(mutex.try_lock_for(std::chrono::milliseconds(2)));
    EXPECT_GE(steady_clock::now() - start, std::chrono::milliseconds(1));
  }).join();
  std::atomic<bool> waits{false};
  std::thread patient([&] {
    waits = true;
    EXPECT_TRUE(mutex.try_lock_for(std::chrono::seconds(60)));
    mutex.unlock();
  });
  while (!waits) std::this_thread::yield();
  mutex.unlock();
  patient.join();
}

/// The priority at which the kernel runs this thread, as /proc has it: below 0 for real time.
int effective_priority() {
  std::ifstream file("/proc/thread-self/stat");
  std::string text;
  std::getline(file, text);
  std::size_t position = text.rfind(')');
  // "(name) state ppid ...": the priority is the 16th value behind the name.
  for (int field = 0; field < 16; ++field) position = text.find(' ', position + 1);
  return std::stoi(text.substr(position));
}

TEST(PriorityInheritanceMutexTest, ItsHolderRunsAtThePriorityOfWhoWaits) {
  PriorityInheritanceMutex mutex;
  std::atomic<bool> permitted{true};
  std::unique_lock<PriorityInheritanceMutex> lock(mutex);
  const int before = effective_priority();
  std::thread urgent([&] {
    sched_param parameters{};
    parameters.sched_priority = 5;
    permitted = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
    const std::lock_guard<PriorityInheritanceMutex> wait(mutex);
  });
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (permitted && effective_priority() >= 0 && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const int during = effective_priority();
  lock.unlock();
  const int after = effective_priority();
  urgent.join();
  if (!permitted) GTEST_SKIP() << "no real-time priorities here";
  EXPECT_GE(before, 0);
  EXPECT_EQ(-6, during);  // -1 minus the priority
  EXPECT_EQ(before, after);
}

}  // namespace
}  // namespace sampled_data_observers
