#include "sampled_data_observers/runtime/step_window.h"

#include <algorithm>

namespace sampled_data_observers {

void StepWindow::add(const Sample& sample) {
  samples_[next_] = sample;
  next_ = (next_ + 1) % samples_.size();
  count_ = std::min(count_ + 1, samples_.size());
}

double StepWindow::change() const {
  // Summed anew each time: a sum that is carried along would gather rounding errors for ever.
  double older = 0.0;
  double newer = 0.0;
  for (std::size_t i = 0; i < half(); ++i) {
    older += from_newest(half() + i).value;
    newer += from_newest(i).value;
  }
  return (newer - older) / static_cast<double>(half());
}

void StepWindow::clear() {
  next_ = 0;
  count_ = 0;
}

}  // namespace sampled_data_observers
