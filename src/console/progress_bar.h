#pragma once

#include <chrono>
#include <cstddef>

namespace sampled_data_observers {

/// A line on standard error that fills up, with the time left at the pace so far; nothing where
/// standard error is no terminal.
class ProgressBar {
 public:
  /// @param label  what is going on
  ProgressBar(const char* label, std::size_t total);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void advance() { advance_to(done_ + 1); }
  void advance_to(std::size_t done);

 private:
  const char* label_;
  std::size_t total_;
  std::size_t done_ = 0;
  bool shown_;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point next_draw_;
};

}  // namespace sampled_data_observers
