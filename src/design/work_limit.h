#pragma once

#include <chrono>
#include <stdexcept>

namespace sampled_data_observers {

/// What a thread does takes longer than it may.
class OutOfTime : public std::runtime_error {
 public:
  OutOfTime() : std::runtime_error("solver and proof took longer than the time limit") {}
};

/// Limits what its thread does while it lives, in place of a limit that was there before.
class WorkLimit {
 public:
  /// @param seconds  from now on; may be infinite
  explicit WorkLimit(double seconds);
  WorkLimit(const WorkLimit&) = delete;
  WorkLimit& operator=(const WorkLimit&) = delete;
  ~WorkLimit();

  bool is_over() const;

 private:
  double seconds_;
  std::chrono::steady_clock::time_point start_;
  const WorkLimit* before_;
};

/// To be called by what may take long: by each iteration of a solver, and each step of a proof.
/// @throws OutOfTime  where this thread's limit is over
void require_time_left();

}  // namespace sampled_data_observers
