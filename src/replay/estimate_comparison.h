#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace sampled_data_observers {

/// How the estimates of two bags agree.
struct EstimateComparison {
  std::size_t first = 0;        ///< estimates in the first bag
  std::size_t second = 0;       ///< in the second
  std::size_t common = 0;       ///< stamps in both
  std::size_t same_events = 0;  ///< of these: both rest on as many inputs, samples and jumps
  std::size_t identical = 0;    ///< of these: states and error bounds equal bit for bit
  bool repeated_stamps = false;
};

/// Compares the StateEstimate messages on `topic` of two bags, stamp by stamp.
/// @throws ReplayError when a bag can't be read or has no estimates there.
EstimateComparison compare_estimates(const std::string& first_bag, const std::string& second_bag,
                                     const std::string& topic);

}  // namespace sampled_data_observers
