#pragma once

namespace sampled_data_observers {

/// The node twin of a nodelet of this package: the same class in a process of its own.
/// @return the exit status
int run_node_twin(const char* type, const char* node_name, int argc, char** argv);

}  // namespace sampled_data_observers
