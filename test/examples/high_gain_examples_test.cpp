// The high-gain observer on a plant with modes (bernard2022, example 7.3) and on one with several
// degrees of freedom and guards (section 7.1), as shipped.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "support/example_run.h"
#include "support/recovery.h"

namespace sampled_data_observers::test {
namespace {

/// The errors of some states farther than `after` from the last jump, from `begin` on.
Trajectory settled(const ExampleRun& run, double begin, double after) {
  return run.error.where([&](double t) {
    return t >= begin && std::none_of(run.jumps.begin(), run.jumps.end(), [&](const auto& jump) {
             return jump.time <= t + 1e-9 && t < jump.time + after;
           });
  });
}

TEST(Bernard2022Clutch, FindsTheLoadInBothModes) {
  const ExampleRun run = Example("bernard2022_clutch").run();
  ASSERT_EQ(8u, run.jumps.size());
  EXPECT_NEAR(8.0, run.error.component(2).at(0.0), 1e-9);
  const Trajectory any = settled(run, 3.0, 0.0);
  EXPECT_LT(any.component(1).max(), 0.5);
  EXPECT_LT(any.component(2).max(), 2.5);  // of 8 Nm, just after a switch
  const Trajectory after = settled(run, 3.0, 1.0);
  ASSERT_GT(after.size(), 900u);
  EXPECT_LT(after.component(0).max(), 0.02);
  EXPECT_LT(after.component(1).max(), 0.02);
  EXPECT_LT(after.component(2).max(), 0.04);
}

// Coordinates of the mode that is left instead of (51), or maps of the other mode, don't do.
TEST(Bernard2022Clutch, NeedsTheCoordinatesOfEachMode) {
  Example example("bernard2022_clutch");
  example.override_observer(R"(
gains:
  modes:
    2:
      T: [we, (Te - b*we - a*asinh((we - wv)/s))/Je, 0]
)");
  const ExampleRun run = example.run();
  EXPECT_GT(settled(run, 3.0, 0.0).component(2).max(), 10.0);
}

TEST(Bernard2022Puck, FindsTheVelocitiesBetweenFourWalls) {
  for (const char* gains : {"gains.yaml", "gains_transformed.yaml"}) {
    const ExampleRun run = Example("bernard2022_puck", gains).run();
    ASSERT_EQ(21u, run.jumps.size());
    EXPECT_NEAR(0.0017, run.jumps[12].time - run.jumps[11].time, 1e-4);  // almost in a corner
    const Trajectory any = settled(run, 2.0, 0.0);
    const Trajectory after = settled(run, 2.0, 0.5);
    ASSERT_GT(after.size(), 1000u);
    for (const Eigen::Index velocity : {1, 3}) {
      EXPECT_GT(run.error.component(velocity).at(0.0), 1.0);
      EXPECT_LT(any.component(velocity).max(), 0.03);
      EXPECT_LT(after.component(velocity).max(), 0.006);
    }
  }
}

TEST(Bernard2022Puck, ForgetsMistakenImpactsWithinASecond) {
  for (const char* file : {"observer.yaml", "observer_guarded.yaml"}) {
    const bool is_guarded = file != std::string("observer.yaml");
    const Recovery puck(Example("bernard2022_puck"), 0.03, file);
    EXPECT_EQ(0u, puck.truthful().refused);
    const auto after = [&](const ExampleRun& run) {
      return puck.recovered_at(run, 0.05) - puck.jump(4);
    };
    EXPECT_LT(after(puck.run([](ToldJumps& jumps) { jumps.drop(4); })), 1.0);
    EXPECT_LT(after(puck.run([](ToldJumps& jumps) { jumps.repeat(4, 0.002); })), 1.0);
    const ExampleRun added =
        puck.run([&](ToldJumps& jumps) { jumps.add(0.5 * (puck.jump(4) + puck.jump(5))); });
    EXPECT_EQ(is_guarded ? 1u : 0u, added.refused);
    EXPECT_LT(after(added), 1.0);
    if (is_guarded) {
      EXPECT_LT(puck.most(added), 1e-6);
    }
  }
}

}  // namespace
}  // namespace sampled_data_observers::test
