#pragma once

namespace sampled_data_observers {

/// Asks the kernel that the calling thread, and threads that it starts from then on, get short
/// slices of time (0.1 ms): such a thread is given a processor soon after it was woken, from others
/// that compute, and not a share of it that is larger. It takes no permission. Linux before 6.12
/// knows no such wish and goes on as before, and threads with a real-time priority are left alone.
void ask_for_short_slices();

}  // namespace sampled_data_observers
