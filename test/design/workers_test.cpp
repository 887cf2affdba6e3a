#include "design/workers.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <string>
#include <thread>

namespace sampled_data_observers {
namespace {

[[noreturn]] void hang() {
  for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
}

TEST(Workers, EndWhenCancelled) {
  WorkerOptions options;
  options.jobs = 2;
  options.time_limit = 60.0;
  std::size_t finished = 0;
  options.on_outcome = [&](std::size_t, const WorkerOutcome&) { ++finished; };
  options.is_cancelled = [&] { return finished > 0; };
  const auto task = [](std::size_t i) -> std::string {
    if (i > 0) hang();
    return "";
  };
  EXPECT_THROW(run_in_workers(8, task, options), Cancelled);
  EXPECT_EQ(finished, 1u);
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

TEST(Workers, MayRunOthers) {
  const auto square = [](std::size_t i) { return std::to_string(i * i); };
  const auto outer = [&](std::size_t i) {
    return run_in_workers(i + 1, square, WorkerOptions()).back().result;
  };
  const auto outcomes = run_in_workers(4, outer, WorkerOptions());
  EXPECT_EQ(outcomes[3].result, "9");
}

TEST(Workers, EndWithTheProcessThatStartedThem) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const pid_t starter = ::fork();
  if (starter == 0) {
    ::close(ends[0]);
    WorkerOptions options;
    options.time_limit = 60.0;
    const auto inner = [&](std::size_t) -> std::string {
      if (::write(ends[1], "x", 1) == 1) hang();
      return "";
    };
    run_in_workers(
        1, [&](std::size_t) { return run_in_workers(1, inner, options)[0].result; }, options);
    ::_exit(0);
  }
  ::close(ends[1]);
  char byte = 0;
  ASSERT_EQ(::read(ends[0], &byte, 1), 1);  // the innermost runs
  ::kill(starter, SIGKILL);
  ::waitpid(starter, nullptr, 0);
  // The pipe ends when nobody is left who could write.
  pollfd ended = {ends[0], POLLIN, 0};
  ASSERT_EQ(::poll(&ended, 1, 10000), 1);
  EXPECT_EQ(::read(ends[0], &byte, 1), 0);
  ::close(ends[0]);
}

}  // namespace
}  // namespace sampled_data_observers
