#pragma once

#include "sampled_data_observers/design/design_method.h"

namespace sampled_data_observers {

// One source file each, or each family.
const DesignMethod& ferrante2016_corollary1();
const DesignMethod& ferrante2019_proposition2();
const DesignMethod& ferrante2019_proposition3();
const DesignMethod& ferrante2019_proposition4();
const DesignMethod& ferrante2019_proposition5();
const DesignMethod& ferrante2019_alternating();
const DesignMethod& sferlazza2019_algorithm1();

}  // namespace sampled_data_observers
