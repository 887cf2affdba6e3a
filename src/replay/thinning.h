#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// A random sporadic subset of samples. The first sample is kept; after each kept one an interval
/// is drawn uniformly from [T1, T2], and the sample nearest to its end is kept, among those whose
/// interval lies in [T1, T2]; where there is none, the first one after T2.
///
/// @param stamps  of all samples, in any order
/// @return for each stamp whether it is kept. The same on every machine for the same seed.
/// @pre 0 < T1 <= T2
std::vector<bool> thin(const std::vector<Stamp>& stamps, Duration T1, Duration T2,
                       std::uint64_t seed);

/// The same of messages among which some are no samples: these stay.
std::vector<bool> thin_among(const std::vector<std::optional<Stamp>>& stamps, Duration T1,
                             Duration T2, std::uint64_t seed);

}  // namespace sampled_data_observers
