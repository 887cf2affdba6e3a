#pragma once

#include <cstdint>

namespace sampled_data_observers {

/// Of topics: long enough for a burst after a stall of seconds, since a lost event changes all
/// later estimates.
constexpr std::uint32_t kQueueLength = 2000;

}  // namespace sampled_data_observers
