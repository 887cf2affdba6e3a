// bernard2022, Theorem 6.4, as what it says in practice: jumps that take effect up to Δ late leave
// errors of the order of Δ outside of the intervals between a jump and its effect, and errors of
// the size of the jump inside. Example 5.5, for which the constants follow by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "support/example_run.h"

namespace sampled_data_observers::test {
namespace {

constexpr double kSettled = 60.0;  // s: twelve jumps or more

ExampleRun run_with_delays(double longest, std::uint64_t seed) {
  Example example("bernard2022_impulsive");
  example.override_observer("jumps: {late: delayed}");
  example.seed(seed).change_scenario(
      [=](Scenario& scenario) { scenario.jumps->delivery.longest = from_seconds(longest); });
  return example.run();
}

/// The errors up to `delay` after jumps, or all others, once those of the start are gone.
Trajectory errors(const ExampleRun& run, double delay, bool inside) {
  return run.error.from(kSettled).where([&run, delay, inside](double t) {
    const bool is_inside = std::any_of(
        run.jumps.begin(), run.jumps.end(),
        [=](const ExampleRun::Jump& jump) { return jump.time <= t && t <= jump.time + delay; });
    return is_inside == inside;
  });
}

// x2 = 1/2 is constant, x1 its integral, and x3 becomes x1 at jumps. With the gain (1, l, 1) a jump
// that takes effect d later leaves e1 = x2 d, e3 = 0, and of e2 what 1 - l (tau - d) of it is, less
// l x2 d of the jump before. With |1 - l (tau - d)| <= q for tau - d in [2 - Δ, 5] that gives
// |e2| <= l x2 Δ / (1 - q) and |e1| <= x2 Δ + 5 |e2| in the end.
TEST(Bernard2022Theorem64, OutsideOfTheDelaysTheErrorIsOfTheirOrder) {
  constexpr double x2 = 0.5;
  constexpr double l = 0.272404278372171;
  for (const double delay : {0.4, 0.2, 0.1, 0.05, 0.025, 0.0125}) {
    const double q = std::max(1.0 - l * (2.0 - delay), 5.0 * l - 1.0);
    const double e2 = l * x2 / (1.0 - q);
    const double constant = std::hypot(x2 + 5.0 * e2, e2);
    EXPECT_LT(constant, 2.2);
    double largest = 0.0;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const ExampleRun run = run_with_delays(delay, seed);
      largest = std::max(largest, errors(run, delay, false).max());
      // Peaking: half a second of x2 at least, however short the delay. Shorter ones than the
      // period of the truth may not be seen.
      if (delay < 0.1) continue;
      EXPECT_GT(errors(run, delay, true).max(), 1.0) << delay << " " << seed;
    }
    EXPECT_LT(largest, constant * delay + 1e-3) << delay;
    // That a delay of nearly Δ leaves at once.
    EXPECT_GT(largest, 0.9 * x2 * delay) << delay;
    RecordProperty("error per delay, " + std::to_string(delay), std::to_string(largest / delay));
  }
}

}  // namespace
}  // namespace sampled_data_observers::test
