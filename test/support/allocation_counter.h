#pragma once

#include <cstddef>

namespace sampled_data_observers::test {

/// False under a sanitizer, which has an allocator of its own: nothing is counted then.
bool allocations_are_counted();

/// Number of heap allocations of this process so far, by malloc, new and their kin.
std::size_t allocations();

}  // namespace sampled_data_observers::test
