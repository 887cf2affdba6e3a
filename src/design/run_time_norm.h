#pragma once

#include <memory>

#include "design/design_search.h"

namespace sampled_data_observers {

/// Gains of sferlazza2019_theorem2, with or without a rate, with a norm of the error in which their
/// samples leave less of it than in that of the P that they are made of: a claim of
/// sferlazza2019_theorem2_norm, whose Q is searched for. Null for other gains, and where that is
/// not proved.
std::shared_ptr<const Design> in_better_norm(const Design& design);

}  // namespace sampled_data_observers
