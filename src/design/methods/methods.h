#pragma once

#include "sampled_data_observers/design/design_method.h"

namespace sampled_data_observers {

// One source file each, or each family.
const DesignMethod& ferrante2019_proposition2();

}  // namespace sampled_data_observers
