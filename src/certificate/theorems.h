#pragma once

#include "sampled_data_observers/certificate/certificate.h"

namespace sampled_data_observers {

// One source file each.
const Theorem& ferrante2019_theorem2();

}  // namespace sampled_data_observers
