#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// A rigid transform that holds at a stamp.
struct StampedTransform {
  /// When it holds.
  Stamp stamp = 0;
  /// From coordinates in the child frame to those in its parent [m].
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
};

/// Where the frame of an odometry lies in the world: world → odom = (world → base) (odom → base)⁻¹,
/// both at one stamp. The odometry of a stamp is usually known only after the estimate, so
/// estimates wait for it, in the order of their stamps. Allocates nothing once built.
class OdomFrame {
 public:
  /// odom → base at a stamp; nothing where it is not known (yet).
  using Odometry = std::function<std::optional<Eigen::Isometry3d>(Stamp)>;

  /// @param timeout   how much newer than a waiting estimate the newest one may be [ns]; older ones
  /// are dropped
  /// @param capacity  how many may wait, >= 1; when there are more the oldest is dropped
  OdomFrame(Duration timeout, std::size_t capacity);

  /// Takes in an estimate of world → base. Stamps increase; when one does not, time went back, and
  /// those that wait are forgotten.
  void add(const StampedTransform& world_to_base);

  /// world → odom by the oldest estimate whose odometry is known: to be called until there is none.
  std::optional<StampedTransform> next(const Odometry& odometry);

  /// Number of estimates dropped so far.
  std::size_t dropped() const { return dropped_; }

 private:
  void forget_oldest();

  Duration timeout_;
  /// A ring of those that wait.
  std::vector<StampedTransform> waiting_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  Stamp newest_ = 0;
  std::size_t dropped_ = 0;
};

}  // namespace sampled_data_observers
