#include "sampled_data_observers/replay/progress_bar.h"

#include <unistd.h>

#include <cstdio>
#include <string>

namespace sampled_data_observers {

ProgressBar::ProgressBar(std::size_t total)
    : total_(total == 0 ? 1 : total),
      shown_(isatty(STDERR_FILENO) != 0),
      next_draw_(std::chrono::steady_clock::now()) {}

ProgressBar::~ProgressBar() {
  if (shown_) std::fprintf(stderr, "\r\033[K");
}

void ProgressBar::advance() {
  ++done_;
  if (!shown_ || std::chrono::steady_clock::now() < next_draw_) return;
  next_draw_ = std::chrono::steady_clock::now() + std::chrono::milliseconds(50);
  constexpr std::size_t kWidth = 40;
  const std::size_t filled = kWidth * done_ / total_;
  std::fprintf(stderr, "\rreplay [%s%s] %3zu %%", std::string(filled, '#').c_str(),
               std::string(kWidth - filled, ' ').c_str(), 100 * done_ / total_);
}

}  // namespace sampled_data_observers
