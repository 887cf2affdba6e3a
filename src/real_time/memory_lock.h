#pragma once

#include <string>

namespace sampled_data_observers {

/// Keeps all memory of this process, and what it will ask for, from being paged out. Returns why
/// that is not possible, or an empty text.
std::string lock_memory();

}  // namespace sampled_data_observers
