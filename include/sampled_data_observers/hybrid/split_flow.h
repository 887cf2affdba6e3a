#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>

#include "sampled_data_observers/hybrid/hybrid_system.h"

namespace sampled_data_observers {

/// How much of a flow over `duration` consists of whole flow_step()s: 0 where it can't be split.
Duration whole_steps(const HybridSystem& system, Duration duration);

/// Finite, and far enough from the largest number that the next flow or reset is finite as well: a
/// state that could not be corrected any more would be as bad as an infinite one.
bool is_usable(const Eigen::Ref<const Eigen::VectorXd>& state);

/// A flow from a copy of a state, computed in parts: to the bit what one flow would give. It allows
/// others to use the system between two parts.
class SplitFlow {
 public:
  /// Begins: state() is to be set to where the flow begins, for a system with such states; `held`
  /// says whether that is a state that was held, which a flow over no time does not change.
  void begin(std::shared_ptr<const HybridSystem> system, Duration duration, bool held);

  /// Goes on by so many flow_step()s, or to the end where the flow can't be split. Returns whether
  /// it is done: state() is then where it leads or, with is_held(), where it began, held.
  /// @pre the state was set; no other thread uses the system
  bool proceed(std::int64_t steps);

  /// Where it is now.
  Eigen::VectorXd& state() { return state_; }
  /// Whether the flow is not finite, or leads nowhere from a state that was held.
  bool is_held() const { return is_held_; }

 private:
  void hold();

  std::shared_ptr<const HybridSystem> system_;
  Duration duration_ = 0;
  Duration whole_ = 0;    ///< whole_steps()
  Duration reached_ = 0;  ///< of the whole steps
  bool is_held_ = false;
  Eigen::VectorXd state_;
  Eigen::VectorXd origin_;
  Eigen::VectorXd workspace_;
};

}  // namespace sampled_data_observers
