#include "real_time/memory_lock.h"

#include <linux/capability.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace sampled_data_observers {
namespace {

bool may_lock_without_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY) return true;
  return geteuid() == 0 && prctl(PR_CAPBSET_READ, CAP_IPC_LOCK) == 1;
}

}  // namespace

std::string lock_memory() {
  // Under a limit it might succeed now, and every later allocation beyond the limit would fail.
  if (!may_lock_without_limit()) return "the limit of locked memory (ulimit -l) is not 'unlimited'";
  if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return "";
  return std::generic_category().message(errno);
}

}  // namespace sampled_data_observers
