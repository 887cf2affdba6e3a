#include "design/work_limit.h"

namespace sampled_data_observers {
namespace {

thread_local const WorkLimit* limit_of_thread = nullptr;

}  // namespace

WorkLimit::WorkLimit(double seconds)
    : seconds_(seconds), start_(std::chrono::steady_clock::now()), before_(limit_of_thread) {
  limit_of_thread = this;
}

WorkLimit::~WorkLimit() { limit_of_thread = before_; }

bool WorkLimit::is_over() const {
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start_;
  return spent.count() > seconds_;
}

void require_time_left() {
  if (limit_of_thread != nullptr && limit_of_thread->is_over()) throw OutOfTime();
}

}  // namespace sampled_data_observers
