#pragma once

#include <stdexcept>
#include <string>

namespace sampled_data_observers {

/// @throws std::invalid_argument with `what` gains must be, where that does not hold.
inline void require_of_gains(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument(what);
}

}  // namespace sampled_data_observers
