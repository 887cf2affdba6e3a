#pragma once

namespace sampled_data_observers {

/// What holds while a simulated clock has not begun, and what to do about it.
constexpr const char* kNoClock =
    "/use_sim_time is true, but nothing comes on /clock: start what publishes it, or run "
    "`rosparam set /use_sim_time false` and start this again";

}  // namespace sampled_data_observers
