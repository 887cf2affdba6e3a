#pragma once

#include <functional>
#include <memory>
#include <vector>

namespace sampled_data_observers {

/// What tables are of, so that those of different things with the same numbers are not confused:
/// the first number of a key.
constexpr double kLinearTables = 1.0;
constexpr double kCovarianceTables = 2.0;

/// The tables of what `key` says, which all who have asked for them in this process share; made now
/// where nobody has them. For any thread.
/// @param key   all numbers that they follow from; finite
/// @param make  makes them
std::shared_ptr<const std::vector<double>> shared_tables(
    std::vector<double> key, const std::function<std::vector<double>()>& make);

}  // namespace sampled_data_observers
