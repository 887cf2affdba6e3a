#include "sampled_data_observers/runtime/odom_frame.h"

namespace sampled_data_observers {

OdomFrame::OdomFrame(Duration timeout, std::size_t capacity)
    : timeout_(timeout), waiting_(capacity) {}

void OdomFrame::forget_oldest() {
  first_ = (first_ + 1) % waiting_.size();
  --size_;
}

void OdomFrame::add(const StampedTransform& world_to_base) {
  if (world_to_base.stamp <= newest_) size_ = 0;
  newest_ = world_to_base.stamp;
  while (size_ == waiting_.size() || (size_ > 0 && newest_ - waiting_[first_].stamp > timeout_)) {
    forget_oldest();
    ++dropped_;
  }
  waiting_[(first_ + size_) % waiting_.size()] = world_to_base;
  ++size_;
}

std::optional<StampedTransform> OdomFrame::next(const Odometry& odometry) {
  if (size_ == 0) return std::nullopt;
  StampedTransform result = waiting_[first_];
  const std::optional<Eigen::Isometry3d> odom_to_base = odometry(result.stamp);
  if (!odom_to_base) return std::nullopt;
  result.transform = result.transform * odom_to_base->inverse();
  forget_oldest();
  return result;
}

}  // namespace sampled_data_observers
