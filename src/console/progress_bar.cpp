#include "console/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace sampled_data_observers {
namespace {

/// "4:05 min" or "12 s"
std::string readable(double seconds) {
  const auto whole = static_cast<long>(std::ceil(seconds));
  char text[32];
  if (whole < 60) {
    std::snprintf(text, sizeof text, "%ld s", whole);
  } else {
    std::snprintf(text, sizeof text, "%ld:%02ld min", whole / 60, whole % 60);
  }
  return text;
}

}  // namespace

ProgressBar::ProgressBar(const char* label, std::size_t total)
    : label_(label),
      total_(total == 0 ? 1 : total),
      shown_(isatty(STDERR_FILENO) != 0),
      start_(std::chrono::steady_clock::now()),
      next_draw_(start_) {}

ProgressBar::~ProgressBar() {
  if (shown_) std::fprintf(stderr, "\r\033[K");
}

void ProgressBar::advance_to(std::size_t done) {
  done_ = done;
  if (!shown_ || std::chrono::steady_clock::now() < next_draw_) return;
  next_draw_ = std::chrono::steady_clock::now() + std::chrono::milliseconds(50);
  constexpr std::size_t kWidth = 40;
  const double share = std::min(1.0, static_cast<double>(done_) / static_cast<double>(total_));
  const auto filled = static_cast<std::size_t>(kWidth * share);
  const double elapsed =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  std::fprintf(stderr, "\r%s [%s%s] %3.0f %%, %s left\033[K", label_,
               std::string(filled, '#').c_str(), std::string(kWidth - filled, ' ').c_str(),
               100.0 * share,
               share > 0.0 ? readable(elapsed * (1.0 - share) / share).c_str() : "?");
}

}  // namespace sampled_data_observers
