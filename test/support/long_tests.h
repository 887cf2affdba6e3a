#pragma once

#include <cstdlib>

namespace sampled_data_observers::test {

/// Whether to try all there is, as scripts/test --all does, or enough to show what a change broke.
inline bool long_tests_are_wanted() { return std::getenv("SDO_LONG_TESTS") != nullptr; }

}  // namespace sampled_data_observers::test
