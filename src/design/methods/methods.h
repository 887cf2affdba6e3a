#pragma once

#include "design/design_method.h"

namespace sampled_data_observers {

// One source file each, or each family.
const DesignMethod& bernard2022_coupled_design();
const DesignMethod& bernard2022_coupled_average_design();
const DesignMethod& bernard2022_flow_based_average_design();
const DesignMethod& bernard2022_flow_based_design();
const DesignMethod& bernard2022_high_gain_average_design();
const DesignMethod& bernard2022_high_gain_lipschitz_design();
const DesignMethod& bernard2022_high_gain_lipschitz_average_design();
const DesignMethod& bernard2022_high_gain_design();
const DesignMethod& bernard2022_jump_based_average_design();
const DesignMethod& bernard2022_jump_based_design();
const DesignMethod& bernard2022_metric_design();
const DesignMethod& bernard2022_polytopic_design();
const DesignMethod& bernard2022_projection_design();
const DesignMethod& bernard2022_switched_flow_based_average_design();
const DesignMethod& bernard2022_switched_flow_based_design();
const DesignMethod& bernard2022_switched_jump_based_average_design();
const DesignMethod& bernard2022_switched_jump_based_design();
const DesignMethod& bernard2022_switched_metric_design();
const DesignMethod& etienne2019_proposition1_design();
const DesignMethod& etienne2019_proposition2_design();
const DesignMethod& ferrante2016_corollary1();
const DesignMethod& ferrante2016_proposition1();
const DesignMethod& ferrante2019_proposition2();
const DesignMethod& ferrante2019_proposition2_predictor();
const DesignMethod& ferrante2019_proposition3();
const DesignMethod& ferrante2019_proposition3_hold();
const DesignMethod& ferrante2019_proposition4();
const DesignMethod& ferrante2019_proposition4_hold();
const DesignMethod& ferrante2019_proposition5();
const DesignMethod& ferrante2019_alternating();
const DesignMethod& ferrante2019_alternating_predictor();
const DesignMethod& ferrante2019_alternating_hold();
const DesignMethod& sferlazza2019_algorithm1();
const DesignMethod& sferlazza2019_equation17_design();
const DesignMethod& timer_dependent_alternating_gain();
const DesignMethod& timer_dependent_alternating_hold();
const DesignMethod& timer_dependent_alternating_injection();
const DesignMethod& timer_dependent_constant_gain_design();
const DesignMethod& timer_dependent_jump_gain_design();
const DesignMethod& timer_dependent_sum_gain();
const DesignMethod& timer_dependent_switched_design();
const DesignMethod& timer_dependent_scheduled_gain_design();

}  // namespace sampled_data_observers
