#include "ranks/ranks.h"

#include <dlfcn.h>

#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <thread>
#include <utility>

namespace sampled_data_observers {
namespace {

/// What mpirun of Open MPI, and of MPICH and its kin, say of how many it started.
constexpr const char* kSizes[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"};
/// A library of its own, so that nothing else takes MPI to start.
constexpr char kLibrary[] = "libsampled_data_observers_mpi.so";

constexpr auto kPause = std::chrono::milliseconds(1);

int started_ranks() {
  for (const char* name : kSizes) {
    const char* size = std::getenv(name);
    if (size != nullptr) return std::atoi(size);
  }
  return 1;
}

/// The folder of the library, or program, that this function is in.
std::string own_folder() {
  Dl_info own{};
  if (::dladdr(reinterpret_cast<const void*>(&own_folder), &own) == 0) return "";
  const std::string file = own.dli_fname;
  return file.substr(0, file.rfind('/') + 1);
}

Ranks* started_by_mpirun(int size) {
  const std::string started = "mpirun started " + std::to_string(size) + " of this command, ";
  // Open MPI's own plug-ins look for its symbols.
  void* library = ::dlopen((own_folder() + kLibrary).c_str(), RTLD_NOW | RTLD_GLOBAL);
  if (library == nullptr) library = ::dlopen(kLibrary, RTLD_NOW | RTLD_GLOBAL);
  if (library == nullptr) {
    throw std::runtime_error(started +
                             "but this package was built without MPI (on Debian libopenmpi-dev), "
                             "or its library is missing: " +
                             ::dlerror());
  }
  const auto make =
      reinterpret_cast<Ranks* (*)()>(::dlsym(library, "sampled_data_observers_ranks"));
  Ranks* ranks = make == nullptr ? nullptr : make();
  if (ranks == nullptr || ranks->size() != size) {
    throw std::runtime_error(started + "but it is not of the MPI that this package was built with");
  }
  return ranks;
}

}  // namespace

Ranks* command_ranks() {
  static Ranks* const ranks = [] {
    const int size = started_ranks();
    return size > 1 ? started_by_mpirun(size) : nullptr;
  }();
  return ranks;
}

std::vector<std::string> gathered(Ranks& ranks, const std::string& own) {
  if (ranks.rank() > 0) {
    ranks.send(0, own);
    return {};
  }
  std::vector<std::string> all(static_cast<std::size_t>(ranks.size()));
  all.front() = own;
  for (int missing = ranks.size() - 1; missing > 0;) {
    if (auto message = ranks.receive()) {
      all[static_cast<std::size_t>(message->from)] = std::move(message->bytes);
      --missing;
    } else {
      std::this_thread::sleep_for(kPause);
    }
  }
  return all;
}

std::pair<std::size_t, std::size_t> share_of(const Ranks* ranks, std::size_t count) {
  if (ranks == nullptr) return {0, count};
  const auto rank = static_cast<std::size_t>(ranks->rank());
  const auto size = static_cast<std::size_t>(ranks->size());
  return {rank * count / size, (rank + 1) * count / size};
}

void name_rank_in_faults(const Ranks* ranks, const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& fault) {
    if (ranks == nullptr || ranks->rank() == 0) throw;
    throw std::runtime_error("rank " + std::to_string(ranks->rank()) + " on " + ranks->host() +
                             ": " + fault.what());
  }
}

}  // namespace sampled_data_observers
