#pragma once

#include <Eigen/Core>
#include <ostream>
#include <string>
#include <vector>

#include "certificate/certificate.h"

namespace sampled_data_observers {

/// A matrix as nested lists of YAML, row by row, in decimals that are read as the same numbers.
std::string nested_lists(const Eigen::MatrixXd& matrix);

/// Writes values as keys of a section of YAML, as read_named_values() reads them.
void write_named_values(const std::vector<NamedShape>& shapes, const NamedMatrices& values,
                        std::ostream& out);

}  // namespace sampled_data_observers
