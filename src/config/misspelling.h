#pragma once

#include <string>
#include <vector>

namespace sampled_data_observers {

/// The first of some words that is likely to be a misspelling of another one; empty where none is:
/// they differ by one letter for each four (left out, added, exchanged with its neighbour, or
/// another one), and not by the last one alone, which tells an index: T1 and T2, imu_a and imu_b;
/// or by the case of letters: IMU and Imu.
std::string misspelling_of(const std::string& word, const std::vector<std::string>& among);

}  // namespace sampled_data_observers
