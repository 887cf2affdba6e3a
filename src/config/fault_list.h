#pragma once

#include <string>
#include <utility>

#include "sampled_data_observers/config/config_node.h"

namespace sampled_data_observers {

/// Faults of a configuration that have nothing to do with each other, so that a person sees all of
/// them at once: one a line.
class FaultList {
 public:
  /// Takes in one.
  void add(const ConfigError& fault) {
    if (++count_ > kMost) return;
    text_ += (text_.empty() ? "" : "\n") + std::string(fault.what());
  }

  /// Does what may throw one, and goes on.
  template <class Action>
  void attempt(Action&& action) {
    try {
      std::forward<Action>(action)();
    } catch (const ConfigError& fault) {
      add(fault);
    }
  }

  /// Whether there are some.
  bool any() const { return count_ > 0; }

  /// @throws ConfigError with all of them, where there are some.
  void require_none() const {
    if (count_ == 0) return;
    throw ConfigError(
        count_ <= kMost ? text_ : text_ + "\nand " + std::to_string(count_ - kMost) + " more");
  }

 private:
  static constexpr std::size_t kMost = 20;

  std::size_t count_ = 0;
  std::string text_;
};

}  // namespace sampled_data_observers
