#include "design/workers.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <exception>
#include <memory>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

namespace sampled_data_observers {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kNoWorker = static_cast<std::size_t>(-1);

/// What precedes a result in the pipe.
struct Header {
  std::uint64_t size = 0;
  std::uint64_t threw = 0;
};

bool write_all(int fd, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::write(fd, at, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    at += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

bool read_all(int fd, void* data, std::size_t size) {
  char* at = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = ::read(fd, at, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

[[noreturn]] void serve(pid_t parent, int from_parent, int to_parent,
                        const std::function<std::string(std::size_t)>& task) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // it died before
  const int null = ::open("/dev/null", O_WRONLY);
  if (null >= 0) ::dup2(null, STDOUT_FILENO);
  if (::chdir("/") != 0) ::_exit(1);
  std::uint64_t number = 0;
  while (read_all(from_parent, &number, sizeof number)) {
    Header header;
    std::string result;
    try {
      result = task(number);
    } catch (const std::exception& error) {
      result = error.what();
      header.threw = 1;
    }
    header.size = result.size();
    if (!write_all(to_parent, &header, sizeof header) ||
        !write_all(to_parent, result.data(), result.size())) {
      break;
    }
  }
  // Without destructors: they belong to the parent.
  ::_exit(0);
}

class Worker {
 public:
  explicit Worker(const std::function<std::string(std::size_t)>& task) {
    // What others start meanwhile would hold the ends of these pipes open.
    static std::mutex starting;
    std::unique_lock<std::mutex> lock(starting);
    int down[2];
    int up[2];
    if (::pipe2(down, O_CLOEXEC) != 0) fail("pipe");
    if (::pipe2(up, O_CLOEXEC) != 0) fail("pipe");
    const pid_t parent = ::getpid();
    pid_ = ::fork();
    if (pid_ < 0) fail("fork");
    if (pid_ == 0) {
      lock.unlock();
      ::close(down[1]);
      ::close(up[0]);
      serve(parent, down[0], up[1], task);
    }
    ::close(down[0]);
    ::close(up[1]);
    to_ = down[1];
    from_ = up[0];
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  ~Worker() {
    ::kill(pid_, SIGKILL);
    ::close(to_);
    ::close(from_);
    while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }

  int from() const { return from_; }
  std::size_t task() const { return task_; }
  double seconds() const { return std::chrono::duration<double>(Clock::now() - since_).count(); }

  bool start(std::size_t task) {
    task_ = task;
    since_ = Clock::now();
    const std::uint64_t number = task;
    return write_all(to_, &number, sizeof number);
  }

  /// Waits for the rest of a result that has begun to arrive.
  WorkerOutcome finish() {
    WorkerOutcome outcome;
    Header header;
    if (read_all(from_, &header, sizeof header)) {
      outcome.result.resize(header.size);
      if (read_all(from_, outcome.result.data(), header.size)) {
        outcome.status =
            header.threw != 0 ? WorkerOutcome::Status::kThrew : WorkerOutcome::Status::kDone;
      }
    }
    outcome.seconds = seconds();
    return outcome;
  }

 private:
  [[noreturn]] static void fail(const char* what) {
    throw std::system_error(errno, std::generic_category(), what);
  }

  pid_t pid_ = -1;
  int to_ = -1;
  int from_ = -1;
  std::size_t task_ = kNoWorker;
  Clock::time_point since_;
};

/// A worker that died must give an error on writing, not a signal, in this thread.
class BlockedBrokenPipes {
 public:
  BlockedBrokenPipes() {
    ::sigemptyset(&broken_);
    ::sigaddset(&broken_, SIGPIPE);
    ::pthread_sigmask(SIG_BLOCK, &broken_, &before_);
  }
  BlockedBrokenPipes(const BlockedBrokenPipes&) = delete;
  BlockedBrokenPipes& operator=(const BlockedBrokenPipes&) = delete;
  ~BlockedBrokenPipes() {
    const timespec now{};
    if (::sigismember(&before_, SIGPIPE) == 0) {
      while (::sigtimedwait(&broken_, nullptr, &now) > 0) {
      }
    }
    ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }

 private:
  sigset_t broken_;
  sigset_t before_;
};

class Pool {
 public:
  Pool(const NextTask& next, const std::function<std::string(std::size_t)>& task,
       const WorkerOptions& options)
      : next_(next), task_(task), options_(options) {}

  void run() {
    const BlockedBrokenPipes blocked;
    while (workers_.size() < std::max(1U, options_.jobs) && has_next_) {
      give_next(workers_.emplace_back());
    }
    while (std::any_of(workers_.begin(), workers_.end(), [](const auto& one) { return !!one; })) {
      if (options_.is_cancelled && options_.is_cancelled()) throw Cancelled();
      wait();
    }
  }

 private:
  void give_next(std::unique_ptr<Worker>& worker) {
    const std::optional<std::size_t> task = has_next_ ? next_() : std::nullopt;
    if (!task) {
      has_next_ = false;
      worker.reset();
      return;
    }
    if (!worker) worker = std::make_unique<Worker>(task_);
    // Where it died meanwhile, the end of its pipe tells.
    worker->start(*task);
  }

  void wait() {
    std::vector<pollfd> waiting;
    std::vector<std::size_t> positions;
    double remaining = options_.is_cancelled ? std::min(options_.patience, options_.time_limit)
                                             : options_.time_limit;
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      if (!workers_[i]) continue;
      waiting.push_back({workers_[i]->from(), POLLIN, 0});
      positions.push_back(i);
      remaining = std::min(remaining, options_.time_limit - workers_[i]->seconds());
    }
    const int timeout = static_cast<int>(std::min(1e6, std::max(0.0, remaining)) * 1000.0) + 1;
    if (::poll(waiting.data(), waiting.size(), timeout) < 0) return;  // interrupted
    for (std::size_t k = 0; k < waiting.size(); ++k) {
      std::unique_ptr<Worker>& worker = workers_[positions[k]];
      // Also where its result has come meanwhile: the limit decides, not who looks first.
      if (worker->seconds() > options_.time_limit) {
        WorkerOutcome outcome;
        outcome.status = WorkerOutcome::Status::kTimedOut;
        outcome.seconds = worker->seconds();
        take(worker, outcome);
      } else if (waiting[k].revents != 0) {
        take(worker, worker->finish());
      }
    }
  }

  void take(std::unique_ptr<Worker>& worker, const WorkerOutcome& outcome) {
    const std::size_t task = worker->task();
    const bool ended = outcome.status == WorkerOutcome::Status::kTimedOut ||
                       outcome.status == WorkerOutcome::Status::kCrashed;
    if (ended) worker.reset();
    if (options_.on_outcome) options_.on_outcome(task, outcome);
    give_next(worker);
  }

  const NextTask& next_;
  const std::function<std::string(std::size_t)>& task_;
  const WorkerOptions& options_;
  std::vector<std::unique_ptr<Worker>> workers_;
  bool has_next_ = true;
};

}  // namespace

unsigned default_jobs() { return std::max(1U, std::thread::hardware_concurrency()); }

void run_tasks(const NextTask& next, const std::function<std::string(std::size_t)>& task,
               const WorkerOptions& options) {
  Pool(next, task, options).run();
}

std::vector<WorkerOutcome> run_in_workers(std::size_t count,
                                          const std::function<std::string(std::size_t)>& task,
                                          const WorkerOptions& options) {
  std::vector<WorkerOutcome> outcomes(count);
  std::size_t given = 0;
  const auto next = [&] { return given < count ? std::optional(given++) : std::nullopt; };
  WorkerOptions collecting = options;
  collecting.on_outcome = [&](std::size_t i, const WorkerOutcome& outcome) {
    outcomes[i] = outcome;
    if (options.on_outcome) options.on_outcome(i, outcome);
  };
  run_tasks(next, task, collecting);
  return outcomes;
}

}  // namespace sampled_data_observers
