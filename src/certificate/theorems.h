#pragma once

#include "sampled_data_observers/certificate/certificate.h"

namespace sampled_data_observers {

// One source file each, or each family.
const Theorem& ferrante2016_theorem1();
const Theorem& ferrante2019_theorem2();
const Theorem& ferrante2019_corollary1();
const Theorem& ferrante2019_corollary2();
const Theorem& sferlazza2019_theorem2();

}  // namespace sampled_data_observers
