#pragma once

#include "certificate/certificate.h"

namespace sampled_data_observers {

// One source file each, or each family.
const Theorem& bernard2022_corollary4_1();
const Theorem& bernard2022_corollary4_1_average_dwell_time();
const Theorem& bernard2022_corollary5_2();
const Theorem& bernard2022_corollary5_2_metric();
const Theorem& bernard2022_equation14();
const Theorem& bernard2022_equation14_average_dwell_time();
const Theorem& bernard2022_equation22();
const Theorem& bernard2022_equation22_average_dwell_time();
const Theorem& bernard2022_equation26();
const Theorem& bernard2022_equation26_reverse_average_dwell_time();
const Theorem& bernard2022_equation49_reverse_average_dwell_time();
const Theorem& bernard2022_example4_2();
const Theorem& bernard2022_example4_2_average_dwell_time();
const Theorem& bernard2022_example7_1();
const Theorem& bernard2022_example7_1_average_dwell_time();
const Theorem& bernard2022_section7_3_1();
const Theorem& bernard2022_section7_3_2();
const Theorem& bernard2022_section7_3_2_metric();
const Theorem& etienne2019_proposition1();
const Theorem& etienne2019_proposition2();
const Theorem& etienne2019_proposition2_channels();
const Theorem& etienne2019_theorem1();
const Theorem& ferrante2016_theorem1();
const Theorem& ferrante2019_theorem2();
const Theorem& ferrante2019_corollary1();
const Theorem& ferrante2019_corollary2();
const Theorem& sferlazza2019_equation17();
const Theorem& sferlazza2019_theorem2();
const Theorem& sferlazza2019_theorem2_norm();
const Theorem& sferlazza2019_theorem2_rate();
const Theorem& timer_dependent_constant_gain();
const Theorem& timer_dependent_intersample_injection();
const Theorem& timer_dependent_sample_and_hold();
const Theorem& timer_dependent_scheduled_gain();
const Theorem& timer_dependent_sum_constant_gain();
const Theorem& timer_dependent_sum_intersample_injection();
const Theorem& timer_dependent_sum_sample_and_hold();
const Theorem& timer_dependent_switched();
const Theorem& timer_dependent_synchronized();

}  // namespace sampled_data_observers
